#pragma once

#include "job/job.h"
#include "removal/height_field.h"
#include "strategy/run.h"

#include <vector>

namespace fettle::calibrate {

/// A stroke: the wheel grinds along a pass without being lifted.
struct Stroke {
    double radius = 0;  ///< of the wheel, as measured before, mm
    double removed = 0; ///< with what the wheel takes in place before the next stroke, mm³
};

/// Grinding between two readings from which the trace tells both the force and the stock.
struct Interval {
    std::size_t stroke = 0;
    double impulse = 0, duration = 0, volume = 0; ///< ∫F dt, N s; s; mm³
    /// Volume weighted with the cosine of the rim's slope where it is removed, and with its sine, which is positive on
    /// the side of +Y_w, mm³.
    double cosine_volume = 0, sine_volume = 0;
};

struct Replay {
    removal::HeightField left; ///< the stock after the run, as far as the trace tells
    std::vector<Stroke> strokes;
    std::vector<Interval> intervals;
};

bool is_grinding(const strategy::TraceRow& row);

/// Cuts the stock where the trace says that the wheel was. What it cut on its way off the metal is in no row: a second
/// stock, cut there, too, is a lower bound. Where the two disagree on a volume, or the force rose and fell between two
/// readings, there is no interval.
/// @param stock       before the run
/// @param compliance  of the machine: its rim is higher by that times the force, mm/N
Replay replay(const std::vector<strategy::TraceRow>& trace, const job::Job& job, const removal::HeightField& stock,
              double compliance);

} // namespace fettle::calibrate
