#include "margin/adaptive.h"

#include "core/error.h"
#include "draws.h"
#include "fit/fit.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/field_draws.h"
#include "margin/shift.h"
#include "sampling/freeform.h"
#include "sampling/noise.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace fettle {
namespace adaptive_test {

using Truth = double (*)(double, double);

double dome(double x, double y) { return std::sqrt(120.0 * 120 - x * x - y * y); }
double ripples(double x, double y) { return 2 * std::sin(x / 17) * std::cos(y / 21 + 0.3) + 0.002 * x * x; }

job::Job square_job()
{
    job::Job job;
    job.anomaly.resize(3, 4);
    job.anomaly << -20, 20, 20, -20, -20, -20, 20, 20, 0, 0, 0, 0;
    job.sampling = 2 * job.anomaly;
    return job;
}

/// Touches a surface with the error of touch i drawn for seed; nothing is there where x > hole.
margin::ProbeFunction touching(Truth truth, const job::Job& job, std::uint64_t seed, double hole = 1e9)
{
    return [=](const sampling::TouchPlan& plan) {
        Eigen::Matrix3Xd touches(3, plan.size());
        const Eigen::VectorXd noise =
            sampling::draw_noise({sampling::TouchNoise::Kind::normal, job.probe.accuracy}, plan.size(), seed);
        for (Eigen::Index i = 0; i < plan.size(); ++i) {
            const double x = plan.xy(0, i), y = plan.xy(1, i);
            touches.col(i) << x, y, x > hole ? std::numeric_limits<double>::quiet_NaN() : truth(x, y) + noise[i];
        }
        return touches;
    };
}

double realised_band(const job::Job& job, const margin::AdaptiveTouches& found, Truth truth)
{
    fit::FitInput input;
    input.job = job;
    input.xyz = found.touches;
    input.roles = found.plan.role;
    const surface::Surface surface = fit::fit_surface(input, "auto").surface;
    const Eigen::Matrix2Xd grid = margin::anomaly_grid(job, 12);
    Eigen::VectorXd errors = surface::heights(surface, grid);
    for (Eigen::Index i = 0; i < errors.size(); ++i) errors[i] -= truth(grid(0, i), grid(1, i));
    return margin::error_band(errors);
}

TEST(Adaptive, TouchesBesideTheAnomalyAndKeepsItsDistance)
{
    const job::Job job = square_job();
    const job::Boundaries polygons = job::working_boundaries(job);
    margin::AdaptiveLimits limits;
    limits.max_touches = 20;
    limits.min_distance = 6;
    const margin::AdaptiveTouches found = margin::touch_adaptively(job, limits, touching(dome, job, 1));
    ASSERT_EQ(found.plan.size(), 20);
    for (Eigen::Index i = 0; i < found.plan.size(); ++i) {
        EXPECT_TRUE(job::contains(polygons.sampling, found.plan.xy.col(i)));
        EXPECT_FALSE(job::contains(polygons.anomaly, found.plan.xy.col(i)));
        for (Eigen::Index j = 0; j < i; ++j) EXPECT_GT((found.plan.xy.col(i) - found.plan.xy.col(j)).norm(), 6);
    }
}

// A turned square that the anomaly all but fills: the grid of places has none on the strip between them.
TEST(Adaptive, RefusesJobsWithoutRoomBesideTheAnomaly)
{
    job::Job job = square_job();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    job.anomaly = turn * job.anomaly;
    job.sampling = 1.0001 * job.anomaly;
    job.source = "job.json";
    try {
        margin::touch_adaptively(job, {}, touching(dome, job, 1));
        ADD_FAILURE() << "there is no room to touch";
    } catch (const core::InputError& error) {
        EXPECT_EQ(std::string(error.what()), "job.json: no room to touch beside the anomaly");
    }
}

TEST(Adaptive, GoesAroundPlacesWhereNothingIsFound)
{
    const job::Job job = square_job();
    margin::AdaptiveLimits limits;
    limits.max_touches = 12;
    const margin::AdaptiveTouches found = margin::touch_adaptively(job, limits, touching(dome, job, 1, 30));
    EXPECT_EQ(found.plan.size(), 12);
    EXPECT_FALSE(found.unreachable.empty());
    for (const Eigen::Vector2d& place : found.unreachable) EXPECT_GT(place.x(), 30);
    EXPECT_LE(found.touches.row(0).maxCoeff(), 30);
    EXPECT_THROW(margin::touch_adaptively(job, limits, touching(dome, job, 1, -50)),
                 core::InputError); // nothing anywhere
}

// It stops when the predicted band is small enough, and then the band is: over draws of the touch error.
TEST(Adaptive, StopsWhenTheBandIsReachedAndItIs)
{
    const job::Job job = square_job();
    margin::AdaptiveLimits limits;
    limits.max_touches = 60;
    const auto covered = [&](Truth truth, int runs, double band) {
        limits.max_band = band;
        int count = 0;
        for (int seed = 1; seed <= runs; ++seed) {
            const margin::AdaptiveTouches found =
                margin::touch_adaptively(job, limits, touching(truth, job, static_cast<std::uint64_t>(seed)));
            const double predicted = found.band[found.band.size() - 1];
            EXPECT_TRUE(found.band_reached);
            EXPECT_LE(predicted, limits.max_band);
            count += realised_band(job, found, truth) <= predicted;
        }
        return count;
    };
    // 95 %, less three standard errors of so many runs; stopping prefers lucky draws a little.
    const int runs = draws(60);
    EXPECT_GE(covered(dome, runs, 0.15), std::floor(0.95 * runs - 3 * std::sqrt(0.95 * 0.05 * runs)));
    EXPECT_EQ(covered(ripples, 1, 0.4), 1); // no family fits: a Gaussian process, which takes longer
}

// Beside a layout it goes on only where the layout's fit is not good enough, and leaves the layout as it is.
TEST(Adaptive, ExtendsALayoutWhereItIsNotGoodEnough)
{
    const job::Job job = square_job();
    const sampling::TouchPlan layout = sampling::plan_freeform(job);
    const auto extend = [&](Truth truth, double band, int patience) {
        margin::AdaptiveLimits limits;
        limits.max_band = band;
        limits.patience = patience;
        const margin::ProbeFunction touch = touching(truth, job, 1);
        return margin::extend_layout(job, layout, touch(layout), limits, touch);
    };
    const margin::AdaptiveTouches enough = extend(dome, 1, 8);
    EXPECT_EQ(enough.plan.size(), layout.size());
    EXPECT_TRUE(enough.band_reached);
    const margin::AdaptiveTouches more = extend(dome, 0.8 * enough.band[layout.size() - 1], 8);
    EXPECT_GT(more.plan.size(), layout.size());
    EXPECT_TRUE(more.band_reached);
    EXPECT_EQ(more.layout, layout.size());
    EXPECT_EQ(more.plan.xy.leftCols(layout.size()), layout.xy);
    // 2 mm waves every 8 mm: nothing beneath the anomaly follows from what is beside it
    const Truth rough = [](double x, double y) { return 2 * std::sin(0.8 * x) * std::sin(0.7 * y + 1); };
    const margin::AdaptiveTouches hopeless = extend(rough, 0.1, 4);
    EXPECT_FALSE(hopeless.band_reached);
    EXPECT_LT(hopeless.plan.size(), 60);
}

// An outlier may be an error of the probe or a feature of the surface: another touch is made beside it.
TEST(Adaptive, ChecksOutliers)
{
    const job::Job job = square_job();
    const sampling::TouchPlan layout = sampling::plan_freeform(job);
    constexpr Eigen::Index kOutlier = 5;
    const margin::ProbeFunction touch = [&](const sampling::TouchPlan& plan) {
        Eigen::Matrix3Xd touches = touching(dome, job, 1)(plan);
        touches(2, kOutlier) += 2;
        return touches;
    };
    margin::AdaptiveLimits limits;
    limits.max_band = 1; // which the layout's fit predicts to be met
    const margin::AdaptiveTouches found = margin::extend_layout(job, layout, touch(layout), limits, touch);
    ASSERT_GT(found.plan.size(), layout.size());
    const Eigen::Vector2d beside = found.plan.xy.col(layout.size()) - layout.xy.col(kOutlier);
    EXPECT_LT(beside.norm(), 80.0 / 20); // S is 80 mm wide
    EXPECT_TRUE(found.band_reached);
    EXPECT_LT(realised_band(job, found, dome), 1);
}

// Chosen adaptively, as many touches are worth more than in Wang's layout.
TEST(Adaptive, BeatsWangsLayout)
{
    const job::Job job = square_job();
    const sampling::TouchPlan wang = sampling::plan_freeform(job);
    margin::AdaptiveLimits limits;
    limits.max_touches = static_cast<int>(wang.size());
    std::vector<double> ratio;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const margin::ProbeFunction touch = touching(dome, job, seed);
        margin::AdaptiveTouches layout;
        layout.plan = wang;
        layout.touches = touch(wang);
        ratio.push_back(realised_band(job, margin::touch_adaptively(job, limits, touch), dome) /
                        realised_band(job, layout, dome));
    }
    std::nth_element(ratio.begin(), ratio.begin() + 10, ratio.end());
    EXPECT_LT(ratio[10], 1.0);
}

// Fields drawn from a mixture have its mean, 0, and its covariance, within and between.
TEST(FieldDraws, HaveTheSurfacesVariance)
{
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 1, {0, 0}};
    surface.covariance = Eigen::Vector3d(0.04, 0.0001, 0).asDiagonal();
    surface.weight = 0.75;
    surface.alternatives = {
        {"other", 0, 0.25, surface::Plane{{0, 0}, 2, {0, 0}}, Eigen::Vector3d(0.01, 0, 0).asDiagonal()}};
    const Eigen::Vector2d xy(10, 3);
    const Eigen::MatrixXd draws = margin::draw_fields(surface, xy, 40000, 1);
    EXPECT_NEAR(draws.mean(), 0, 1e-3);
    EXPECT_NEAR(std::sqrt(draws.squaredNorm() / 40000) / surface::sigma(surface, xy), 1, 0.02);
}

} // namespace adaptive_test
} // namespace fettle
