#include "core/error.h"
#include "draws.h"
#include "fit/bspline.h"
#include "fit/family.h"
#include "fit/plane.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/round_fit.h"
#include "margin/shift.h"

#include <boost/math/distributions/binomial.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace fettle {
namespace margin_test {

fit::Fit fit_sphere(const fit::FitInput& input) { return fit::fit_family_by_name(input, "sphere"); }

constexpr double kInch = 25.4;
using HeightOver = std::function<double(const Eigen::Vector2d&)>;

/// 2 x 2 in anomaly about the origin, in a 5 x 4 in sampling boundary.
job::Job square_job(job::SurfaceType type)
{
    job::Job job;
    job.surface = type;
    job.units.length = units::Units::Length::in;
    job.anomaly.resize(3, 4);
    job.anomaly << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0;
    job.anomaly *= kInch;
    job.sampling.resize(3, 4);
    job.sampling << -2.5, 2.5, 2.5, -2.5, -2, -2, 2, 2, 0, 0, 0, 0;
    job.sampling *= kInch;
    return job;
}

/// Wang's 16 touches of that job, on a surface.
fit::FitInput touches_on(const HeightOver& z, const job::Job& job)
{
    fit::FitInput input;
    input.job = job;
    input.xyz.resize(3, 16);
    input.roles.setOnes(16);
    int i = 0;
    for (const double line : {-kInch / 3, kInch / 3})
        for (const double along : {-2.0, -1.0, 1.0, 2.0}) {
            const double along_x = std::abs(along) > 1 ? 1.25 * along : along;
            input.xyz.col(i++).head<2>() << line, along * kInch;
            input.xyz.col(i++).head<2>() << along_x * kInch, line;
        }
    for (Eigen::Index k = 0; k < 16; ++k) input.xyz(2, k) = z(input.xyz.col(k).head<2>());
    return input;
}

TEST(ErrorBand, follows_both_cases_of_eq_4_1_and_4_6)
{
    EXPECT_DOUBLE_EQ(margin::error_band(Eigen::Vector3d(-1, 0.5, 2)), 3);
    EXPECT_DOUBLE_EQ(margin::error_band(Eigen::Vector3d(1, 0.5, 2)), 2);
    EXPECT_DOUBLE_EQ(margin::error_band(Eigen::Vector3d(-1, -0.5, -2)), 2);
    EXPECT_DOUBLE_EQ(margin::shift_distance(Eigen::Vector3d(-1, 0.5, 2)), 1);
    EXPECT_DOUBLE_EQ(margin::shift_distance(Eigen::Vector3d(1, 0.5, 2)), -0.5);
    EXPECT_DOUBLE_EQ(margin::shift_distance(Eigen::Vector3d(0, 0.5, 2)), 0);
}

TEST(RoundFit, finds_circles_spheres_and_lines)
{
    Eigen::MatrixXd circle(2, 9), sphere(3, 9), line(2, 9);
    for (int i = 0; i < 9; ++i) {
        const double t = 0.05 * i;
        circle.col(i) << 3 + 40 * std::cos(t), -5 + 40 * std::sin(t);
        sphere.col(i) << 7 * std::cos(t) * std::cos(t * i), 2 + 7 * std::sin(t) * std::cos(t * i), 7 * std::sin(t * i);
        line.col(i) << t, 2 * t + 1;
    }
    EXPECT_NEAR(margin::fit_round(circle).curvature, 1 / 40.0, 1e-9);
    EXPECT_NEAR(margin::fit_round(circle).variance, 0, 1e-9);
    EXPECT_NEAR(margin::fit_round(sphere).curvature, 1 / 7.0, 1e-9);
    EXPECT_NEAR(margin::fit_round(line).curvature, 0, 1e-6);
    circle.col(4) *= 1.001; // 0.03 to 0.04 further out than the arc it is on
    EXPECT_NEAR(margin::fit_round(circle).variance, 0.036, 0.01);
}

TEST(AnomalyGrid, covers_the_anomaly_and_its_corners)
{
    job::Job job = square_job(job::SurfaceType::freeform);
    const Eigen::Matrix2Xd grid = margin::anomaly_grid(job, 10);
    EXPECT_EQ(grid.cols(), 4 + 4 * 9 + 100);
    for (int k = 0; k < 4; ++k) EXPECT_LT((grid.col(k).cwiseAbs() - Eigen::Vector2d(kInch, kInch)).norm(), 1e-9);
    EXPECT_LE(grid.cwiseAbs().maxCoeff(), kInch * (1 + 1e-12));
}

// An outline of very many corners makes no finer grid: as of a square whose sides are cut a thousand times.
TEST(AnomalyGrid, thins_a_fine_outline)
{
    job::Job job = square_job(job::SurfaceType::freeform);
    const Eigen::Matrix2Xd coarse = margin::anomaly_grid(job, 10);
    const Eigen::Matrix3Xd square = job.anomaly;
    job.anomaly.resize(3, 4000);
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 1000; ++i)
            job.anomaly.col(1000 * k + i) = square.col(k) + i / 1000.0 * (square.col((k + 1) % 4) - square.col(k));
    const Eigen::Matrix2Xd grid = margin::anomaly_grid(job, 10);
    EXPECT_LT(grid.cols(), 4 * coarse.cols());
    double farthest = 0; // of a place on the coarse grid from one on the fine grid
    for (const Eigen::Vector2d& place : coarse.colwise())
        farthest = std::max(farthest, (grid.colwise() - place).colwise().norm().minCoeff());
    EXPECT_LT(farthest, 2 * kInch / 10 / 8);
}

