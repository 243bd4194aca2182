#pragma once

#include "draw/frames.h"
#include "plan/plan.h"
#include "removal/height_field.h"
#include "strategy/trace.h"

#include <vector>

namespace fettle::strategy {

/// Adds pictures of the stock at equal times of a run: its heights over the desired surface, as errors, in the colours
/// of four tolerances. The stock at a time is that of the trace's rows until then (replay_removal()).
void add_frames(draw::Frames& frames, const std::vector<TraceRow>& trace, const plan::Plan& plan,
                const removal::HeightField& stock);

} // namespace fettle::strategy
