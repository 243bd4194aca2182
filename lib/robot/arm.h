#pragma once

#include "robot/robot.h"

#include <array>
#include <cstddef>

namespace fettle {

/// How near an arm is to where it loses a degree of freedom: 0 there, at most about 1. Their product times
/// |a2| L (|a2| + L), L being the forearm's length, is the size of the Jacobian's determinant at the wrist centre.
struct Singularity {
    double shoulder = 0; ///< distance of the wrist centre from axis 1 along the arm's plane, over |a2| + L
    double elbow = 0;    ///< sine of the angle of the forearm, from elbow to wrist centre, to the upper arm
    double wrist = 0;    ///< sine of the angle between axes 4 and 6

    double least() const;
};

/// Joints that reach a pose, and how.
struct ArmSolution {
    Joints joints; ///< the turns of each that are nearest to the middle of its range
    int branch;    ///< 4: the wrist centre lies behind axis 1, + 2: the elbow bends the other way, + 1: the wrist does
};

/// At most eight.
struct ArmSolutions {
    std::array<ArmSolution, 8> solutions;
    std::size_t count = 0;
    bool reachable = false; ///< within the links' lengths, whatever the ranges

    const ArmSolution* begin() const { return solutions.data(); }
    const ArmSolution* end() const { return solutions.data() + count; }
    std::size_t size() const { return count; }
};

enum class Ranges { respect, ignore };

/// A range is kept if a joint is beyond it by no more than this, rad: roundings of a pose that was made at its end.
inline constexpr double kRangeSlack = 1e-9;

/// Is the joint within its range?
inline bool within(const JointRange& range, double value)
{
    return value >= range.least - kRangeSlack && value <= range.most + kRangeSlack;
}

/// Forward and closed-form inverse kinematics of an arm with parallel axes 2 and 3 and a spherical wrist (Pieper 1968),
/// in the Denavit-Hartenberg convention of Chen & Wei, eq. 1 and 2.
class Arm {
  public:
    explicit Arm(const Robot& robot);

    /// Frames 0 (base) to 6 (flange), in the base frame. Chen & Wei eq. 2
    std::array<Eigen::Isometry3d, 7> frames(const Joints& joints) const;
    Eigen::Isometry3d flange(const Joints& joints) const { return frames(joints)[6]; }

    /// All joints that bring the flange there. Where the wrist is straight or the wrist centre lies on axis 1 there are
    /// infinitely many: those nearest to `near` stand for them.
    ArmSolutions solve(const Eigen::Isometry3d& T_base_flange, const Joints& near, Ranges ranges) const;

    Singularity singularity(const Joints& joints) const;
    bool in_range(const Joints& joints) const;

  private:
    struct Reach;
    void add_elbows(const Reach& reach, double theta1, int shoulder, ArmSolutions& found) const;
    void add_wrists(const Reach& reach, const Joints& arm, const Eigen::Matrix3d& R_3_5, int branch,
                    ArmSolutions& found) const;
    /// Turns joint k of `joints` to the middle of its range. @return  may it go on?
    bool settle(Joints& joints, Eigen::Index k, Ranges ranges) const;

    std::array<DhRow, 6> dh_;
    Coupling coupling_;
    double sin_alpha_[5];  ///< of rows 1 to 5; 1 or -1 but for the second
    double forearm_;       ///< L: from joint 3 to the wrist centre
    double forearm_angle_; ///< of L to x3
    Eigen::Matrix3d tilt_; ///< R_x(-alpha6)
    Eigen::Vector3d hand_; ///< from the wrist centre to the flange, flange frame
};

} // namespace fettle
