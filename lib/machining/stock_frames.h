#pragma once

#include "draw/frames.h"
#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "machining/milling.h"
#include "removal/height_field.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::machining {

/// Adds pictures of the stock at equal times while it is milled: its heights, tool axis up, always in the same colours.
/// @param ends  time at the end of each move, s   @param stock  before; the moves are cut once more
void add_frames(draw::Frames& frames, removal::HeightField stock, const Cutter& cutter,
                const std::vector<CutterMove>& moves, const Eigen::VectorXd& ends, const MillingOptions& options);

} // namespace fettle::machining
