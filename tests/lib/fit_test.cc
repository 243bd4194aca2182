#include "core/error.h"
#include "fit/bspline.h"
#include "fit/cylinder.h"
#include "fit/plane.h"
#include "fit/sphere.h"
#include "fit/swept.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace fettle {
namespace {

constexpr double kInch = 25.4;

Job job_with(double accuracy, double theta = 0)
{
    Job job;
    job.theta = theta;
    job.probe.accuracy = accuracy;
    job.anomaly.resize(3, 4); // 2 x 2 in about the origin
    job.anomaly << -kInch, kInch, kInch, -kInch, -kInch, -kInch, kInch, kInch, 0, 0, 0, 0;
    return job;
}

/// Wang's layout for a 2 x 2 in anomaly in a 5 x 4 in patch: two lines each way, four touches on each (2007, 4.4.4).
Eigen::Matrix2Xd wang_layout()
{
    Eigen::Matrix2Xd xy(2, 16);
    int i = 0;
    for (const double line : {-1.0 / 3, 1.0 / 3})
        for (const double along : {-1.0, -0.5, 0.5, 1.0}) {
            xy.col(i++) << line * kInch, along * 2 * kInch;
            xy.col(i++) << (std::abs(along) < 1 ? along * 2 : along * 2.5) * kInch, line * kInch;
        }
    return xy;
}

template <typename Height>
FitInput touched(const Eigen::Matrix2Xd& xy, const Height& height, const Job& job)
{
    FitInput input;
    input.job = job;
    input.xyz.resize(3, xy.cols());
    for (Eigen::Index i = 0; i < xy.cols(); ++i) input.xyz.col(i) << xy.col(i), height(xy(0, i), xy(1, i));
    input.roles = Eigen::VectorXi::Ones(xy.cols());
    return input;
}

template <typename Height>
double largest_error(const Surface& surface, const Height& truth, double half)
{
    double largest = 0;
    for (double x = -half; x <= half; x += half / 5)
        for (double y = -half; y <= half; y += half / 5)
            largest = std::max(largest, std::abs(height(surface, {x, y}) - truth(x, y)));
    return largest;
}

double quadratic(double x, double y) { return 3 + 0.2 * x - 0.1 * y + 0.005 * x * x + 0.002 * x * y - 0.004 * y * y; }

constexpr double kQuiet = 1e-4; // mm; probe accuracy where the touches are exact

double height_of(const Shape& shape, double x, double y)
{
    Surface surface;
    surface.shape = shape;
    return height(surface, {x, y});
}

/// Fits exact touches of a shape and compares the heights.
template <typename FitFunction>
void expect_reproduced(FitFunction fit_function, const Shape& shape, double tolerance)
{
    const auto truth = [&](double x, double y) { return height_of(shape, x, y); };
    const Fit fit = fit_function(touched(wang_layout(), truth, job_with(kQuiet)));
    EXPECT_TRUE(fit.converged);
    EXPECT_LT(largest_error(fit.surface, truth, kInch), tolerance);
    EXPECT_LT(fit.surface.rms, tolerance);
}

TEST(Plane, ReproducesPlanes)
{
    expect_reproduced(fit_plane, Plane{{0, 0}, 0, {0.3, -0.2}}, 1e-10); // through the origin
    expect_reproduced(fit_plane, Plane{{5, 1}, 7, {0, 0}}, 1e-10);
    expect_reproduced(fit_plane, Plane{{5, 1}, 7, {5, -9}}, 1e-9); // 84°
}

TEST(Sphere, ReproducesSpheres)
{
    for (const double inches : {2.7, 4.0, 25.0, 225.0})
        for (const bool convex : {true, false})
            expect_reproduced(fit_sphere, sphere_about({5, -3, 10}, inches * kInch, convex), 1e-8);
    // The touched piece on the sphere's flank.
    expect_reproduced(fit_sphere, sphere_about({60, 40, 10}, 150, true), 1e-8);
    expect_reproduced(fit_sphere, sphere_about({60, 40, 10}, 150, false), 1e-8);
}

TEST(Sphere, FlatTouchesGiveAPlane)
{
    expect_reproduced(fit_sphere, Plane{{5, 1}, 7, {0.3, -0.1}}, 1e-8);
    expect_reproduced(fit_cylinder, Plane{{5, 1}, 7, {0.3, -0.1}}, 1e-8);
}

TEST(Cylinder, ReproducesCylindersWithAnyAxis)
{
    for (const double degrees : {0.0, 20.0, 45.0, 90.0, 137.0})
        for (const double rise : {0.0, 0.3})
            for (const double inches : {3.0, 4.0, 50.0})
                for (const bool convex : {true, false}) {
                    const double angle = degrees * M_PI / 180;
                    expect_reproduced(
                        fit_cylinder,
                        cylinder_about({3, 4, 5}, {std::cos(angle), std::sin(angle), rise}, inches * kInch, convex),
                        1e-8);
                }
}

TEST(Swept, ReproducesSweptSurfaces)
{
    for (const double degrees : {0.0, 30.0, 90.0}) {
        const double angle = degrees * M_PI / 180;
        const Swept truth{{3, -4}, {std::cos(angle), std::sin(angle)}, 20, {1, 2, -3, 0.7}, 0.15, -50, 50};
        Job job = job_with(kQuiet, 0.2);
        job.direction = angle - 0.2; // the operator gives it from X_w
        const auto height = [&](double x, double y) { return height_of(truth, x, y); };
        const Fit fit = fit_swept(touched(wang_layout(), height, job));
        EXPECT_LT(largest_error(fit.surface, height, kInch), 1e-9);
    }
}

TEST(Bspline, ReproducesQuadraticsExactly)
{
    const Fit fit = fit_bspline(touched(wang_layout(), quadratic, job_with(kQuiet)));
    EXPECT_TRUE(fit.converged);
    EXPECT_LT(largest_error(fit.surface, quadratic, kInch), 1e-9);
}

/// Standard deviation of the height over the middle and a corner of B, by fitting anew to touches with fresh noise.
template <typename FitFunction, typename Height>
void expect_calibrated(FitFunction fit_function, const Height& truth, double tolerance)
{
    constexpr double kAccuracy = 0.127;
    constexpr int kRuns = 1000;
    const FitInput exact = touched(wang_layout(), truth, job_with(kAccuracy));
    const Surface predicted = fit_function(exact).surface;
    std::mt19937 random(20);
    std::normal_distribution<double> noise(0, touch_sigma(exact.job.probe));
    const Eigen::Vector2d places[] = {{0, 0}, {kInch, kInch}};
    Eigen::Vector2d squares = Eigen::Vector2d::Zero();
    double goodness = 0;
    for (int run = 0; run < kRuns; ++run) {
        FitInput noisy = exact;
        for (Eigen::Index i = 0; i < noisy.xyz.cols(); ++i) noisy.xyz(2, i) += noise(random);
        const Surface surface = fit_function(noisy).surface;
        for (int k = 0; k < 2; ++k)
            squares[k] += std::pow(height(surface, places[k]) - truth(places[k].x(), places[k].y()), 2);
        goodness += surface.goodness;
    }
    for (int k = 0; k < 2; ++k)
        EXPECT_NEAR(std::sqrt(squares[k] / kRuns) / sigma(predicted, places[k]), 1, tolerance) << k;
    EXPECT_NEAR(goodness / kRuns, 0.5, 0.05); // a p-value is uniform
}

// The standard deviation of 1000 runs is known to 1/√2000 = 2.2 %; 7 % are three of it.
TEST(Sigma, AgreesWithNoisyRefits)
{
    const auto of = [](const Shape& shape) { return [shape](double x, double y) { return height_of(shape, x, y); }; };
    expect_calibrated(fit_plane, of(Plane{{0, 0}, 3, {0.2, -0.4}}), 0.07);
    expect_calibrated(fit_swept, of(Swept{{3, -4}, {1, 0}, 20, {1, 2, -3, 0.7}, 0.15, -50, 50}), 0.07);
    expect_calibrated(fit_sphere, of(sphere_about({5, -3, 10}, 4 * kInch, true)), 0.07);
    expect_calibrated(fit_cylinder, of(cylinder_about({3, 4, 5}, {1, 0.4, 0}, 4 * kInch, false)), 0.07);
}

TEST(Bspline, Speed)
{
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.05);
    const FitInput exact = touched(wang_layout(), quadratic, job_with(0.127));
    for (int k = 0; k < 20; ++k) {
        FitInput input = exact;
        for (Eigen::Index i = 0; i < 16; ++i) input.xyz(2, i) += noise(random);
        const auto start = std::chrono::steady_clock::now();
        const Fit fit = fit_bspline(input);
        std::printf("%g ms, %d iterations, err %g sigma %g rms %g good %g N %d\n",
                    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(),
                    fit.iterations, largest_error(fit.surface, quadratic, kInch), sigma(fit.surface, {0, 0}),
                    fit.surface.rms, fit.surface.goodness, int(fit.surface.covariance.rows()));
    }
}

} // namespace
} // namespace fettle
