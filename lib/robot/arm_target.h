#pragma once

// Shared by the closed forms of the inverse kinematics. It is private to arm*.cc.

#include "robot/arm.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace fettle::robot {

inline constexpr double kPi = std::numbers::pi;
/// Below this sine of joint 5 the pose determines only the sum of the joints beside it. Any split of the sum changes
/// the pose by no more than this, rad.
inline constexpr double kMinWristSine = 1e-10;
/// A wrist centre no farther from axis 1 counts as on it, mm.
inline constexpr double kAxisDistanceTolerance = 1e-10;
/// A cosine that exceeds 1 by no more counts as rounded: 1e-12 moves a wrist centre 1 m away by less than 1e-9 mm.
inline constexpr double kCosineRounding = 1e-12;

struct CosSin {
    double cosine, sine;
};

/// The angle between two links whose far ends are at a distance, 0 if they are straight; sine >= 0. Nothing if the
/// distance is out of reach. Both sums of the law of cosines are taken from their ends, so that it is accurate there.
std::optional<CosSin> bend_of_links(double a, double b, double distance);

/// Shifts an angle by whole turns to within half a turn of `middle`.
inline double wrap_about(double angle, double middle)
{
    constexpr double kFewTurns = 8 * kPi; // angles that the closed forms find are no farther
    constexpr double kTurnsPerRad = 1 / (2 * kPi);
    // Adding this and taking it off rounds to an integer, without a branch that cannot be foreseen.
    constexpr double kRounding = 1.5 / std::numeric_limits<double>::epsilon();
    const double from_middle = angle - middle;
    if (std::abs(from_middle) > kFewTurns) [[unlikely]]
        return middle + std::remainder(from_middle, 2 * kPi);
    return angle - 2 * kPi * (from_middle * kTurnsPerRad + kRounding - kRounding);
}

/// The target of the inverse kinematics, with the choice of the shoulder.
struct Arm::Target {
    const Eigen::Matrix3d& R;     ///< R_base_5 R_z(theta6)
    Eigen::Vector3d wrist_centre; ///< base frame, mm
    const Joints& seed;
    Ranges ranges;
    double across; ///< signed distance of the wrist centre from axis 1 in the arm's plane, negative behind the axis
    CosSin turn1;  ///< of theta1
};

inline bool Arm::wrap(Joints& joints, Eigen::Index k, Ranges ranges) const
{
    const JointRange& range = dh_[k].range;
    joints[k] = wrap_about(joints[k], (range.min + range.max) / 2);
    return ranges == Ranges::ignore || range.contains(joints[k]);
}

} // namespace fettle::robot
