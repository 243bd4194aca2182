#include "robot/arm_target.h"

#include <algorithm>
#include <cmath>

namespace fettle::robot {

double Singularity::min() const { return std::min({shoulder, elbow, wrist}); }

Arm::Arm(const Robot& robot)
    : dh_(robot.dh), kind_(robot.arm_kind), coupling_(robot.coupling), is_exact_(is_closed_form_exact())
{
    // Twists that nearly are right angles are, in closed form.
    for (std::size_t i = 0; i < 5; ++i) sin_alpha_[i] = std::round(std::sin(dh_[i].alpha));
    const bool is_spherical = kind_ == ArmKind::spherical_wrist;
    const Eigen::Vector2d forearm(dh_[2].a, is_spherical ? -sin_alpha_[2] * dh_[3].d : 0);
    forearm_length_ = forearm.norm();
    forearm_angle_ = std::atan2(forearm.y(), forearm.x());
    R_alpha6_ = Eigen::AngleAxisd(-dh_[5].alpha, Eigen::Vector3d::UnitX()).toRotationMatrix();
    wrist_to_flange_ = R_alpha6_ * Eigen::Vector3d(dh_[5].a, 0, dh_[5].d);
}

std::array<Eigen::Isometry3d, 7> Arm::frames(const Joints& joints) const
{
    std::array<Eigen::Isometry3d, 7> T;
    T[0].setIdentity();
    for (std::size_t i = 0; i < 6; ++i) {
        double theta = dh_[i].sign * joints[i] + dh_[i].offset;
        if (i == 2 && coupling_ == Coupling::parallelogram) theta -= joints[1];
        T[i + 1] = T[i] * dh_transform(theta, dh_[i].d, dh_[i].a, dh_[i].alpha);
    }
    return T;
}

Singularity Arm::singularity(const Joints& joints) const
{
    if (kind_ == ArmKind::general) {
        // No closed form tells the kinds apart: the smallest singular value, lengths over the reach of the arm.
        Eigen::Matrix<double, 6, 6> J = jacobian(joints);
        double reach = 1;
        for (const DhRow& row : dh_) reach += std::abs(row.a) + std::abs(row.d);
        J.topRows<3>() /= reach;
        const double min = J.jacobiSvd().singularValues()[5];
        return {min, min, min};
    }
    const double theta2 = dh_[1].sign * joints[1] + dh_[1].offset;
    const double theta3 =
        dh_[2].sign * joints[2] + dh_[2].offset - (coupling_ == Coupling::parallelogram ? joints[1] : 0);
    const double bend = theta3 + forearm_angle_;
    const double across = dh_[0].a + dh_[1].a * std::cos(theta2) + forearm_length_ * std::cos(theta2 + bend);
    if (kind_ == ArmKind::parallel_axes) {
        const auto T = frames(joints);
        const double offset = dh_[1].d + dh_[2].d + dh_[3].d;
        const double from_axis = std::sqrt(std::max(T[5].translation().head<2>().squaredNorm() - offset * offset, 0.0));
        return {from_axis / (std::abs(dh_[1].a) + forearm_length_), std::abs(std::sin(theta3)),
                std::abs(std::sin(dh_[4].sign * joints[4] + dh_[4].offset))};
    }
    return {std::abs(across) / (std::abs(dh_[1].a) + forearm_length_), std::abs(std::sin(bend)),
            std::abs(std::sin(dh_[4].sign * joints[4] + dh_[4].offset))};
}

bool Arm::in_range(const Joints& joints) const
{
    for (std::size_t i = 0; i < 6; ++i)
        if (!dh_[i].range.contains(joints[i])) return false;
    return true;
}

ArmSolutions Arm::solve(const Eigen::Isometry3d& T_base_flange, const Joints& seed, Ranges ranges) const
{
    const bool is_general = kind_ == ArmKind::general, needs_correction = !is_general && !is_exact_;
    const Ranges asked = needs_correction ? Ranges::ignore : ranges; // a correction may bring a joint into its range
    ArmSolutions found =
        is_general ? solve_general(T_base_flange, seed, asked) : solve_closed(T_base_flange, seed, asked);
    if (needs_correction) found = corrected(found, T_base_flange, ranges);
    return found;
}

ArmSolutions Arm::solve_closed(const Eigen::Isometry3d& T_base_flange, const Joints& seed, Ranges ranges) const
{
    ArmSolutions found;
    const bool is_spherical = kind_ == ArmKind::spherical_wrist;
    const Eigen::Matrix3d R = T_base_flange.linear() * R_alpha6_;
    const Eigen::Vector3d wrist = T_base_flange.translation() - T_base_flange.linear() * wrist_to_flange_;
    // The wrist centre, or the origin of frame 5 of an arm with parallel axes, is R_z(theta1) (across, offset, .),
    // where only the offsets of axes 2 and 3, or 2 to 4, enter `offset`.
    const double offset = -sin_alpha_[0] * (dh_[1].d + dh_[2].d + (is_spherical ? 0 : dh_[3].d));
    const double squared = wrist.head<2>().squaredNorm(), across2 = squared - offset * offset;
    const bool on_axis = squared < kAxisDistanceTolerance * kAxisDistanceTolerance;
    if (!on_axis && across2 < 0) return found;
    const double across = on_axis ? 0 : std::sqrt(across2);
    for (int shoulder = 0; shoulder < 2; ++shoulder) {
        const double u = shoulder == 0 ? across : -across;
        CosSin turn1 = {(wrist.x() * u + wrist.y() * offset) / squared, (wrist.y() * u - wrist.x() * offset) / squared};
        double theta1 = std::atan2(turn1.sine, turn1.cosine);
        if (on_axis) {
            theta1 = dh_[0].sign * seed[0] + dh_[0].offset + shoulder * kPi;
            turn1 = {std::cos(theta1), std::sin(theta1)};
        }
        const Target target = {R, wrist, seed, ranges, u, turn1};
        if (is_spherical)
            add_elbow_solutions(target, theta1, shoulder, found);
        else
            add_parallel_wrist(target, 4 * shoulder, found);
    }
    return found;
}

std::optional<CosSin> bend_of_links(double a, double b, double distance)
{
    const double twice = 2 * a * b;
    const double from_straight = (a + b - distance) * (a + b + distance) / twice; // 1 - cosine
    const double from_folded = (distance - (a - b)) * (distance + (a - b)) / twice;
    if (from_straight < -kCosineRounding || from_folded < -kCosineRounding) return std::nullopt;
    return CosSin{(from_folded - from_straight) / 2, std::sqrt(std::max(from_straight * from_folded, 0.0))};
}

// Axes 2 and 3 and the wrist centre form a triangle with sides a2 and L in the plane of the arm.
void Arm::add_elbow_solutions(const Target& target, double theta1, int shoulder, ArmSolutions& found) const
{
    const double a2 = dh_[1].a, L = forearm_length_;
    const double x = target.across - dh_[0].a, y = sin_alpha_[0] * (target.wrist_centre.z() - dh_[0].d);
    const double r2 = x * x + y * y;
    const std::optional<CosSin> links = bend_of_links(a2, L, std::sqrt(r2));
    if (!links) return;
    found.reachable = true;
    Joints joints;
    joints[0] = dh_[0].sign * (theta1 - dh_[0].offset);
    if (!wrap(joints, 0, target.ranges)) return;
    const auto [cosine, sine] = *links;
    const double bend = std::atan2(sine, cosine);
    for (int elbow = 0; elbow < 2; ++elbow) {
        if (elbow == 1 && sine == 0) return; // straight or folded: both solutions coincide
        const double s = elbow == 0 ? sine : -sine;
        const double k1 = a2 + L * cosine, k2 = L * s;
        // With the wrist centre on axis 2 (only if |a2| = L) any theta2 is a solution.
        const double theta2 =
            r2 > 0 ? std::atan2(y * k1 - x * k2, x * k1 + y * k2) : dh_[1].sign * target.seed[1] + dh_[1].offset;
        const double theta3 = (elbow == 0 ? bend : -bend) - forearm_angle_;
        joints[1] = dh_[1].sign * (theta2 - dh_[1].offset);
        joints[2] = dh_[2].sign * (theta3 - dh_[2].offset) + (coupling_ == Coupling::parallelogram ? joints[1] : 0);
        if (!wrap(joints, 1, target.ranges) || !wrap(joints, 2, target.ranges)) continue;
        const double c = std::cos(theta2 + theta3), sn = std::sin(theta2 + theta3);
        const double s1 = sin_alpha_[0], s3 = sin_alpha_[2];
        Eigen::Matrix3d R_base_3; // R_z(theta1) R_x(alpha1) R_z(theta2 + theta3) R_x(alpha3)
        const auto [c1, sn1] = target.turn1;
        R_base_3 << c1 * c, sn1 * s1 * s3, c1 * s3 * sn, //
            sn1 * c, -c1 * s1 * s3, sn1 * s3 * sn,       //
            s1 * sn, 0, -s1 * s3 * c;
        add_wrist_solutions(target, joints, R_base_3.transpose() * target.R, 4 * shoulder + 2 * elbow, found);
    }
}

// M = R_z(theta4) R_x(alpha4) R_z(theta5) R_x(alpha5) R_z(theta6): its third column gives theta4 and theta5. theta6
// follows from M with these two taken out, so that the product is right even where theta4 is uncertain.
void Arm::add_wrist_solutions(const Target& target, const Joints& arm, const Eigen::Matrix3d& M, int branch,
                              ArmSolutions& found) const
{
    const double s4 = sin_alpha_[3], s5 = sin_alpha_[4];
    const double sine5 = std::hypot(M(0, 2), M(1, 2)), cosine5 = -s4 * s5 * M(2, 2);
    double theta4;
    CosSin turn4;
    if (sine5 > kMinWristSine) {
        turn4 = {s5 * M(0, 2) / sine5, s5 * M(1, 2) / sine5};
        theta4 = std::atan2(turn4.sine, turn4.cosine);
    } else {
        theta4 = dh_[3].sign * target.seed[3] + dh_[3].offset;
        turn4 = {std::cos(theta4), std::sin(theta4)};
    }
    const double theta5 = std::atan2(sine5, cosine5);
    const double x = turn4.cosine * M(0, 0) + turn4.sine * M(1, 0), y = s4 * M(2, 0);
    const double theta6 =
        std::atan2(s4 * s5 * (turn4.sine * M(0, 0) - turn4.cosine * M(1, 0)), cosine5 * x + sine5 * y);
    for (int wrist = 0; wrist < 2; ++wrist) {
        Joints joints = arm;
        joints[3] = dh_[3].sign * (theta4 + wrist * kPi - dh_[3].offset);
        joints[4] = dh_[4].sign * ((wrist == 0 ? theta5 : -theta5) - dh_[4].offset);
        joints[5] = dh_[5].sign * (theta6 + wrist * kPi - dh_[5].offset);
        if (wrap(joints, 3, target.ranges) && wrap(joints, 4, target.ranges) && wrap(joints, 5, target.ranges))
            found.solutions[found.count++] = {joints, branch + wrist};
    }
}

} // namespace fettle::robot
