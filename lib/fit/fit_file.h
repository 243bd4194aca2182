#pragma once

#include "fit/fit.h"
#include "json/document.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fettle::fit {

/// What the points of a file are. Touches are probed one by one, on good metal, to the accuracy of the job's probe; a
/// scan covers the anomaly, too: without roles its points inside B and outside S are left out. A B-spline fitted to a
/// scan takes the noise from the residuals.
enum class PointKind {
    by_number, ///< a scan if they are more than kMaxExactTouches (dense.h), else touches
    touches,
    scan,
};

/// A file of touches or of a scan, and how a surface is fitted to it.
struct FitRequest {
    std::string points;                             ///< path; "-": stdin
    std::optional<units::Units::Length> point_unit; ///< of the file; nothing: the job's
    std::string method = "auto";
    PointKind kind = PointKind::by_number;
    bool use_boundary = false;     ///< take the anomaly's boundary points as touches, too
    bool estimate_noise = false;   ///< as FitInput::estimate_noise
    std::optional<double> spacing; ///< as FitInput::spacing, in the job's unit
};

/// The exact posterior takes a minute or so for this many.
inline constexpr std::size_t kMaxTouches = 1000;

struct FitRun {
    Fit fit;
    std::size_t touches = 0, ignored = 0; ///< points that were fitted, and the others
    json::Value report;                   ///< report.h
    std::vector<std::string> warnings;
};

/// Fits a surface to the points of a file: a B-spline to a scan by fit_dense(), all else by fit_surface().
/// @throws InputError as CloudStream, fit_input() and either fit; for a B-spline through more touches than kMaxTouches;
///         if half of the touches or more lie outside the sampling boundary (job/plausible.h)
FitRun fit_file(const job::Job& job, const FitRequest& request);

} // namespace fettle::fit
