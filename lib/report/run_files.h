#pragma once

#include "cloud/cloud.h"
#include "job/job.h"
#include "mesh/shape_file.h"
#include "plan/plan.h"
#include "report/tool_reports.h"
#include "surface/surface.h"
#include "units/units.h"

#include <optional>
#include <string>
#include <vector>

namespace fettle::report {

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
    std::optional<FormReport> nominal;
    std::vector<std::pair<std::string, std::string>> head; ///< name and value: part, serial number, operator, date, …
    std::optional<PlayedFrames> frames;
    bool judges_all = false;           ///< also what the part lacked before it was ground
    std::vector<SourceFile> sources;   ///< in the order of reading
    std::vector<std::string> warnings; ///< warnings about files that do not belong to the same run
};

/// Names of the files; empty: not given.
struct RunFileNames {
    std::string job, samples, surface, plan, grinding, trace, before, after, errors, comparison, alignment, form,
        nominal, frames;
    std::optional<units::Units::Length> before_units; ///< units of `before`, if not those of the run
};

/// Reads the files. The units are those of the job, else of the plan, of the surface, of the first point file or report
/// that states units, else mm.
/// @throws InputError for a file without its required fields, for contradictory units, or if no file is given
RunFiles read_run(const RunFileNames& names);

} // namespace fettle::report
