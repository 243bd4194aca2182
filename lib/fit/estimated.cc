#include "fit/estimated.h"

#include "sampling/estimate.h"
#include "sampling/touch_plan.h"

namespace fettle {

namespace {

constexpr int kEstimated = static_cast<int>(Role::estimated);

// An estimated point went through a file in single precision: so far may it be from where it is computed anew,
// relative to its distance from the origin.
constexpr double kSamePlace = 1e-5;

} // namespace

Eigen::VectorXi used_curves(const FitInput& input)
{
    if (input.curves.size() == 0) return {};
    return input.curves(usable_points(input, kSampleAndEstimatedRoles));
}

Eigen::MatrixXd dependence(const Job& job, const Eigen::Matrix3Xd& points, const Eigen::VectorXi& roles,
                           const Eigen::VectorXi& curves)
{
    const Eigen::Index count = points.cols();
    Eigen::MatrixXd result = Eigen::MatrixXd::Identity(count, count);
    if (curves.size() == 0 || (roles.array() != kEstimated).all()) return result;
    Eigen::Matrix3Xd unit = points;
    unit.row(2).setZero();
    for (Eigen::Index touch = 0; touch < count; ++touch) {
        if (roles[touch] == kEstimated) continue;
        unit(2, touch) = 1;
        // linear in z, so a unit height gives the weights
        const Eigen::Matrix3Xd estimated = estimated_points(job, unit, curves, roles);
        unit(2, touch) = 0;
        for (Eigen::Index i = 0; i < count; ++i) {
            if (roles[i] != kEstimated) continue;
            const Eigen::Vector2d xy = points.col(i).head<2>();
            for (Eigen::Index k = 0; k < estimated.cols(); ++k)
                if ((estimated.col(k).head<2>() - xy).norm() <= kSamePlace * (1 + xy.norm())) {
                    result(i, i) = 0;
                    result(i, touch) = estimated(2, k);
                }
        }
    }
    return result;
}

} // namespace fettle
