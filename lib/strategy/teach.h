#pragma once

#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"
#include "strategy/steering.h"

#include <functional>
#include <vector>

namespace fettle::strategy {

/// Boundary points that the operator has taught, 3xN, M, mm; z is NaN where the probe met nothing.
struct TaughtBoundaries {
    Eigen::Matrix3Xd anomaly, sampling;
};

/// The steering time, which goes on while something moves and skips to the next event while nothing does.
struct SteeringClock {
    Steering& steering;
    double time = 0; ///< s

    const Stick& stick() { return steering.at(time); }
    /// Advances by a step of a motion: by `period`, or less if the stick is moved before. @return  its duration, s
    double advance(double period);
    /// Waits for the operator: skips to the next event of a file, and sleeps for `period` beside a device or keys.
    void rest(double period);
};

/// Between two readings of the stick while boundary points are shown: a machine that answers within some ms can follow.
inline constexpr double kTeachingPeriod = 0.02; // s

/// Moves the machine at the job's feed and safe height, as the operator asks, and touches the part with the probe. The
/// machine stops at the end of its range.
class Teacher {
  public:
    /// @param lowest  lower bound of the probe's z, mm   @throws GantryFault
    Teacher(const job::Job& job, gantry::Gantry& gantry, const gantry::protocol::Limits& limits, double lowest);

    const Eigen::Vector3d& position() const { return position_; }
    /// @param direction  of any length but 0, M   @param duration  s
    void move(const Eigen::Vector2d& direction, double duration);
    /// @return  lowest point of the tip at the touch, M, mm; z is NaN if it met nothing
    Eigen::Vector3d touch();

  private:
    const job::Job& job_;
    gantry::Gantry& gantry_;
    gantry::protocol::Limits limits_;
    double lowest_;
    Eigen::Vector3d position_;
};

/// The boundary points of touches by the probe. If its tip has a radius, they are the points of contact:
/// contact_points() in sampling/probe.h, with the job's surface and θ, through all of them.
/// @param anomaly, sampling  lowest points of the tip
TaughtBoundaries boundaries_of_touches(const job::Job& job, const std::vector<Eigen::Vector3d>& anomaly,
                                       const std::vector<Eigen::Vector3d>& sampling);

/// Called for each recorded point. @param boundary  "anomaly" or "sampling"   @param number  of the point in it, from 1
using PointCallback = std::function<void(const char* boundary, Eigen::Index number, const Eigen::Vector3d& point)>;

/// Teaching on the machine (Wang 2007, 6.1.1). The points around the anomaly come first; after Button::next those
/// around the sampling region; the next push, or the end of the steering, ends it.
/// @param lowest  lower bound of the probe's z, mm
/// @throws GantryFault
TaughtBoundaries teach_boundaries(const job::Job& job, gantry::Gantry& gantry, const gantry::protocol::Limits& limits,
                                  Steering& steering, double lowest, const PointCallback& recorded);

} // namespace fettle::strategy
