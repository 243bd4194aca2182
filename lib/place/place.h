#pragma once

#include "job/job.h"
#include "mesh/cloud_mesh.h"
#include "place/region.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace fettle::place {

/// A turn about an axis of M.
struct Turn {
    int axis;     ///< 0: x, 1: y, 2: z
    double angle; ///< rad, counter-clockwise seen against the axis
};

/// How a part is moved: by the matrix first, then by the turns, one after the other, then what is up is turned to +z,
/// then the middle is put to the origin.
struct PlaceRequest {
    std::optional<Eigen::Matrix4d> matrix; ///< rigid, lengths in the unit of the part's file
    std::vector<Turn> turns;
    std::optional<RegionShape> up;          ///< the largest region of this shape faces up
    std::optional<Eigen::Matrix3Xd> picked; ///< 3xN, mm: the plane through these points faces up
    std::optional<double> threshold;        ///< of find_region(), mm; without it a share of the part's diagonal
    std::optional<job::Job> into;           ///< into the frame of this job, in which the part may be already; alone
    bool is_centred = false; ///< the centre of what is up, else of the part's bounding box, comes to the origin
};

struct PlacedPart {
    mesh::CloudMesh part;
    Eigen::Matrix4d transform;         ///< p_placed = transform · p, lengths in the unit of the part's file
    std::optional<FoundRegion> region; ///< what faces up, before it was turned
    bool is_side_guessed = false;      ///< neither normals nor a viewpoint say which side of it is up
};

/// Moves a part: points, normals, poses and viewpoint; triangles and all other fields stay as they are.
/// @param mm  millimetres in the unit of the part's file
/// @throws InputError as find_region(), and for picked points on a line
PlacedPart place_part(mesh::CloudMesh part, const PlaceRequest& request, double mm);

/// The inverse of a rigid transform.
Eigen::Matrix4d inverse_of(const Eigen::Matrix4d& transform);

} // namespace fettle::place