// Sphere of 25 in, exact touches: the variance is 0, so the regression can be done by hand. The outer touches are 1.5
// in off the anomaly.
TEST(Regression, is_wangs_for_spheres)
{
    const job::Job job = square_job(job::SurfaceType::freeform);
    const double radius = 25 * kInch;
    for (const double side : {1.0, -1.0}) {
        surface::Surface surface;
        surface.touches =
            touches_on([&](const auto& p) { return side * std::sqrt(radius * radius - p.squaredNorm()); }, job).xyz;
        surface.roles.setOnes(16);
        const surface::Prediction convex = margin::predict_by_regression(surface, job);
        const double band =
            side > 0 ? .3340 / 25 + .0028 * 4 + .0013 * 1.5 - .0127 : .3264 / 25 + .0031 * 4 + .0013 * 1.5 - .0131;
        const double shift =
            side > 0 ? .2386 / 25 + .0024 * 4 + .0007 * 1.5 - .0098 : .2324 / 25 + .0020 * 4 + .0007 * 1.5 - .0096;
        EXPECT_NEAR(convex.band / kInch, band, 1e-6);
        EXPECT_NEAR(convex.shift / kInch, shift, 1e-6);
        EXPECT_FALSE(convex.clamped);
    }
}

TEST(Regression, is_clamped_at_the_probes_accuracy)
{
    job::Job job = square_job(job::SurfaceType::swept); // rulings along X
    surface::Surface surface;
    surface.touches = touches_on([](const auto& p) { return 1e-5 * p.y() * p.y(); }, job).xyz;
    surface.roles.setOnes(16);
    const surface::Prediction prediction = margin::predict_by_regression(surface, job);
    EXPECT_TRUE(prediction.clamped);
    EXPECT_DOUBLE_EQ(prediction.shift, job.probe.accuracy);
    EXPECT_DOUBLE_EQ(prediction.band, job.probe.accuracy);
}

TEST(Regression, takes_saddles_by_two_cylinders)
{
    job::Job job = square_job(job::SurfaceType::freeform);
    const auto saddle = [](const Eigen::Vector2d& p) { return (p.x() * p.x() - p.y() * p.y()) / (2 * 10 * kInch); };
    surface::Surface surface;
    surface.touches = touches_on(saddle, job).xyz;
    surface.roles.setOnes(16);
    const double band = margin::predict_by_regression(surface, job).band / kInch;
    // Both curvatures about 1/10, √A = 2, D = 1.5; the variances, at most the sag 0.3, take off at most 0.015.
    const double without_variance = (.7953 + .1635) / 10 + .0515 * 2 + .0087 * 1.5 - .0689;
    EXPECT_LT(band, without_variance + 0.03);
    EXPECT_GT(band, without_variance - 0.06);
}

