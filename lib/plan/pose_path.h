#pragma once

#include "cloud/cloud.h"
#include "plan/plan.h"
#include "plan/tool_path.h"

namespace fettle::plan {

/// The passes of some layers as the tool path of a robot, from the highest layer down, in the part's frame: the tip is
/// the lowest line of the wheel at mid-width, +z the direction in which the job's head lifts (the wheel's plane
/// contains it and +x, the direction of the passes), the same on passes there and back.
///
/// Fields: the pose; `layer` from 1; `pass` and `stroke`, a number for each contact interval, from 0; the desired
/// surface's normal; `feed`; and of the force while a layer is ground `force` (F_down) and `force_min`, `force_max`.
/// A robot grinds a layer by position, or by force; switching between layers by the force measured is what
/// strategy/layer_switching.h does on a gantry.
/// @param path  of the plan   @param layers  number of layers, at least 1
cloud::Cloud pose_path(const Plan& plan, const ToolPath& path, int layers);

} // namespace fettle::plan
