#include "robot/arm_target.h"

#include <algorithm>
#include <cmath>

namespace fettle::robot {

// Arms with alpha1, alpha4, alpha5 = ±90°, alpha2 = alpha3 = 0 and a1 = a4 = a5 = 0. The axes 2, 3 and 4 share a
// direction n, and the origin o5 of frame 5 lies at the distance d2 + d3 + d4 along it from axis 1: that gives theta1,
// as the wrist centre does with a spherical wrist. The flange is fixed to frame 5 but for axis 6.

// z6 = z5 makes with n an angle whose cosine is -s4 s5 cos(theta5), and lies along x of frame 4 across n: this gives
// theta5 but for its sign, and the turn psi = theta2 + theta3 + theta4.
void Arm::add_parallel_wrist(const Target& target, int branch, ArmSolutions& found) const
{
    const double s1 = sin_alpha_[0], s4 = sin_alpha_[3], s5 = sin_alpha_[4];
    const auto [c1, sn1] = target.turn1;
    Joints joints;
    joints[0] = dh_[0].sign * (std::atan2(sn1, c1) - dh_[0].offset);
    const bool is_in_range = wrap(joints, 0, target.ranges);
    Eigen::Matrix3d M; // R_z(psi) R_x(alpha4) R_z(theta5) R_x(alpha5) R_z(theta6): that of 6, less theta1 and alpha1
    M.row(0) = c1 * target.R.row(0) + sn1 * target.R.row(1);
    M.row(1) = s1 * target.R.row(2);
    M.row(2) = s1 * (sn1 * target.R.row(0) - c1 * target.R.row(1));
    const double sine5 = std::sqrt(M(0, 2) * M(0, 2) + M(1, 2) * M(1, 2)), cosine5 = -s4 * s5 * M(2, 2);
    const double angle5 = std::atan2(sine5, cosine5);
    // M' R_z(psi)'s third row, n in frame 6 before its turn: (s4 sn5, ., .) turned by theta6. The other sign of theta5
    // turns it and psi by half a turn.
    const double turned6 = std::atan2(-s4 * M(2, 1), s4 * M(2, 0)), turned = std::atan2(s5 * M(1, 2), s5 * M(0, 2));
    for (int wrist = 0; wrist < 2; ++wrist) {
        const double sign = wrist == 0 ? 1 : -1;
        double c, s, theta6 = turned6 + wrist * kPi, total_turn = turned + wrist * kPi;
        if (sine5 > kMinWristSine) {
            c = sign * s5 * M(0, 2) / sine5;
            s = sign * s5 * M(1, 2) / sine5;
        } else {
            if (wrist == 1) return; // both coincide
            theta6 = dh_[5].sign * target.seed[5] + dh_[5].offset;
            // x of frame 5 before theta6, in frame 1: (c cos5, s cos5, .)
            const double x = std::cos(theta6) * M(0, 0) - std::sin(theta6) * M(0, 1),
                         y = std::cos(theta6) * M(1, 0) - std::sin(theta6) * M(1, 1);
            c = x * cosine5;
            s = y * cosine5;
            total_turn = std::atan2(s, c);
        }
        joints[4] = dh_[4].sign * (sign * angle5 - dh_[4].offset);
        joints[5] = dh_[5].sign * (theta6 - dh_[5].offset);
        // From o1 to o4 in the plane of frame 1: o5 less d5 along z4 = (s4 s, -s4 c).
        const double height = s1 * (target.wrist_centre.z() - dh_[0].d);
        const Eigen::Vector2d o4(target.across - dh_[4].d * s4 * s, height + dh_[4].d * s4 * c);
        const bool ok5 = wrap(joints, 4, target.ranges), ok6 = wrap(joints, 5, target.ranges);
        if (is_in_range && ok5 && ok6)
            add_parallel_elbows(target, o4, total_turn, joints, branch + wrist, found);
        else
            found.reachable = found.reachable || o4.norm() <= std::abs(dh_[1].a) + std::abs(dh_[2].a);
    }
}

// The links a2 and a3 in the plane.
void Arm::add_parallel_elbows(const Target& target, const Eigen::Vector2d& wrist, double total_turn, Joints joints,
                              int branch, ArmSolutions& found) const
{
    const double a2 = dh_[1].a, a3 = dh_[2].a, r2 = wrist.squaredNorm();
    const std::optional<CosSin> links = bend_of_links(a2, a3, std::sqrt(r2));
    if (!links) return;
    found.reachable = true;
    const auto [cosine, sine] = *links;
    const double bend = std::atan2(sine, cosine);
    for (int elbow = 0; elbow < 2; ++elbow) {
        if (elbow == 1 && sine == 0) return;
        const double k1 = a2 + a3 * cosine, k2 = a3 * (elbow == 0 ? sine : -sine);
        const double theta3 = elbow == 0 ? bend : -bend;
        const double theta2 = r2 > 0 ? std::atan2(wrist.y() * k1 - wrist.x() * k2, wrist.x() * k1 + wrist.y() * k2)
                                     : dh_[1].sign * target.seed[1] + dh_[1].offset;
        joints[1] = dh_[1].sign * (theta2 - dh_[1].offset);
        joints[2] = dh_[2].sign * (theta3 - dh_[2].offset);
        joints[3] = dh_[3].sign * (total_turn - theta2 - theta3 - dh_[3].offset);
        if (wrap(joints, 1, target.ranges) && wrap(joints, 2, target.ranges) && wrap(joints, 3, target.ranges))
            found.solutions[found.count++] = {joints, branch + 2 * elbow};
    }
}

} // namespace fettle::robot
