#pragma once

#include "align/align.h"
#include "mesh/cloud_mesh.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace fettle::align {

/// Registration of a file to another, each a mesh or a cloud. Lengths are in the unit of the scan.
struct AlignRequest {
    std::string scan, reference;                                   ///< paths; "-": stdin
    std::optional<units::Units::Length> scan_unit, reference_unit; ///< of the files; nothing: as they say, else mm
    std::string start;                  ///< file of the transform to start from; empty: the identity
    bool search = true;                 ///< search all poses, unless there is a start
    std::optional<double> max_distance; ///< as IcpOptions::max_distance
    IcpOptions icp;                     ///< the others; without iterations the start is applied as it is
};

struct AlignRun {
    Eigen::Matrix4d transform; ///< p_reference = transform · p_scan
    mesh::CloudMesh aligned;   ///< the scan, with all its fields and triangles
    units::Units units;        ///< of the scan
    json::Value report;
    std::vector<std::string> warnings;
    bool converged = false; ///< or applied as it is
    bool sure = false;      ///< there are no doubts()
};

/// @throws InputError as read_shape(), read_transform(), AlignReference and align()
AlignRun align_files(const AlignRequest& request);

} // namespace fettle::align
