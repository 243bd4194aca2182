#include "fit/estimated.h"

#include "sampling/estimate.h"
#include "sampling/touch_plan.h"

namespace fettle::fit {

Eigen::MatrixXd touch_jacobian(const FitInput& input, const surface::Surface& surface)
{
    constexpr int kEstimated = static_cast<int>(sampling::Role::estimated);
    // Estimated points were rounded to single precision in their file, so they may differ by this share of their
    // distance from the origin from where they are computed anew.
    constexpr double kRelativePlaceTolerance = 1e-5;

    const Eigen::Matrix3Xd& points = surface.touches;
    const Eigen::VectorXi& roles = surface.roles;
    const Eigen::Index count = points.cols();
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(count, count);
    if (input.curves.size() == 0 || (roles.array() != kEstimated).all()) return jacobian;
    const Eigen::VectorXi curves = input.curves(usable_points(input, kSampleAndEstimatedRoles));
    Eigen::Matrix3Xd unit = points;
    unit.row(2).setZero();
    for (Eigen::Index touch = 0; touch < count; ++touch) {
        if (roles[touch] == kEstimated) continue;
        // The estimate is linear in z, so a unit height gives the weights.
        unit(2, touch) = 1;
        const Eigen::Matrix3Xd estimated = sampling::estimated_points(input.job, unit, curves, roles);
        unit(2, touch) = 0;
        for (Eigen::Index i = 0; i < count; ++i) {
            if (roles[i] != kEstimated) continue;
            const Eigen::Vector2d xy = points.col(i).head<2>();
            for (Eigen::Index k = 0; k < estimated.cols(); ++k)
                if ((estimated.col(k).head<2>() - xy).norm() <= kRelativePlaceTolerance * (1 + xy.norm())) {
                    jacobian(i, i) = 0;
                    jacobian(i, touch) = estimated(2, k);
                }
        }
    }
    return jacobian;
}

} // namespace fettle::fit
