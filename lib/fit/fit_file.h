#pragma once

#include "fit/fit.h"
#include "json/document.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fettle::fit {

/// What the points of a file are. Touches are probed one by one, on good metal, to the accuracy of the job's probe; a
/// scan covers the anomaly, too: its points inside B and outside S are left out, and its noise is estimated.
enum class PointKind {
    by_roles, ///< touches if the points have roles, else a scan
    touches,
    scan,
};

/// A file of touches or of a scan, and how a surface is fitted to it.
struct FitRequest {
    std::string points;                             ///< path; "-": stdin
    std::optional<units::Units::Length> point_unit; ///< of the file; nothing: the job's
    std::string method = "auto";
    PointKind kind = PointKind::by_roles;
    bool use_boundary = false;     ///< take the anomaly's boundary points as touches, too
    bool estimate_noise = false;   ///< as FitInput::estimate_noise
    std::optional<double> spacing; ///< as FitInput::spacing, in the job's unit
};

struct FitRun {
    Fit fit;
    std::size_t touches = 0, ignored = 0; ///< points that were fitted, and the others
    json::Value report;                   ///< report.h
    std::vector<std::string> warnings;
};

/// Fits a surface to the points of a file: to a scan and to more than kMaxExactTouches (dense.h) touches by fit_scan(),
/// to all else by fit_surface().
/// @throws InputError as CloudStream, fit_input() and either fit; if half of the touches or more lie outside the
///         sampling boundary (job/plausible.h)
FitRun fit_file(const job::Job& job, const FitRequest& request);

} // namespace fettle::fit
