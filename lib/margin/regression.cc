#include "core/error.h"
#include "job/boundary.h"
#include "margin/round_fit.h"
#include "margin/shift.h"
#include "sampling/touch_plan.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle {

namespace {

constexpr double kMmPerInch = 25.4;

/// Wang 2007, 4.5: band and shift, inches, are linear in these.
struct Coefficients {
    double curvature, area, farthest, variance, constant;
};
struct Regression {
    Coefficients band, shift;
};
constexpr Regression kSwept = {{.2578, .0001, -.0004, .0354, -.0004}, {.1027, .0001, -.0005, .0253, -.0002}};
constexpr Regression kConcave = {{.3264, .0031, .0013, .0228, -.0131}, {.2324, .0020, .0007, .0141, -.0096}};
constexpr Regression kConvex = {{.3340, .0028, .0013, .0225, -.0127}, {.2386, .0024, .0007, .0139, -.0098}};

/// Saddles: cylinders along Y_w (curved in x) and along X_w; the area enters by its root.
struct SaddleCoefficients {
    double curvature_x, curvature_y, root_area, farthest, variance_x, variance_y, constant;
};
constexpr SaddleCoefficients kSaddleBand = {.7953, .1635, .0515, .0087, -.0417, -.0066, -.0689};
constexpr SaddleCoefficients kSaddleShift = {.2410, .1289, .0109, .0040, -.0136, -.0047, -.0266};

/// What the regressions take, inches.
struct Situation {
    Eigen::Matrix3Xd touches; ///< W, without estimated points
    double area = 0;
    double farthest = 0;
};

Situation situation(const Surface& surface, const Job& job)
{
    const Polygon anomaly = boundaries(job).anomaly;
    Situation result;
    result.area = area(anomaly) / (kMmPerInch * kMmPerInch);
    std::vector<Eigen::Index> touched;
    for (Eigen::Index i = 0; i < surface.touches.cols(); ++i)
        if (surface.roles[i] != static_cast<int>(Role::estimated)) touched.push_back(i);
    result.touches = surface.touches(Eigen::all, touched);
    result.touches.topRows<2>() = (rotation_working_machine(job.theta) * result.touches.topRows<2>()).eval();
    for (Eigen::Index i = 0; i < result.touches.cols(); ++i) {
        const Eigen::Vector2d xy = result.touches.col(i).head<2>();
        result.farthest = std::max(result.farthest, distance_to_edge(anomaly, xy) / kMmPerInch);
    }
    result.touches /= kMmPerInch;
    return result;
}

double evaluate(const Coefficients& c, const Situation& s, const RoundFit& round)
{
    return c.curvature * round.curvature + c.area * s.area + c.farthest * s.farthest + c.variance * round.variance +
           c.constant;
}

double evaluate(const SaddleCoefficients& c, const Situation& s, const RoundFit& x, const RoundFit& y)
{
    return c.curvature_x * x.curvature + c.curvature_y * y.curvature + c.root_area * std::sqrt(s.area) +
           c.farthest * s.farthest + c.variance_x * x.variance + c.variance_y * y.variance + c.constant;
}

/// Bending of the touches along X_w and Y_w, by a quadratic through them: > 0 concave. The twist is left out, which a
/// cross of two lines does not determine.
Eigen::Vector2d bending(const Eigen::Matrix3Xd& touches)
{
    const Eigen::Matrix2Xd xy = touches.topRows<2>().colwise() - touches.topRows<2>().rowwise().mean();
    Eigen::MatrixXd model(touches.cols(), 5);
    model << Eigen::VectorXd::Ones(touches.cols()), xy.transpose(), xy.transpose().cwiseAbs2();
    const Eigen::VectorXd fit = model.colPivHouseholderQr().solve(touches.row(2).transpose());
    return fit.tail<2>();
}

Prediction worst_case_of_plane(const Surface& surface, const Job& job)
{
    const Eigen::MatrixXd touched = height_gradients(surface.shape, surface.touches.topRows<2>());
    const Polygon corners = rotation_working_machine(job.theta).transpose() * boundaries(job).anomaly;
    // How much each touch moves the plane over each corner (least squares); in between it is less.
    const Eigen::MatrixXd influence =
        (touched * touched.transpose()).ldlt().solve(touched).transpose() * height_gradients(surface.shape, corners);
    double shift = 0, band = 0;
    for (Eigen::Index i = 0; i < influence.cols(); ++i) {
        shift = std::max(shift, influence.col(i).lpNorm<1>());
        for (Eigen::Index j = 0; j < i; ++j) band = std::max(band, (influence.col(i) - influence.col(j)).lpNorm<1>());
    }
    return {"wang", 0, job.probe.accuracy * std::max(shift, band), job.probe.accuracy * shift, false};
}

} // namespace

Prediction predict_by_regression(const Surface& surface, const Job& job, const std::string& source)
{
    if (job.surface == SurfaceType::plane) return worst_case_of_plane(surface, job);
    const Situation s = situation(surface, job);
    if (s.touches.cols() < kLeastRoundPoints)
        throw InputError(source, "Wang's regressions need " + std::to_string(kLeastRoundPoints) +
                                     " touches or more, the surface holds " + std::to_string(s.touches.cols()));
    const auto across = [&](const Eigen::Vector2d& direction) {
        Eigen::MatrixXd section(2, s.touches.cols());
        section << direction.transpose() * s.touches.topRows<2>(), s.touches.row(2);
        return fit_round(section);
    };
    double band, shift;
    const Eigen::Vector2d bends = bending(s.touches);
    if (job.surface == SurfaceType::swept) {
        const RoundFit round = across({-std::sin(job.direction), std::cos(job.direction)});
        band = evaluate(kSwept.band, s, round);
        shift = evaluate(kSwept.shift, s, round);
    } else if (bends.x() * bends.y() < 0) {
        const RoundFit x = across(Eigen::Vector2d::UnitX()), y = across(Eigen::Vector2d::UnitY());
        band = evaluate(kSaddleBand, s, x, y);
        shift = evaluate(kSaddleShift, s, x, y);
    } else {
        const Regression& regression = bends.sum() > 0 ? kConcave : kConvex;
        const RoundFit round = fit_round(s.touches);
        band = evaluate(regression.band, s, round);
        shift = evaluate(regression.shift, s, round);
    }
    const double least = job.probe.accuracy;
    return {"wang", 0, std::max(band * kMmPerInch, least), std::max(shift * kMmPerInch, least),
            std::min(band, shift) * kMmPerInch < least};
}

} // namespace fettle
