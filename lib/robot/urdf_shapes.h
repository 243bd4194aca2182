#pragma once

#include "robot/solid.h"

#include <Eigen/Geometry>

#include <map>
#include <string>

namespace urdf {
class Geometry;
class Pose;
} // namespace urdf

namespace fettle::robot {

inline constexpr double kMmPerMetre = 1000; ///< lengths in a URDF are in metres

/// Where the mesh of a link is looked for.
struct UrdfFiles {
    const std::string& source;                          ///< the URDF; a relative name is relative to its folder
    const std::string& link;                            ///< for messages
    const std::map<std::string, std::string>& packages; ///< folders of the packages that package:// names
    bool exact_meshes;                                  ///< as they are; false: as their convex hulls
};

/// A pose of a URDF, which is in m, with mm. Quarter turns and lengths that were written with few digits are rounded to
/// what they stand for. @throws InputError where it is not finite or beyond 100 m
Eigen::Isometry3d urdf_isometry(const urdf::Pose& pose);

/// A collision shape, placed by T in the frame that it moves with, mm.
/// @throws InputError for lengths that are not positive, and for meshes that are missing or of another format
Solid urdf_solid(const urdf::Geometry& geometry, const Eigen::Isometry3d& T, const UrdfFiles& files);

} // namespace fettle::robot
