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
};

/// A file that was read.
struct SourceFile {
    std::string role, name; ///< role in the run ("job"), file name
    std::size_t bytes = 0;
    std::string sha256;
};

/// The data of one run. Clouds, meshes, job, surface and plan are in base units; reports are in `units`.
struct RunFiles {
    units::Units units;
    std::optional<job::Job> job;
    std::optional<cloud::Cloud> samples;
    std::optional<surface::Surface> surface;
    std::optional<plan::Plan> plan;
    std::optional<AlignmentReport> alignment;
    std::optional<FormReport> form;
    std::optional<GrindReport> grinding;
    std::optional<cloud::Cloud> trace;
    std::optional<mesh::MeshOrCloud> before;
    std::optional<mesh::MeshOrCloud> after;
    std::optional<cloud::Cloud> errors;
    std::optional<ComparisonReport> comparison;
    std::vector<SourceFile> sources;   ///< in the order of reading
    std::vector<std::string> warnings; ///< warnings about files that do not belong to the same run
};

/// Names of the files; empty: not given.
struct RunFileNames {
    std::string job, samples, surface, plan, grinding, trace, before, after, errors, comparison, alignment, form;
    std::optional<units::Units::Length> before_units; ///< units of `before`, if not those of the run
};

/// Reads the files. The units are those of the job, else of the plan, of the surface, of the first point file or report
/// that states units, else mm.
/// @throws InputError for a file without its required fields, for contradictory units, or if no file is given
RunFiles read_run(const RunFileNames& names);

} // namespace fettle::report
