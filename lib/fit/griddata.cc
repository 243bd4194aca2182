#include "fit/griddata.h"

#include "core/error.h"
#include "job/boundary.h"
#include "sampling/estimate.h"
#include "sampling/touch_plan.h"
#include "surface/griddata.h"

#include <cmath>
#include <vector>

namespace fettle {

namespace {

const std::vector<int> kRoles = {1, 2, 3, 4, 5};
constexpr int kEstimated = static_cast<int>(Role::estimated);

// An estimated point went through a file in single precision: so far may it be from where it is computed anew,
// relative to its distance from the origin.
constexpr double kSamePlace = 1e-5;

/// Half the mean distance of neighbours, if the points were spread evenly over their hull, mm.
double natural_spacing(const Eigen::Matrix2Xd& points)
{
    return std::sqrt(area(convex_hull(points)) / static_cast<double>(points.cols())) / 2;
}

/// How the z of each point follows the independent touches: unit columns for touches, the weights of the two cubics
/// for estimated points. @return points x touches
Eigen::MatrixXd dependence(const Job& job, const Eigen::Matrix3Xd& points, const Eigen::VectorXi& roles,
                           const Eigen::VectorXi& curves)
{
    const Eigen::Index count = points.cols();
    Eigen::MatrixXd result = Eigen::MatrixXd::Identity(count, count);
    if (curves.size() == 0) return result;
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

} // namespace

Fit fit_griddata(const FitInput& input)
{
    constexpr int kLeastPoints = 3;
    Surface surface = begin_surface(input, "griddata", kRoles, kLeastPoints);
    Eigen::VectorXi curves;
    if (input.curves.size() > 0) curves = input.curves(usable_points(input, kRoles));
    const double spacing = input.spacing.value_or(natural_spacing(surface.touches.topRows<2>()));
    try {
        surface.shape = make_griddata(surface.touches, spacing, input.job.theta);
        const Eigen::MatrixXd follow = dependence(input.job, surface.touches, surface.roles, curves);
        surface.covariance = surface.touch_sigma * surface.touch_sigma * follow * follow.transpose();
    } catch (const InputError& error) {
        throw InputError(input.source, error.what());
    }
    return finish_fit(std::move(surface), 0, true, 0);
}

} // namespace fettle
