#pragma once

#include "cloud/cloud.h"
#include "core/progress.h"
#include "merge/registration.h"
#include "units/units.h"
#include "json/document.h"

#include <optional>
#include <string>
#include <vector>

namespace fettle::merge {

/// Merging of files, each a cloud or a mesh, whose vertices are then the points.
struct MergeRequest {
    std::vector<std::string> scans;           ///< paths, two or more
    std::optional<units::Units::Length> unit; ///< of the files; nothing: as they say, else mm
    std::string poses;                        ///< a report of an earlier run to start from; empty: search
    core::Progress progress;
};

struct MergeRun {
    cloud::Cloud merged; ///< in the frame of the first scan that has a place, mm
    units::Units units;  ///< of the first file
    json::Value report;  ///< kind "poses"
    std::vector<std::string> warnings;
    bool all_placed = false; ///< no scan was left out
    bool converged = false;
};

/// @throws InputError as read_cloud_mesh(), clean_part() and register_scans(); for fewer than two scans, a scan without
/// surface, and poses that are not of these files
MergeRun merge_files(const MergeRequest& request);

/// "scans", "pairs", "refused", "scatter", "converged". @param points  of each scan that were used
json::Value to_json(const Registration& registration, const Scans& scans, const units::Units& units);

/// Poses of a report, in the order of `files`. @return  T_world_scan, mm
/// @throws InputError if a file is missing in it, or has no pose there
std::vector<Eigen::Isometry3d> read_poses(const std::string& path, const std::vector<std::string>& files);

} // namespace fettle::merge
