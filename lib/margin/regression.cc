#include "margin/regression.h"

#include "core/cholesky.h"
#include "core/decompositions.h"
#include "core/error.h"
#include "job/boundary.h"
#include "margin/round_fit.h"
#include "margin/shift.h"
#include "sampling/touch_plan.h"
#include "units/units.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace fettle::margin {

namespace {

const double kMmPerInch = units::mm_per(units::Units::Length::in);

Regression regression(std::initializer_list<double> band, std::initializer_list<double> shift)
{
    const auto vector = [](std::initializer_list<double> numbers) {
        return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(numbers.begin(), std::ssize(numbers)));
    };
    return {vector(band), vector(shift)};
}

/// The circle through the touches in the section along `direction`, perpendicular to the rulings.
RoundFit fit_section(const Eigen::Matrix3Xd& touches, const Eigen::Vector2d& direction)
{
    Eigen::MatrixXd section(2, touches.cols());
    section << direction.transpose() * touches.topRows<2>(), touches.row(2);
    return fit_round(section);
}

/// The touches of a surface without estimated points; M, mm.
Eigen::Matrix3Xd real_touches(const surface::Surface& surface)
{
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < surface.touches.cols(); ++i)
        if (surface.roles[i] != static_cast<int>(sampling::Role::estimated)) used.push_back(i);
    return surface.touches(Eigen::all, used);
}

/// The touches in W, mm.
Eigen::Matrix3Xd in_working_frame(Eigen::Matrix3Xd touches, const job::Job& job)
{
    touches.topRows<2>() = (job::rotation_working_machine(job.theta) * touches.topRows<2>()).eval();
    return touches;
}

/// Half the second derivatives of the touched surface along X_w and Y_w by a quadratic fit, > 0 concave, 1/mm. The
/// twist is left out, since a cross of two lines does not determine it.
Eigen::Vector2d bending(const Eigen::Matrix3Xd& touches)
{
    const Eigen::Matrix2Xd xy = touches.topRows<2>().colwise() - touches.topRows<2>().rowwise().mean();
    Eigen::MatrixXd model(touches.cols(), 5);
    model << Eigen::VectorXd::Ones(touches.cols()), xy.transpose(), xy.transpose().cwiseAbs2();
    const Eigen::VectorXd fit = core::least_squares_by_qr(model, touches.row(2).transpose()).x;
    return fit.tail<2>();
}

surface::Prediction worst_case_of_plane(const surface::Surface& surface, const job::Job& job)
{
    const Eigen::MatrixXd touched = surface::height_gradients(surface.shape, surface.touches.topRows<2>());
    const job::Polygon corners =
        job::rotation_working_machine(job.theta).transpose() * job::working_boundaries(job).anomaly;
    // Derivatives of the least-squares plane's height at each corner by each touch; between corners they are smaller.
    const Eigen::MatrixXd influence = core::solve_ldlt(touched * touched.transpose(), touched).transpose() *
                                      surface::height_gradients(surface.shape, corners);
    double shift = 0, band = 0;
    for (Eigen::Index i = 0; i < influence.cols(); ++i) {
        shift = std::max(shift, influence.col(i).lpNorm<1>());
        for (Eigen::Index j = 0; j < i; ++j) band = std::max(band, (influence.col(i) - influence.col(j)).lpNorm<1>());
    }
    return {"wang", 0, job.probe.accuracy * std::max(shift, band), job.probe.accuracy * shift, false};
}

RegressionKind classify(const Eigen::Matrix3Xd& touches, const job::Job& job)
{
    if (job.surface == job::SurfaceType::swept) return RegressionKind::swept;
    const Eigen::Vector2d bends = bending(in_working_frame(touches, job));
    if (bends.x() * bends.y() < 0) return RegressionKind::saddle;
    return bends.sum() > 0 ? RegressionKind::concave : RegressionKind::convex;
}

} // namespace

const std::vector<std::string>& regression_terms(RegressionKind kind)
{
    static const std::vector<std::string> round = {"curvature", "area", "farthest", "variance", "constant"};
    static const std::vector<std::string> saddle = {"curvature x", "curvature y", "root area", "farthest",
                                                    "variance x",  "variance y",  "constant"};
    return kind == RegressionKind::saddle ? saddle : round;
}

const Regression& published_regression(RegressionKind kind)
{
    static const std::map<RegressionKind, Regression> published = {
        {RegressionKind::swept,
         regression({.2578, .0001, -.0004, .0354, -.0004}, {.1027, .0001, -.0005, .0253, -.0002})},
        {RegressionKind::concave,
         regression({.3264, .0031, .0013, .0228, -.0131}, {.2324, .0020, .0007, .0141, -.0096})},
        {RegressionKind::convex,
         regression({.3340, .0028, .0013, .0225, -.0127}, {.2386, .0024, .0007, .0139, -.0098})},
        {RegressionKind::saddle, regression({.7953, .1635, .0515, .0087, -.0417, -.0066, -.0689},
                                            {.2410, .1289, .0109, .0040, -.0136, -.0047, -.0266})},
    };
    return published.at(kind);
}

Eigen::VectorXd regression_values(RegressionKind kind, const Eigen::Matrix3Xd& touches, const job::Job& job)
{
    const Eigen::Matrix3Xd inches = in_working_frame(touches, job) / kMmPerInch;
    const job::Polygon anomaly = job::working_boundaries(job).anomaly / kMmPerInch;
    double farthest = 0;
    for (Eigen::Index i = 0; i < inches.cols(); ++i)
        farthest = std::max(farthest, job::distance_to_edge(anomaly, inches.col(i).head<2>()));

    Eigen::VectorXd values(std::ssize(regression_terms(kind)));
    if (kind == RegressionKind::saddle) {
        const RoundFit x = fit_section(inches, Eigen::Vector2d::UnitX());
        const RoundFit y = fit_section(inches, Eigen::Vector2d::UnitY());
        values << x.curvature, y.curvature, std::sqrt(job::area(anomaly)), farthest, x.variance, y.variance, 1;
        return values;
    }
    const Eigen::Vector2d across(-std::sin(job.ruling_direction), std::cos(job.ruling_direction));
    const RoundFit round = kind == RegressionKind::swept ? fit_section(inches, across) : fit_round(inches);
    values << round.curvature, job::area(anomaly), farthest, round.variance, 1;
    return values;
}

surface::Prediction predict_by_regression(const surface::Surface& surface, const job::Job& job,
                                          const std::string& source, PlaneShift plane_shift)
{
    const double accuracy = job.probe.accuracy;
    if (job.surface == job::SurfaceType::plane)
        return plane_shift == PlaneShift::accuracy ? surface::Prediction{"wang", 0, accuracy, accuracy, false}
                                                   : worst_case_of_plane(surface, job);
    const Eigen::Matrix3Xd touches = real_touches(surface);
    if (touches.cols() < kMinRoundPoints)
        throw core::InputError(source, "Wang's regressions need " + std::to_string(kMinRoundPoints) +
                                           " touches or more, the surface holds " + std::to_string(touches.cols()));
    const RegressionKind kind = classify(touches, job);
    const Eigen::VectorXd values = regression_values(kind, touches, job);
    const double band = kMmPerInch * published_regression(kind).band.dot(values);
    const double shift = kMmPerInch * published_regression(kind).shift.dot(values);
    return {"wang", 0, std::max(band, accuracy), std::max(shift, accuracy), std::min(band, shift) < accuracy};
}

} // namespace fettle::margin
