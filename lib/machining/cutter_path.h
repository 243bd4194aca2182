#pragma once

#include "cloud/cloud.h"
#include "machining/cutter.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace fettle {

/// One move of the cutter's tip, straight or along a level arc; the axis stays upright.
struct CutterMove {
    Eigen::Vector3d from, to; ///< M, mm
    double sweep = 0;         ///< of an arc, rad, counter-clockwise seen from above; 0: straight
    Eigen::Vector2d centre = Eigen::Vector2d::Zero(); ///< of an arc, as far from its end as from its beginning
    double feed = 0;                                  ///< mm/s; 0: rapid
    std::size_t place = 0; ///< line of the program, or number of the point from 1, where the move ends

    bool rapid() const { return feed == 0; }
};

/// mm
double length(const CutterMove& move);

/// Straight moves from point to point of a cloud. A field `feed` is that of the move which ends at a point (0: rapid),
/// else all have `feed`.
/// @param contacts  are the points where the cutter touches (CC), with normals, rather than where its tip is (CL)?
/// @param source    the cloud's name for messages
/// @param axis      that of all poses (qw qx qy qz), if the points have them, unit
/// @throws InputError, with the point's number, for NaN, a feed that is negative, another axis, or a contact that the
/// cutter cannot have
std::vector<CutterMove> moves_through(const Cloud& points, const Cutter& cutter, bool contacts, double feed,
                                      const std::string& source,
                                      const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ());

} // namespace fettle
