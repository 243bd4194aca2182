#include "robot/arm_target.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace fettle::robot {

namespace {

// Errors of a rotation count as at this lever, mm: the size of an arm's tool and forearm.
constexpr double kLever = 1000;
// Steps of the correction of a closed form: it converges quadratically from errors of some micrometres.
constexpr int kCorrectionSteps = 6;
// Steps of a search from a start anywhere: those that converge do so within some twenty.
constexpr int kSearchSteps = 60;
// Starts of a search, beside the given one.
constexpr int kStarts = 96;
// Two solutions whose joints differ by less are one, rad.
constexpr double kSolutionTolerance = 1e-6;
// Departures from the closed form's assumptions that move no flange by 1e-9 mm: rad, mm.
constexpr double kExactAngle = 1e-13, kExactLength = 1e-10;
constexpr double kInitialDamping = 1e-3, kMaxDamping = 1e8; // relative to the normal equations' diagonal

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

// The joint angles nearest to 0 of the start number k, spread evenly (Halton's sequence: bases 2, 3, 5, 7, 11, 13).
double halton(int k, int base)
{
    double value = 0, fraction = 1;
    for (; k > 0; k /= base) {
        fraction /= base;
        value += fraction * (k % base);
    }
    return value;
}

} // namespace

bool Arm::is_closed_form_exact() const
{
    const auto is_right = [](double alpha) { return std::abs(std::abs(alpha) - kPi / 2) < kExactAngle; };
    const auto is_zero = [](double length) { return std::abs(length) < kExactLength; };
    const auto is_flat = [](double alpha) { return std::abs(alpha) < kExactAngle; };
    if (kind_ == ArmKind::spherical_wrist)
        return is_right(dh_[0].alpha) && is_flat(dh_[1].alpha) && is_right(dh_[2].alpha) && is_right(dh_[3].alpha) &&
               is_right(dh_[4].alpha) && is_zero(dh_[3].a) && is_zero(dh_[4].a) && is_zero(dh_[4].d);
    return is_right(dh_[0].alpha) && is_flat(dh_[1].alpha) && is_flat(dh_[2].alpha) && is_right(dh_[3].alpha) &&
           is_right(dh_[4].alpha) && is_zero(dh_[0].a) && is_zero(dh_[3].a) && is_zero(dh_[4].a);
}

Matrix6d Arm::jacobian(const Joints& joints) const
{
    const auto T = frames(joints);
    Matrix6d J;
    for (Eigen::Index i = 0; i < 6; ++i) {
        const Eigen::Vector3d z = dh_[i].sign * T[i].linear().col(2);
        J.col(i) << z.cross(T[6].translation() - T[i].translation()), z;
    }
    if (coupling_ == Coupling::parallelogram) J.col(1) -= J.col(2);
    return J;
}

// The twist from the joints' pose to the wanted one: mm, and rad times the lever.
Vector6d Arm::error_to(const Eigen::Isometry3d& T_base_flange, const Joints& joints) const
{
    const Eigen::Isometry3d T = flange(joints);
    const Eigen::AngleAxisd turn(T_base_flange.linear() * T.linear().transpose());
    Vector6d error;
    error << T_base_flange.translation() - T.translation(), kLever * turn.angle() * turn.axis();
    return error;
}

bool Arm::refine(const Eigen::Isometry3d& T_base_flange, Joints& joints, int max_steps) const
{
    Vector6d error = error_to(T_base_flange, joints);
    double damping = 0;
    for (int step = 0; step < max_steps; ++step) {
        if (error.norm() <= kNewtonTolerance) return true;
        Matrix6d J = jacobian(joints);
        J.bottomRows<3>() *= kLever;
        Matrix6d normal = J.transpose() * J;
        normal.diagonal() += damping * normal.diagonal();
        // Full pivoting: at a singularity the equations leave a joint undetermined.
        const Vector6d change =
            damping == 0 ? Vector6d(J.fullPivLu().solve(error)) : Vector6d(normal.ldlt().solve(J.transpose() * error));
        const Joints next = joints + change;
        const Vector6d next_error = next.allFinite() ? error_to(T_base_flange, next) : error;
        if (next.allFinite() && next_error.norm() < error.norm()) {
            joints = next;
            error = next_error;
            damping = damping < kInitialDamping ? 0 : damping / 10;
        } else if (error.norm() <= 10 * kNewtonTolerance) {
            return true; // rounding
        } else {
            damping = std::max(10 * damping, kInitialDamping);
            if (damping > kMaxDamping) return false;
        }
    }
    return error.norm() <= 10 * kNewtonTolerance;
}

ArmSolutions Arm::corrected(ArmSolutions found, const Eigen::Isometry3d& T_base_flange, Ranges ranges) const
{
    std::size_t kept = 0;
    for (ArmSolution solution : found) {
        if (!refine(T_base_flange, solution.joints, kCorrectionSteps)) continue;
        bool is_in_range = true;
        for (Eigen::Index k = 0; k < 6; ++k) is_in_range = wrap(solution.joints, k, ranges) && is_in_range;
        if (is_in_range) found.solutions[kept++] = solution;
    }
    found.count = kept;
    return found;
}

ArmSolutions Arm::solve_general(const Eigen::Isometry3d& T_base_flange, const Joints& seed, Ranges ranges) const
{
    constexpr int kBases[] = {2, 3, 5, 7, 11, 13};
    ArmSolutions found;
    for (int start = 0; start <= kStarts && found.count < kMaxSolutions; ++start) {
        Joints joints = seed;
        if (start > 0)
            for (Eigen::Index k = 0; k < 6; ++k) joints[k] = kPi * (2 * halton(start, kBases[k]) - 1);
        if (!refine(T_base_flange, joints, kSearchSteps)) continue;
        found.reachable = true;
        bool is_in_range = true;
        for (Eigen::Index k = 0; k < 6; ++k) is_in_range = wrap(joints, k, ranges) && is_in_range;
        const bool is_known = std::ranges::any_of(found, [&](const ArmSolution& other) {
            return (other.joints - joints).cwiseAbs().maxCoeff() < kSolutionTolerance;
        });
        if (is_in_range && !is_known) {
            found.solutions[found.count] = {joints, static_cast<int>(found.count)};
            ++found.count;
        }
    }
    return found;
}

} // namespace fettle::robot
