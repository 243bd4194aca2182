#pragma once

#include "robot/robot.h"

#include <array>
#include <cstddef>

namespace fettle::robot {

/// Distances of a joint configuration from the three kinds of singularity, where an arm loses a degree of freedom:
/// 0 there, at most about 1. With L the forearm's length, |det J| at the wrist centre is their product times
/// |a2| L (|a2| + L).
struct Singularity {
    double shoulder = 0; ///< distance of the wrist centre from axis 1 along the arm's plane, over |a2| + L
    double elbow = 0;    ///< sine of the angle of the forearm, from elbow to wrist centre, to the upper arm
    double wrist = 0;    ///< sine of the angle between axes 4 and 6

    /// The smallest of the three.
    double min() const;
};

/// One solution of the inverse kinematics.
struct ArmSolution {
    Joints joints; ///< rad, each within half a turn of the middle of its range
    /// 4: the wrist centre lies behind axis 1 (parallel axes: the other solution for joint 1), + 2: the elbow bends the
    /// other way, + 1: the wrist does. Of a general arm: in the order in which they were found.
    int branch;
};

/// Number of solutions that a pose of six revolute joints can have (Raghavan & Roth 1993).
inline constexpr std::size_t kMaxSolutions = 16;

/// The solutions of the inverse kinematics of one pose; of closed form at most eight.
struct ArmSolutions {
    std::array<ArmSolution, kMaxSolutions> solutions;
    std::size_t count = 0;
    bool reachable = false; ///< the wrist centre is within the links' lengths, whatever the joint ranges

    const ArmSolution* begin() const { return solutions.data(); }
    const ArmSolution* end() const { return solutions.data() + count; }
    std::size_t size() const { return count; }
};

/// Error of a pose that Newton's method reaches, mm, and rad at a lever of 1 m.
inline constexpr double kNewtonTolerance = 1e-10;

/// Are solutions with joints out of their ranges dropped?
enum class Ranges { respect, ignore };

/// Forward and inverse kinematics of an arm, in the Denavit-Hartenberg convention of Chen & Wei, eq. 1 and 2: in closed
/// form with parallel axes 2 and 3 and a spherical wrist (Pieper 1968), or with parallel axes 2, 3 and 4 (Hawkins 2013,
/// Analytic inverse kinematics for the Universal Robots); by Newton's method otherwise. Where a table departs a little
/// from the closed form's right angles and common points, as of a calibrated arm, Newton's method corrects its
/// solutions.
class Arm {
  public:
    explicit Arm(const Robot& robot);

    /// Frames 0 (base) to 6 (flange), in the base frame. Chen & Wei eq. 2
    std::array<Eigen::Isometry3d, 7> frames(const Joints& joints) const;
    Eigen::Isometry3d flange(const Joints& joints) const { return frames(joints)[6]; }

    /// Inverse kinematics: all joints that bring the flange to a pose. At a wrist or shoulder singularity there are
    /// infinitely many; there the undetermined joint is taken from `seed`.
    /// @param seed  joints, rad
    ArmSolutions solve(const Eigen::Isometry3d& T_base_flange, const Joints& seed, Ranges ranges) const;

    /// d(flange)/d(joints): rows 0 to 2 the velocity of the flange's origin, mm, 3 to 5 its rotation, both in the base.
    Eigen::Matrix<double, 6, 6> jacobian(const Joints& joints) const;
    /// Newton's method towards a pose, damped where it would lead away (Levenberg-Marquardt).
    /// @return  is it reached, to kNewtonTolerance?
    bool refine(const Eigen::Isometry3d& T_base_flange, Joints& joints, int max_steps) const;

    Singularity singularity(const Joints& joints) const;
    bool in_range(const Joints& joints) const;

  private:
    struct Target;
    ArmSolutions solve_closed(const Eigen::Isometry3d& T_base_flange, const Joints& seed, Ranges ranges) const;
    ArmSolutions solve_general(const Eigen::Isometry3d& T_base_flange, const Joints& seed, Ranges ranges) const;
    void add_parallel_wrist(const Target& target, int branch, ArmSolutions& found) const;
    void add_parallel_elbows(const Target& target, const Eigen::Vector2d& wrist, double total_turn, Joints joints,
                             int branch, ArmSolutions& found) const;
    /// Newton's correction of the closed form's solutions.
    ArmSolutions corrected(ArmSolutions found, const Eigen::Isometry3d& T_base_flange, Ranges ranges) const;
    bool is_closed_form_exact() const;
    Eigen::Matrix<double, 6, 1> error_to(const Eigen::Isometry3d& T_base_flange, const Joints& joints) const;
    void add_elbow_solutions(const Target& target, double theta1, int shoulder, ArmSolutions& found) const;
    void add_wrist_solutions(const Target& target, const Joints& arm, const Eigen::Matrix3d& R_3_5, int branch,
                             ArmSolutions& found) const;
    /// Shifts joint k by whole turns to within half a turn of the middle of its range.
    /// @return  false if it must respect its range and is out of it
    bool wrap(Joints& joints, Eigen::Index k, Ranges ranges) const;

    std::array<DhRow, 6> dh_;
    ArmKind kind_;
    Coupling coupling_;
    bool is_exact_;                   ///< the closed form's assumptions hold exactly
    double sin_alpha_[5];             ///< of rows 1 to 5; 1 or -1 but for the second
    double forearm_length_;           ///< L: from joint 3 to the wrist centre, mm
    double forearm_angle_;            ///< from x3 to the line of L, rad
    Eigen::Matrix3d R_alpha6_;        ///< R_x(-alpha6)
    Eigen::Vector3d wrist_to_flange_; ///< from the wrist centre to the flange, flange frame, mm
};

} // namespace fettle::robot
