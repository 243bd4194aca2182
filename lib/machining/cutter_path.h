#pragma once

#include "cloud/cloud.h"
#include "machining/cutter.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace fettle::machining {

/// One move of the cutter's tip, straight or along a horizontal arc; the axis stays vertical.
struct CutterMove {
    Eigen::Vector3d from, to; ///< M, mm
    double sweep_angle = 0;   ///< angle of an arc, rad, counter-clockwise seen from above; 0: straight
    Eigen::Vector2d centre = Eigen::Vector2d::Zero(); ///< centre of an arc, equally far from both its ends, mm
    double feed = 0;                                  ///< mm/s; 0: rapid
    std::size_t source_line = 0; ///< where the move ends: line of the program, or number of the point, from 1

    bool rapid() const { return feed == 0; }
};

/// Length of the path of the tip, mm. An arc counts by its angle.
double length(const CutterMove& move);

/// Straight moves from point to point of a cloud, in the tilted frame. The field `feed` of a point, mm/s, is that of
/// the move which ends there (0: rapid); without the field all moves have the parameter `feed`.
/// @param contacts  true: the points are cutter contacts (CC) with normals; false: cutter locations (CL, the tip)
/// @param source    the cloud's name for messages
/// @param axis      cutter axis in M, unit; poses of the points (qw qx qy qz), if any, must have it
/// @throws InputError, with the point's number, for NaN, a negative feed, another axis, or a contact that the cutter
/// cannot have
std::vector<CutterMove> moves_from_points(const cloud::Cloud& points, const Cutter& cutter, bool contacts, double feed,
                                          const std::string& source,
                                          const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ());

} // namespace fettle::machining
