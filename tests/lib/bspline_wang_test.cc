#include "core/error.h"
#include "fit/fit.h"
#include "sampling/estimate.h"
#include "surface/surface.h"
#include "surface/tensor_bspline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fettle {
namespace bspline_wang_test {

constexpr double kTurn = 0.3;

Eigen::Matrix2d turned() { return job::rotation_working_machine(kTurn).transpose(); }

/// A grid of u x v places over 100 x 80 mm, turned.
Eigen::Matrix2Xd grid(int u, int v)
{
    Eigen::Matrix2Xd uv(2, u * v);
    for (int i = 0; i < u * v; ++i) uv.col(i) << 100.0 * (i % u) / (u - 1), 80.0 * (i / u) / (v - 1);
    return turned() * uv;
}

Eigen::Matrix2Xd scattered(int count)
{
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> along(0, 1);
    Eigen::Matrix2Xd uv(2, count);
    for (int i = 0; i < count; ++i) uv.col(i) << 100 * along(random), 80 * along(random);
    return turned() * uv;
}

template <typename Height>
Eigen::VectorXd heights_of(const Eigen::Matrix2Xd& xy, const Height& f)
{
    Eigen::VectorXd z(xy.cols());
    for (Eigen::Index i = 0; i < xy.cols(); ++i) {
        const Eigen::Vector2d uv = turned().transpose() * xy.col(i);
        z[i] = f(uv.x() / 50, uv.y() / 50);
    }
    return z;
}

double plane(double u, double v) { return 3 + u - 2 * v; }
double cubic(double u, double v) { return 1 + u - v * v * v + 0.5 * u * u * u * v * v - 0.3 * u * v; }

template <typename Height>
double largest_error(const surface::TensorBspline& surface, const Height& f)
{
    const Eigen::Matrix2Xd places = scattered(200);
    const Eigen::VectorXd truth = heights_of(places, f);
    double largest = 0;
    for (Eigen::Index i = 0; i < places.cols(); ++i)
        if (const double z = surface::height(surface, places.col(i)); !std::isnan(z))
            largest = std::max(largest, std::abs(z - truth[i]));
    return largest;
}

TEST(TensorBspline, ReproducesEveryCubicThatTheGridHolds)
{
    for (const int side : {4, 6, 9}) {
        const Eigen::Matrix2Xd xy = grid(side + 1, side);
        const surface::TensorBspline surface = surface::TensorBsplineSystem(xy, kTurn).surface(heights_of(xy, cubic));
        EXPECT_EQ(surface.heights.size(), xy.cols());
        EXPECT_LT(largest_error(surface, cubic), 1e-8) << side;
    }
}

// On lines the equations are singular; what they leave open bends as little as it can.
TEST(TensorBspline, ReproducesPlanesFromAnyPoints)
{
    Eigen::Matrix2Xd lines(2, 20);
    for (int i = 0; i < 10; ++i) {
        const bool first = i < 5;
        lines.col(2 * i) = Eigen::Vector2d(first ? 40 : 60, 20 * (i % 5));
        lines.col(2 * i + 1) = Eigen::Vector2d(25 * (i % 5), first ? 30 : 55);
    }
    for (const Eigen::Matrix2Xd& xy : {Eigen::Matrix2Xd(turned() * lines), scattered(13), scattered(300)})
        EXPECT_LT(largest_error(surface::TensorBsplineSystem(xy, kTurn).surface(heights_of(xy, plane)), plane), 1e-8);
}

TEST(TensorBspline, HasAsManyUnknownsAsPointsWhereAGridAllows)
{
    EXPECT_EQ(surface::TensorBsplineSystem(scattered(20), kTurn).surface(Eigen::VectorXd::Zero(20)).heights.size(), 20);
    const surface::TensorBspline many =
        surface::TensorBsplineSystem(scattered(472), kTurn).surface(Eigen::VectorXd::Zero(472));
    EXPECT_GT(many.heights.size(), 445);
    EXPECT_LE(many.heights.size(), 472);
    // nine points: three by three, quadratic
    const surface::TensorBspline nine =
        surface::TensorBsplineSystem(grid(3, 3), kTurn).surface(Eigen::VectorXd::Zero(9));
    EXPECT_EQ(nine.knots_u.size(), 6);
}

TEST(TensorBspline, GradientAndSlope)
{
    const Eigen::Matrix2Xd xy = scattered(60);
    const surface::TensorBspline surface = surface::TensorBsplineSystem(xy, kTurn).surface(heights_of(xy, cubic));
    const Eigen::Vector2d place = turned() * Eigen::Vector2d(47, 33);
    EXPECT_NEAR(surface::height_gradient(surface, place).dot(surface.heights.reshaped()),
                surface::height(surface, place), 1e-12);
    const double step = 1e-5;
    for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d d = step * Eigen::Vector2d::Unit(axis);
        EXPECT_NEAR(surface::slope(surface, place)[axis],
                    (surface::height(surface, place + d) - surface::height(surface, place - d)) / (2 * step), 1e-8);
    }
    EXPECT_TRUE(std::isnan(surface::height(surface, turned() * Eigen::Vector2d(-1, 40))));
}

