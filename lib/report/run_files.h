#pragma once

#include "cloud/cloud.h"
#include "job/job.h"
#include "mesh/shape_file.h"
#include "plan/plan.h"
#include "surface/surface.h"
#include "units/units.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fettle {

/// Numbers of a report by their keys, as they stand there: in the units of its file. What was null is NaN.
using Figures = std::map<std::string, double>;

/// What fettle-compare reports.
struct ComparisonReport {
    std::vector<std::pair<std::string, Figures>> regions; ///< "all" first, then those of the job
    std::string judged;                                   ///< the region; empty: no tolerance, no verdict
    bool reversed = false;                                ///< the verdict is about both directions
    bool within = false;
    double tolerance = 0, worst = 0;
    double limit = 0; ///< of the histogram, whose bins are equally wide from -limit to limit
    std::vector<double> counts;
    double below = 0, above = 0;

    /// @param name  of one that there is: "all", or what is judged
    const Figures& region(const std::string& name) const;
};

/// What fettle-grind reports.
struct GrindReport {
    bool finished = false;
    Figures numbers;
};

/// What fettle-align reports.
struct AlignmentReport {
    Figures numbers; ///< lengths in the run's units
    Eigen::Matrix4d transform;
};

/// What fettle-form measures.
struct FormReport {
    std::string form, parameter; ///< "flatness", "FLTt"; the second may be empty
    Figures numbers;
};

/// Where something was read.
struct SourceFile {
    std::string what, name;
    std::size_t bytes = 0;
    std::string sha256;
};

/// Everything that a page may tell of one run. Clouds, meshes, job, surface and plan in base units; reports in `units`.
struct RunFiles {
    Units units;
    std::optional<Job> job;
    std::optional<Cloud> samples;
    std::optional<Surface> surface;
    std::optional<Plan> plan;
    std::optional<AlignmentReport> alignment;
    std::optional<FormReport> form;
    std::optional<GrindReport> grinding;
    std::optional<Cloud> trace;
    std::optional<MeshOrCloud> before;
    std::optional<MeshOrCloud> after;
    std::optional<Cloud> errors;
    std::optional<ComparisonReport> comparison;
    std::vector<SourceFile> sources; ///< in the order of reading
    std::vector<std::string> doubts; ///< about files that are not of one run
};

/// The names of the files; empty: there is none.
struct RunFileNames {
    std::string job, samples, surface, plan, grinding, trace, before, after, errors, comparison, alignment, form;
    std::optional<Units::Length> before_units; ///< if not the run's
};

/// Reads them. The units are those of the job, else of the plan, the surface, the first point file or report that
/// states some, else mm.
/// @throws InputError for a file that is not what it is named as (a trace without its fields, an error map without
///         `error`), units that disagree, or if none is named
RunFiles read_run(const RunFileNames& names);

} // namespace fettle
