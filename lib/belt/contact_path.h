#pragma once

#include "belt/surfel.h"
#include "cloud/poses.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace fettle {

enum class PathPattern {
    rows,  ///< side by side
    spiral ///< along the four sides of the patch's rectangle in u and v, from outside in
};

struct ContactPathOptions {
    int patch = 0;
    PathPattern pattern = PathPattern::rows;
    bool along_v = false;  ///< rows, and the first side of a spiral, run along v
    bool one_way = false;  ///< all rows run the same way; otherwise there and back
    bool on_stock = false; ///< places on the stock, not on the design
    double step_over = 1;  ///< of rows and of the spiral's turns, at most, mm
    double spacing = 1;    ///< of points of a row, at most, mm
};

/// Contact points along a path.
struct ContactPath {
    PosePath poses;        ///< part frame: +z the outward normal, +x along the feed
    std::vector<int> pass; ///< of each: rows, or pieces that holes and borders leave, from 0
};

/// Places between surfels are those of quadratics through their neighbours in u and v. Where there is no surfel within
/// its radius the patch is taken to end, and so does the pass.
/// @throws InputError if there is no such patch, or too few surfels on it
ContactPath contact_path(const Surfels& surfels, const ContactPathOptions& options);

/// A share of the way along the shorter arc between two unit quaternions (Ren et al. 2006, eq. 6; Shoemake 1985).
Eigen::Quaterniond slerp(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to, double share);

/// Points inserted between those farther apart than the spacing: equal parts, places by lerp, orientations by slerp,
/// other scalar fields linearly. Between two with different `pass` and beside NaN poses nothing is inserted.
/// @param path  with poses   @param spacing  mm
Cloud interpolated(const Cloud& path, double spacing);

/// The path of a part that the robot holds: where the part's frame must be, so that each contact point comes to lie in
/// the pose of a fixed wheel. The frames as fettle-arm has them: the part's frame is the robot's tool frame of its
/// file, whose z points out of the robot; a path has it turned half about x.
/// @param T_part_contact  poses of a path on the part   @param T_cell_wheel  the contact frame on the wheel: +z into
/// the wheel, +x along the feed
PosePath held_part(const PosePath& T_part_contact, const Eigen::Isometry3d& T_cell_wheel);

} // namespace fettle
