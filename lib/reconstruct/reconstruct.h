#pragma once

#include "cloud/cloud.h"
#include "mesh/cloud_mesh.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace fettle::reconstruct {

/// How a cloud becomes a mesh.
struct ReconstructRequest {
    std::optional<double> max_gap;         ///< no triangle has a longer edge, mm; without it kDefaultGapSpacings
    std::optional<Eigen::Vector3d> facing; ///< the surface faces this way
    std::optional<Eigen::Vector3d> from;   ///< the surface was seen from here, mm
};

/// Default of the largest gap in spacings of the points: three let every hole stay open that a person would call one.
inline constexpr double kDefaultGapSpacings = 3;

/// What decided which side of the surface is outside.
enum class OuterSide { normals, from, facing, viewpoint, guessed };
std::string to_string(OuterSide side);

struct Reconstruction {
    mesh::CloudMesh mesh;          ///< of measured points, with all their fields, in their order
    std::string order;             ///< what joined the points: "grid", "profiles" or "none"
    double max_gap = 0;            ///< mm
    OuterSide side{};              ///< for a grid or profiles without it, +z; else convex from outside
    Eigen::Index left_out = 0;     ///< points of no triangle
    Eigen::Index filled_holes = 0; ///< that were narrower than the gap
    Eigen::Index borders = 0;      ///< closed lines around what stays open: holes, and the scan's end
};

/// Makes triangles of a cloud. Its points are the vertices: nothing is smoothed, nothing is added. Points of an
/// organised cloud and of a profiler's list are joined along their order, which tells neighbours from strangers even
/// where profiles lie ten times farther apart than their points; all others by their Delaunay stars (stars.h), whose
/// narrow holes are then filled (Barequet & Sharir 1995). Wider holes stay open. pcl::Poisson closes every hole,
/// invents what lies in it, and links VTK; pcl::GreedyProjectionTriangulation folds triangles (stars.h).
/// @throws InputError for fewer than three points, for more than 20 million that are no grid, and if nothing is joined
///         within the gap
Reconstruction reconstruct(const cloud::Cloud& cloud, const ReconstructRequest& request);

} // namespace fettle::reconstruct