// Touches at the corners of the anomaly: at a corner their weights are 3/4, 1/4, 1/4, -1/4 (z at (x, y) is the mean of
// 1 ± x ± y times the touches), so the worst case is 1.5 times the accuracy.
TEST(Regression, of_a_plane_is_the_worst_case)
{
    const job::Job job = square_job(job::SurfaceType::plane);
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 0, {0, 0}};
    surface.touches = job.anomaly;
    surface.roles.setZero(4);
    const surface::Prediction prediction = margin::predict_by_regression(surface, job);
    EXPECT_NEAR(prediction.shift, 1.5 * job.probe.accuracy, 1e-12);
    // Opposite corners differ by two touches' full errors.
    EXPECT_NEAR(prediction.band, 2 * job.probe.accuracy, 1e-12);
}

// As Wang published it (2007, 4.5): the probe's accuracy.
TEST(Regression, of_a_plane_may_be_the_accuracy)
{
    const job::Job job = square_job(job::SurfaceType::plane);
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 0, {0, 0}};
    surface.touches = job.anomaly;
    surface.roles.setZero(4);
    const surface::Prediction prediction =
        margin::predict_by_regression(surface, job, "surface", margin::PlaneShift::accuracy);
    EXPECT_EQ(prediction.shift, job.probe.accuracy);
    EXPECT_EQ(prediction.band, job.probe.accuracy);
}

// A level surface whose only unknown is its height: quantiles of the normal distribution, one- and two-sided.
TEST(Posterior, of_one_number_has_normal_quantiles)
{
    const job::Job job = square_job(job::SurfaceType::plane);
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 0, {0, 0}};
    surface.covariance = Eigen::Vector3d(0.04, 0, 0).asDiagonal();
    const surface::Prediction prediction = margin::predict_by_posterior(surface, job, 0.95, 1);
    EXPECT_NEAR(prediction.shift, 0.2 * 1.6449, 0.2 * 0.05); // 0.05: three standard errors at 8192 draws, with margin
    EXPECT_NEAR(prediction.band, 0.2 * 1.9600, 0.2 * 0.1);
    EXPECT_EQ(prediction.shift, margin::predict_by_posterior(surface, job, 0.95, 1).shift);
    EXPECT_GT(margin::predict_by_posterior(surface, job, 0.99, 1).shift, prediction.shift);
}

// The quantiles are Student's where the noise was estimated with 4 degrees of freedom, which has doubled the variance.
// 4096 independent draws of the noise, three standard errors.
TEST(Posterior, of_one_number_with_estimated_noise_has_students_quantiles)
{
    const job::Job job = square_job(job::SurfaceType::plane);
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 0, {0, 0}};
    surface.covariance = Eigen::Vector3d(2 * 0.04, 0, 0).asDiagonal();
    surface.touch_sigma_dof = 4;
    const surface::Prediction prediction = margin::predict_by_posterior(surface, job, 0.95, 1);
    EXPECT_NEAR(prediction.shift, 0.2 * 2.1318, 0.2 * 0.11);
    EXPECT_NEAR(prediction.band, 0.2 * 2.7764, 0.2 * 0.22);
}

// A process through 11 touches, of which 5 are left over its trend of 6 parameters: Student's quantiles with 5 degrees
// of freedom, scaled to the variance of the process by √(3/5). All control heights are wrong by the same.
TEST(Posterior, of_a_process_has_students_quantiles)
{
    const job::Job job = square_job(job::SurfaceType::freeform);
    surface::Surface surface;
    surface::Bspline level;
    level.origin = {-100, -100};
    level.cell = {200, 200};
    level.heights.setZero(4, 4);
    surface.shape = level;
    surface.covariance = Eigen::MatrixXd::Constant(16, 16, 0.04);
    surface.touches.setZero(3, 11);
    const surface::Prediction prediction = margin::predict_by_posterior(surface, job, 0.99, 1);
    EXPECT_NEAR(prediction.shift, 0.2 * std::sqrt(0.6) * 3.3649, 0.2 * 0.2);
    EXPECT_NEAR(margin::predict_by_posterior(surface, job, 0.99, 1, "surface", margin::Tails::normal).shift,
                0.2 * 2.3263, 0.2 * 0.07);
    surface.touches.setZero(3, 1000);
    EXPECT_NEAR(margin::predict_by_posterior(surface, job, 0.99, 1).shift, 0.2 * 2.3263, 0.2 * 0.07);
}

