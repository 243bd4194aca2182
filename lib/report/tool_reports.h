#pragma once

#include "json/document.h"

#include <Eigen/Core>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fettle::report {

/// Numbers of a JSON report by key, in the units of its file; null is NaN.
using NamedNumbers = std::map<std::string, double>;

/// Report of fettle-compare.
struct ComparisonReport {
    std::vector<std::pair<std::string, NamedNumbers>> regions; ///< "all" first, then the regions of the job
    std::string judged;                                        ///< judged region; empty: no tolerance, no verdict
    bool reversed = false;                                     ///< the verdict includes both directions of comparison
    bool within = false;                                       ///< is the worst error within the tolerance?
    double tolerance = 0, worst = 0;
    double limit = 0;            ///< of the histogram, whose bins have equal widths from -limit to limit
    std::vector<double> counts;  ///< of the bins
    double below = 0, above = 0; ///< errors beyond the limit

    /// @param name  an existing region: "all" or the judged one
    const NamedNumbers& region(const std::string& name) const;
};

/// Report of fettle-grind.
struct GrindReport {
    bool finished = false;
    NamedNumbers numbers;
    Eigen::VectorXd peak_at; ///< place of the peak force, in the run's units; empty: not known
};

/// Where else a scan nearly fits its reference.
struct OtherPlace {
    NamedNumbers numbers; ///< turn_deg, shift from the place that was taken, misfit
    Eigen::Matrix4d transform;
};

/// Report of fettle-align.
struct AlignmentReport {
    NamedNumbers numbers; ///< lengths in the run's units
    Eigen::Matrix4d transform;
    std::string doubt;                     ///< why the result may be wrong; empty: no known reason
    std::optional<OtherPlace> other_place; ///< only if it fits nearly as well
};

/// Report of fettle-form.
struct FormReport {
    std::string form, parameter; ///< such as "flatness" and "FLTt"; the second may be empty
    NamedNumbers numbers;
    Eigen::VectorXd place;     ///< of the element of least squares: its centre, or a point on it; empty: not stated
    Eigen::VectorXd direction; ///< its normal or axis; empty: it has none
    std::optional<double> radius;
};

/// Each reads the report of one tool. @throws InputError for keys that are missing or of another kind
ComparisonReport read_comparison(json::Reader& reader);
AlignmentReport read_alignment(json::Reader& reader);
FormReport read_form(json::Reader& reader);

/// Pictures of the stock during a run.
struct PlayedFrames {
    struct Frame {
        double time = 0; ///< s
        std::string png; ///< bytes
    };
    std::string shown; ///< what they show
    std::vector<Frame> frames;
};
/// @param path  of the file, beside which the pictures are   @throws InputError
PlayedFrames read_frames(json::Reader reader, const std::string& path);
GrindReport read_grinding(json::Reader& reader);

} // namespace fettle::report
