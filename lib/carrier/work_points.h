#pragma once

#include "plan/plan.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::carrier {

/// Distance of neighbouring points of work_points(), mm.
inline constexpr double kWorkPointSpacing = 2;

/// A way of the tool point through all that a strategy commands while it grinds a plan, as one line of points in the
/// job's frame, mm: over each contact interval from the safe height down to the stock's top, along the pass there and
/// back on the desired surface, as deep as the spring gives at F_max, and up again.
/// @param from  where the way begins   @param top  height of the stock
std::vector<Eigen::Vector3d> work_points(const plan::Plan& plan, const Eigen::Vector3d& from, double top);

} // namespace fettle::carrier