TEST(TensorBspline, RefusesWhatDeterminesNothing)
{
    const auto with = [](const Eigen::Matrix2Xd& xy) { return surface::TensorBsplineSystem(xy, 0); };
    EXPECT_THROW(with(scattered(3)), core::InputError);
    EXPECT_THROW(with(scattered(2001)), core::InputError);
    EXPECT_THROW(with(grid(4, 2).row(0).replicate<2, 1>()), core::InputError);
    Eigen::Matrix2Xd bad = scattered(20);
    bad(0, 3) = std::nan("");
    EXPECT_THROW(with(bad), core::InputError);
}

/// Two lines in each direction over a 50 x 50 mm anomaly, four touches on each, and their four estimated points.
fit::FitInput wang_touches(double (*f)(double, double))
{
    fit::FitInput input;
    input.job.theta = kTurn;
    input.job.anomaly.resize(3, 4);
    input.job.anomaly << 0, 50, 50, 0, 0, 0, 50, 50, 0, 0, 0, 0;
    input.job.anomaly.topRows<2>() = turned() * input.job.anomaly.topRows<2>();
    Eigen::Matrix2Xd uv(2, 16);
    constexpr double kAlong[] = {-25, 0, 50, 75};
    input.curves.resize(16);
    input.roles = Eigen::VectorXi::Ones(16);
    for (int line = 0; line < 4; ++line)
        for (int k = 0; k < 4; ++k) {
            const double offset = line % 2 == 0 ? 17 : 33, along = kAlong[k];
            uv.col(4 * line + k) = line < 2 ? Eigen::Vector2d(offset, along) : Eigen::Vector2d(along, offset);
            input.curves[4 * line + k] = line;
        }
    const Eigen::Matrix2Xd xy = turned() * uv;
    input.xyz.resize(3, 16);
    input.xyz << xy, heights_of(xy, f).transpose();
    const Eigen::Matrix3Xd estimated = sampling::estimated_points(input.job, input.xyz, input.curves, input.roles);
    input.xyz.conservativeResize(3, 20);
    input.xyz.rightCols<4>() = estimated;
    input.roles.conservativeResize(20);
    input.roles.tail<4>().setConstant(3);
    input.curves.conservativeResize(20);
    input.curves.tail<4>().setConstant(-1);
    return input;
}

TEST(BsplineWang, TakesTouchesAndEstimatedPointsAsExact)
{
    const fit::Fit fit = fit::fit_surface(wang_touches(cubic), "bspline-wang");
    EXPECT_EQ(fit.surface.touches.cols(), 20);
    EXPECT_EQ(fit.surface.ignored, 0);
    EXPECT_LT(fit.residuals.cwiseAbs().maxCoeff(), 1e-6);
}

// The surface is linear in the touches, so the scatter of noisy fits agrees with the covariance, but for the sampling
// error of 2000 fits: 2000^-1/2 / sqrt(2) = 1.6 %, four times that allowed.
TEST(BsplineWang, SigmaAgreesWithNoisyRefits)
{
    const fit::FitInput exact = wang_touches(plane);
    const surface::Surface surface = fit::fit_surface(exact, "bspline-wang").surface;
    const Eigen::Vector2d places[] = {turned() * Eigen::Vector2d(25, 25), turned() * Eigen::Vector2d(5, 40)};
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, surface.touch_sigma);
    const surface::TensorBsplineSystem system(exact.xyz.topRows<2>(), kTurn);
    constexpr int kFits = 2000;
    Eigen::Vector2d squares = Eigen::Vector2d::Zero();
    for (int run = 0; run < kFits; ++run) {
        Eigen::Matrix3Xd touches = exact.xyz;
        for (Eigen::Index i = 0; i < 16; ++i) touches(2, i) += noise(random);
        touches.rightCols<4>() = sampling::estimated_points(exact.job, touches, exact.curves, exact.roles);
        const surface::TensorBspline refit = system.surface(touches.row(2));
        for (int k = 0; k < 2; ++k)
            squares[k] += std::pow(surface::height(refit, places[k]) - surface::height(surface, places[k]), 2);
    }
    for (int k = 0; k < 2; ++k)
        EXPECT_NEAR(std::sqrt(squares[k] / kFits) / surface::sigma(surface, places[k]), 1, 0.065) << k;
}

TEST(BsplineWang, SurvivesTheFile)
{
    const surface::Surface surface = fit::fit_surface(wang_touches(cubic), "bspline-wang").surface;
    const surface::Surface again =
        surface::parse_surface(json::Reader::parse(surface::to_json(surface).text(), "surface"));
    for (const Eigen::Vector2d& place : {Eigen::Vector2d(10, 20), Eigen::Vector2d(25, 31)}) {
        EXPECT_NEAR(surface::height(again, place), surface::height(surface, place), 1e-9);
        EXPECT_NEAR(surface::sigma(again, place), surface::sigma(surface, place), 1e-9);
    }
}

} // namespace bspline_wang_test
} // namespace fettle
