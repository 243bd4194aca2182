#pragma once

#include "job/boundary.h"
#include "units/units.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <variant>

namespace fettle::clean {

/// A ball.
struct Sphere {
    Eigen::Vector3d centre;
    double radius;
};

/// What stands over, or lies under, a polygon in the plane x y, from one height to another; of a job in the job's
/// frame.
struct Prism {
    job::Polygon polygon;
    double min_z, max_z;
    Eigen::Isometry3d T_prism_part = Eigen::Isometry3d::Identity();
};

/// A region of space, in the unit that it was stated in.
using Region = std::variant<Eigen::AlignedBox3d, Sphere, Prism>;

struct StatedRegion {
    Region region;
    std::optional<units::Units> job_units; ///< of the job that it comes from, in mm then; else in the stater's unit
};

/// Parses "box:X0,Y0,Z0,X1,Y1,Z1", "sphere:X,Y,Z,RADIUS" or "polygon:Z0,Z1,X1,Y1,X2,Y2,X3,Y3,…"; anything else names
/// a job, whose sampling boundary (without one: whose anomaly's) is the polygon, at any height.
/// @throws InputError for numbers that bound nothing, and as read_job()
StatedRegion parse_region(const std::string& text);

/// The region with all lengths multiplied.
Region scaled(Region region, double factor);

/// The region for points that are in the job's frame already.
Region in_job_frame(Region region);

/// True if a point lies in the region or on its border. @param point  in the part's frame
bool contains(const Region& region, const Eigen::Vector3d& point);

} // namespace fettle::clean
