#pragma once

#include "cloud/cloud.h"
#include "machining/cutter.h"
#include "machining/discretization.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <iosfwd>
#include <string>
#include <vector>

namespace fettle {

/// Where the tip goes, and how fast: mm, mm/s; feed 0: rapid.
struct TipPoint {
    Eigen::Vector3d tip;
    double feed = 0;
};

struct FinishingOptions {
    double step_over = 1; ///< at most, seen from above, mm
    double overhang = 0;  ///< of the path beyond the design's box, mm
    double angle = 0;     ///< of the passes, rad, counter-clockwise from X
    double feed = 10;     ///< mm/s
    double clearance = 5; ///< of rapid moves over the design's highest point, mm
    double allowance = 0; ///< left everywhere in Z, mm
};

/// Between passes on a plane, a ball or a corner of radius r leaves ridges as high as `scallop` if they are 2√(2 r s −
/// s²) apart; bulges of radius R count as 1/r + 1/R, slopes as the longer way across them. mm
/// @throws InputError for a cutter without a ball or corner
double step_over_for(double scallop, const Cutter& cutter, const DesignShape& shape);

/// How far the tip may be from where the cutter touches, on the design's steepest slope, mm: a path must go so far
/// beyond a border that falls off.
double overhang_for(const Cutter& cutter, const DesignShape& shape);

/// A zig-zag over the design's box: the cutter touches the design at every point (drop_cutter.h), a third of the
/// step-over apart or, where the middle of a straight move would be off by more than 0.005 mm, nearer; at walls it goes
/// upright. Points that a straight move passes are left out (straight_way.h). Passes are joined over the design where
/// the cutter touches all the way, else above it.
/// @throws InputError if the cutter touches nothing, or for more than 10^8 points
std::vector<TipPoint> finishing_path(const Mesh& design, const Cutter& cutter, const FinishingOptions& options);

/// Points with field `feed`.
Cloud to_cloud(const std::vector<TipPoint>& path);

/// G-code in mm, five decimals. @param title  for its first comment
void write_gcode(std::ostream& out, const std::vector<TipPoint>& path, const std::string& title);

} // namespace fettle
