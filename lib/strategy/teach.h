#pragma once

#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"
#include "strategy/steering.h"

#include <functional>

namespace fettle::strategy {

/// Boundary points that the operator has taught, 3xN, M, mm; z is NaN where the probe met nothing.
struct TaughtBoundaries {
    Eigen::Matrix3Xd anomaly, sampling;
};

/// Called for each recorded point. @param boundary  "anomaly" or "sampling"   @param number  of the point in it, from 1
using PointCallback = std::function<void(const char* boundary, Eigen::Index number, const Eigen::Vector3d& point)>;

/// Teaching on the machine (Wang 2007, 6.1.1): the operator moves the gantry at the job's feed and safe height, and
/// touches the part with the probe at each boundary point. The points around the anomaly come first; after Button::next
/// those around the sampling region; the next push, or the end of the steering, ends it. The machine stops at the end
/// of its range. If the tip has a radius, the points of contact are recorded (contact_points() in sampling/probe.h,
/// with the job's surface and θ).
/// @param lowest  lower bound of the probe's z, mm
/// @throws GantryFault
TaughtBoundaries teach_boundaries(const job::Job& job, gantry::Gantry& gantry, const gantry::protocol::Limits& limits,
                                  Steering& steering, double lowest, const PointCallback& recorded);

} // namespace fettle::strategy