TEST(Posterior, refuses_surfaces_that_cannot_be_predicted)
{
    const job::Job job = square_job(job::SurfaceType::freeform);
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 0, {0, 0}};
    EXPECT_THROW(margin::predict_by_posterior(surface, job, 0.99, 1), core::InputError); // no covariance
    surface::Bspline small; // reaches over a quarter of the anomaly
    small.origin = {0, 0};
    small.cell = {30, 30};
    small.heights.setZero(4, 4);
    surface.shape = small;
    surface.covariance = Eigen::MatrixXd::Identity(16, 16);
    EXPECT_THROW(margin::predict_by_posterior(surface, job, 0.99, 1), core::InputError);
}

/// How often the surface raised by its 95 % shift lies below the truth somewhere in B, out of `trials` refits.
int over_ground(const job::Job& job, const HeightOver& truth, fit::Fit (*fit)(const fit::FitInput&), int trials)
{
    std::mt19937_64 random(11);
    const Eigen::Matrix2Xd grid = margin::anomaly_grid(job, 20); // not the grid of the prediction
    int count = 0;
    for (int trial = 0; trial < trials; ++trial) {
        fit::FitInput input = touches_on(truth, job);
        std::normal_distribution<double> noise(0, fit::touch_sigma(job.probe));
        for (Eigen::Index i = 0; i < input.xyz.cols(); ++i) input.xyz(2, i) += noise(random);
        const surface::Surface surface = fit(input).surface;
        const double shift = margin::predict_by_posterior(surface, job, 0.95, static_cast<std::uint64_t>(trial)).shift;
        Eigen::VectorXd errors = surface::heights(surface, grid);
        for (Eigen::Index i = 0; i < grid.cols(); ++i) errors[i] += shift - truth(grid.col(i));
        count += errors.minCoeff() < 0;
    }
    return count;
}

// The number of runs that a 95 % shift over-grinds.
boost::math::binomial over_grinding(int runs) { return boost::math::binomial(runs, 0.05); }

// Leaves out one run in 1000 on either side: of 300, whose mean is 15, fewer than 4 or more than 28.
void expect_calibrated(int count, int runs)
{
    EXPECT_GE(count, quantile(over_grinding(runs), 0.001));
    EXPECT_LE(count, quantile(complement(over_grinding(runs), 0.001)));
}

TEST(Posterior, is_calibrated_for_planes)
{
    const job::Job job = square_job(job::SurfaceType::plane);
    const int runs = draws(300);
    const int count = over_ground(
        job, [](const Eigen::Vector2d& p) { return 3 + 0.1 * p.x() - 0.05 * p.y(); }, fit::fit_plane, runs);
    expect_calibrated(count, runs);
}

TEST(Posterior, is_calibrated_for_spheres)
{
    const job::Job job = square_job(job::SurfaceType::freeform);
    const double radius = 8 * kInch;
    const int runs = draws(300);
    const int count = over_ground(
        job, [=](const Eigen::Vector2d& p) { return std::sqrt(radius * radius - p.squaredNorm()); }, fit_sphere, runs);
    expect_calibrated(count, runs);
}

// The spline allows for more than the quadratic that is there, so it may only be on the safe side.
TEST(Posterior, is_safe_for_a_spline_over_a_quadratic)
{
    const job::Job job = square_job(job::SurfaceType::freeform);
    const auto truth = [](const Eigen::Vector2d& p) {
        return (p.x() * p.x() + 0.5 * p.y() * p.y() + 0.3 * p.x() * p.y()) / (8 * kInch);
    };
    const int runs = draws(100);
    EXPECT_LE(over_ground(job, truth, fit::fit_bspline, runs), quantile(complement(over_grinding(runs), 0.002)));
}

} // namespace margin_test
} // namespace fettle
