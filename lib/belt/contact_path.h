#pragma once

#include "belt/surfel.h"
#include "cloud/poses.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace fettle::belt {

enum class PathPattern {
    rows,  ///< side by side
    spiral ///< along the four sides of the patch's rectangle in u and v, from outside in
};

/// How the tool turns about its axis along a path.
enum class PathOrientation {
    fixed, ///< its x points along u (along v) on every row, whichever way the row runs, or on all of a later patch
           ///< against it, if the tool then turns less on the way there
    along  ///< its x points along the feed
};

/// One patch after the other, in the order of their numbers.
inline constexpr int kAllPatches = -1;

struct ContactPathOptions {
    int patch = kAllPatches;
    PathPattern pattern = PathPattern::rows;
    bool along_v = false; ///< rows, and the first side of a spiral, run along v, otherwise along u
    bool one_way = false; ///< all rows run in the same direction; otherwise they alternate
    PathOrientation orientation = PathOrientation::along;
    bool on_stock = false; ///< points on the stock, not on the design
    double step_over = 1;  ///< max. distance of rows or turns of the spiral, mm
    double spacing = 1;    ///< max. distance of points along a row, mm
};

/// Contact points along a path.
struct ContactPath {
    cloud::PosePath poses; ///< part frame: +z the outward normal, +x as PathOrientation says
    std::vector<int> pass; ///< of each point, from 0: a row, or a piece of a row that holes and borders interrupt
    std::vector<int> skipped_patches; ///< of all patches those with too few surfels for a surface
};

/// Plans a contact path over one patch or all. Between surfels the surface is a local quadratic in u and v
/// (local_fit.h). Where no surfel is within its radius the patch ends, and so does the pass.
/// @throws InputError if there is no such patch, or too few surfels on it, of all patches on each
ContactPath contact_path(const Surfels& surfels, const ContactPathOptions& options);

/// Inserts points, equally spaced, between points of a path that are farther apart than the spacing. Positions and
/// scalar fields are interpolated linearly, orientations by slerp along the shorter arc (Ren et al. 2006, eq. 6;
/// Shoemake 1985). Nothing is inserted between points of different `pass`, next to NaN poses, and off the part.
/// @param path  with poses   @param spacing  mm
cloud::Cloud interpolate_path(const cloud::Cloud& path, double spacing);

/// Length of a path up to each pose, mm; NaN poses do not count. For a part in a robot's hand it is what its feed is
/// along: where the part turns about the contact, its frame moves more or less.
Eigen::VectorXd way_along(const cloud::PosePath& poses);

/// Path of a part that the robot holds against a fixed wheel: the poses of the part's frame in which each contact point
/// meets the wheel. The frames are those of fettle-arm: the part's frame is the tool frame of the robot's file, with z
/// out of the robot; in a path that frame is turned by 180° about x.
/// @param T_part_contact  contact points on the part
/// @param T_cell_wheel    contact frame on the wheel: +z into the wheel, +x along the feed
cloud::PosePath held_part_path(const cloud::PosePath& T_part_contact, const Eigen::Isometry3d& T_cell_wheel);

} // namespace fettle::belt
