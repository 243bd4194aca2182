#pragma once

#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"
#include "strategy/steering.h"

#include <functional>

namespace fettle {

/// Boundary points as the operator has shown them, 3xN, M, mm; z is NaN where the probe met nothing.
struct TaughtBoundaries {
    Eigen::Matrix3Xd anomaly, sampling;
};

/// Told of each point when it is recorded. @param boundary  which one  @param number  in it, from 1
using Recorded = std::function<void(const char* boundary, Eigen::Index number, const Eigen::Vector3d& point)>;

/// The operator moves the gantry at the job's feed and safe height, and has the probe touch the part at each boundary
/// point (Wang 2007, 6.1.1): first those around the anomaly; after Button::next those around what may be touched; the
/// next push, or the end of the steering, ends it. The machine stops where its range ends. Of a tip with a radius the
/// points of contact are recorded (contact_points() in sampling/probe.h, with the job's surface and θ).
/// @param lowest  z, mm; the probe goes no lower
/// @throws GantryFault
TaughtBoundaries teach_boundaries(const Job& job, Gantry& gantry, const protocol::Limits& limits, Steering& steering,
                                  double lowest, const Recorded& recorded);

} // namespace fettle
