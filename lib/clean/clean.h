#pragma once

#include "clean/crop.h"
#include "clean/outliers.h"
#include "clean/thinning.h"
#include "mesh/cloud_mesh.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace fettle::clean {

/// What is taken away from a scan, in this order, after what is never a measured point: points that are not finite,
/// points at exactly (0, 0, 0) where there are several (some scanners write them for no echo), points where another one
/// is, and triangles drawn twice.
struct CleanRequest {
    std::optional<Region> crop;            ///< what lies outside is left out, mm
    std::optional<Eigen::Vector3d> facing; ///< what faces away from this direction is left out
    std::optional<OutlierFilter> outliers;
    std::optional<Thinning> thinning;
    bool keeps_organised = false; ///< what is taken away from an organised cloud leaves NaN at its place
};

/// A filter and what it took away.
struct FilterCount {
    std::string name; ///< key in the report: invalid, at_origin, duplicates, cropped, facing_away, outliers, thinned
    Eigen::Index removed = 0; ///< points; of a mesh those vertices, or triangles, on which the filter acts
};

struct CleanResult {
    mesh::CloudMesh part;
    std::vector<FilterCount> filters; ///< in the order of their work
    Eigen::Index points_left = 0;
};

/// Cleans a cloud or a mesh. Points keep their order and their fields. A triangle stays if its three corners do; a mesh
/// faces a direction with its triangles, a cloud with its normals.
/// @throws InputError if nothing is left, for --facing with a cloud without normals, for thinning of a mesh, and to
/// keep what is not organised
CleanResult clean_part(mesh::CloudMesh part, const CleanRequest& request);

} // namespace fettle::clean
