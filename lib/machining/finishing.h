#pragma once

#include "cloud/cloud.h"
#include "machining/cutter.h"
#include "machining/discretization.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <iosfwd>
#include <string>
#include <vector>

namespace fettle::machining {

/// Tip position (mm) and the feed of the move to it (mm/s; 0: rapid).
struct TipPoint {
    Eigen::Vector3d tip;
    double feed = 0;
};

struct FinishingOptions {
    double step_over = 1; ///< largest distance of passes in plan view, mm
    double overhang = 0;  ///< extension of the path beyond the design's bounding box, mm
    double angle = 0;     ///< direction of the passes, rad, counter-clockwise from X
    double feed = 10;     ///< mm/s
    double clearance = 5; ///< height of rapid moves over the design's highest point, mm
    double allowance = 0; ///< stock left everywhere, along Z, mm
};

/// Step-over that leaves scallops of the given height s, mm. On a plane a ball or corner of radius r has the step-over
/// 2√(2 r s − s²); convex curvature of radius R is taken as 1/r + 1/R, a slope by its longer distance.
/// @throws InputError for a cutter without a ball or corner
double step_over_for(double scallop, const Cutter& cutter, const DesignShape& shape);

/// Largest horizontal distance of the tip from the contact, on the design's steepest slope, mm: a path must extend so
/// far beyond the border of the design.
double overhang_for(const Cutter& cutter, const DesignShape& shape);

/// A zig-zag over the design's bounding box. The cutter touches the design at every point (drop_cutter.h). Points are a
/// third of the step-over apart, closer where the middle of a straight move would be off by more than 0.005 mm; at
/// walls the move is vertical. Points on a straight move are left out (straight_way.h). Passes are joined on the design
/// where the cutter touches it all the way, otherwise at the clearance height.
/// @throws InputError if the cutter touches nothing, or for more than 10^8 points
std::vector<TipPoint> finishing_path(const mesh::Mesh& design, const Cutter& cutter, const FinishingOptions& options);

/// The tips as points with the field `feed`.
cloud::Cloud to_cloud(const std::vector<TipPoint>& path);

/// Writes G-code in mm with five decimals. @param title  text of its first comment
void write_gcode(std::ostream& out, const std::vector<TipPoint>& path, const std::string& title);

} // namespace fettle::machining
