// The force keeps its limit: Wang's parts, stubs with upright walls, on the ideal and the dynamic gantry, in soft and
// hard metal, layer 1 in every way. And the upper bound of the stock against the gantry.

#include "gantry_stock.h"

#include "fit/fit.h"
#include "gantry/dynamic.h"
#include "gantry/quasi_static.h"
#include "geometry/bounding_box.h"
#include "job/boundary.h"
#include "margin/shift.h"
#include "part/part.h"
#include "plan/plan.h"
#include "sampling/estimate.h"
#include "sampling/probe.h"
#include "strategy/run.h"
#include "strategy/stock_bound.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <tuple>

namespace fettle {
namespace force_limit_test {

constexpr double kMaxPeakShare = 1.15; // of F_max; a warning above it

std::string samples() { return std::getenv("SAMPLES"); }

struct Work {
    plan::Plan plan;
    removal::HeightField stock;
};

Work wang(int part)
{
    const std::string name = "wang" + std::to_string(part) + ".json";
    const job::Job job = job::read_job(samples() + "/jobs/" + name);
    const sampling::Scan scan(std::get<mesh::Mesh>(part::make_part(part::read_part(samples() + "/parts/" + name), 1)));
    const sampling::TouchPlan touches = sampling::plan_touches(job);
    fit::FitInput input;
    input.job = job;
    input.xyz = sampling::probe(scan, job, touches, sampling::parse_noise("normal:0.005", job.units.mm()), 1);
    input.roles = touches.role;
    input.curves = touches.curve;
    surface::Surface surface = fit::fit_surface(input, "auto").surface;
    surface.prediction = margin::predict_by_posterior(surface, job, 0.99, 1);
    surface.shift = surface.prediction->shift;
    return {plan::make_plan(job, surface), removal::stock_from_scan(scan, job, 0.2)};
}

/// A plate with stubs whose walls are upright: one as high as 25 mm, one along the boundary of B, a low one.
Work stubs(double theta)
{
    job::Job job = small_job();
    job.surface = job::SurfaceType::plane;
    job.theta = theta;
    job.tolerance = 0.1;
    job.safe_height = 40;
    job.feed = {'y', 25.4, 5};
    const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(theta).transpose();
    job.anomaly = Eigen::Matrix3Xd::Zero(3, 4);
    job.anomaly.topRows(2) << -30, 30, 30, -30, -30, -30, 30, 30;
    job.anomaly.topRows(2) = (R_machine_working * job.anomaly.topRows(2)).eval();
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 0, {0, 0}};
    const auto [B, S] = job::working_boundaries(job);
    removal::HeightField stock =
        removal::empty_height_field(geometry::bounding_box(B), {job.wheel.width / 2, job.wheel.radius}, theta, 0.2);
    for (Eigen::Index j = 0; j < stock.rows(); ++j)
        for (Eigen::Index i = 0; i < stock.columns(); ++i) {
            const Eigen::Vector2d at = stock.centre(i, j);
            const auto within = [&](double x0, double x1, double y0, double y1) {
                return at.x() > x0 && at.x() < x1 && at.y() > y0 && at.y() < y1;
            };
            stock.z(i, j) = within(-11, 3, -8, 9) ? 25 : within(12, 30, 21, 30) ? 8 : within(17, 26, -25, -5) ? 3 : 0;
        }
    return {plan::make_plan(job, surface), stock};
}

strategy::GrindRun grind(const Work& work, bool dynamic, double factor, strategy::Layer1 layer_1)
{
    strategy::RunOptions options;
    options.layer_1 = layer_1;
    std::unique_ptr<gantry::Gantry> machine;
    if (dynamic) {
        gantry::DynamicOptions how;
        how.removal_factor = factor;
        machine = std::make_unique<gantry::DynamicGantry>(
            work.stock, work.plan.job, gantry::read_machine(samples() + "/machines/full_scale.json"), how);
    } else {
        gantry::QuasiStaticOptions how;
        how.removal_factor = factor;
        machine = std::make_unique<gantry::QuasiStaticGantry>(work.stock, work.plan.job, how);
    }
    return strategy::run(work.plan, *machine, options);
}

/// Part (0: stubs, -1: turned stubs), dynamic, layer 1.
class ForceLimit : public testing::TestWithParam<std::tuple<int, bool, strategy::Layer1>> {};

TEST_P(ForceLimit, IsKept)
{
    const auto [part, dynamic, layer_1] = GetParam();
    const Work work = part > 0 ? wang(part) : stubs(0.6 * part);
    for (const double factor : {0.5, 1.0, 1.5}) {
        const strategy::GrindRun run = grind(work, dynamic, factor, layer_1);
        EXPECT_TRUE(run.finished) << factor << ": " << run.failure;
        EXPECT_LE(run.force.peak, kMaxPeakShare * work.plan.job.force.max)
            << factor << ", layer " << run.force.peak_layer << ", at " << run.force.peak_at.transpose();
        EXPECT_EQ(strategy::peak_warning(run.force, work.plan.job), "");
    }
}

INSTANTIATE_TEST_SUITE_P(Parts, ForceLimit,
                         testing::Combine(testing::Values(-1, 0, 1, 2, 3), testing::Bool(),
                                          testing::Values(strategy::Layer1::constant, strategy::Layer1::feed,
                                                          strategy::Layer1::force)));

/// Layer 1 goes faster than the job's feed where the wheel has been and has left nothing, and only there: at that feed
/// v, and straight on within the way v² / 2a to a stop, it meets nothing higher than a quarter of the tolerance, which
/// no covering needs to grind, on the ideal gantry; on drives with errors, and a noisy transducer, no more than F_min.
class AirInLayer1 : public testing::TestWithParam<bool> {};

TEST_P(AirInLayer1, IsCrossedAsFastAsTheDrivesCanStop)
{
    const bool dynamic = GetParam();
    const Work work = stubs(0);
    const job::Job& job = work.plan.job;
    const strategy::GrindRun run = grind(work, dynamic, 1, strategy::Layer1::constant);
    const double ridge = 0.001; // mm: what the bound's grid does not know
    const double limit = dynamic ? job.force.min : job.force.stiffness * (job.tolerance / 4 + ridge);
    const double deceleration = 1000; // mm/s²
    double fast_way = 0;
    for (std::size_t i = 1; i < run.trace.size(); ++i) {
        const strategy::TraceRow& row = run.trace[i];
        if (row.layer != 1 || !(row.feed > 1.001 * job.feed.rate)) continue;
        EXPECT_LE(row.feed, 2.001 * job.feed.rate);
        const Eigen::Vector3d step = row.tool - run.trace[i - 1].tool;
        fast_way += step.norm();
        const double room = row.feed * row.feed / (2 * deceleration);
        for (std::size_t j = i; j < run.trace.size() && run.trace[j].feed > 0; ++j) {
            const Eigen::Vector3d on = run.trace[j].tool - row.tool, last = run.trace[j].tool - run.trace[j - 1].tool;
            if (on.norm() > room || last.dot(step) < 0.5 * last.norm() * step.norm()) break; // it turns
            EXPECT_LE(run.trace[j].peak_force, limit) << i << ", " << j << ": " << row.tool.transpose();
        }
    }
    EXPECT_GT(fast_way, 3 * 60); // three of the passes over B
}

INSTANTIATE_TEST_SUITE_P(Gantries, AirInLayer1, testing::Bool());

TEST(ForceRecord, WarnsWithThePlace)
{
    strategy::ForceRecord record;
    const job::Job job = small_job();
    record.add({.commanded = {1, 2, 3}, .deflection = 1, .force = 35, .peak_force = 70}, 3, 2, job.force);
    record.add({.commanded = {1, 2, 3}, .deflection = 0.1, .force = 3.5, .peak_force = 40}, 2, 1, job.force);
    record.add({.commanded = {1, 2, 3}, .deflection = 1, .force = 35, .peak_force = 35}, 1, 9, job.force);
    EXPECT_EQ(record.contact_time, 3);
    EXPECT_DOUBLE_EQ(record.in_range, 2.0 / 3);
    EXPECT_EQ(strategy::peak_warning(record, job),
              "the force came to 70 N, 117 % of force.max, in layer 3 at x 1, y 2, z 4");
}

TEST(StockBound, KnowsWhereTheWheelHasBeen)
{
    const job::Job job = stubs(0).plan.job;
    strategy::StockBound bound(job, 1);
    const double radius = job.wheel.radius;
    const Eigen::Vector3d a(0, -20, 1), b(0, 20, 1), beside(3, 0, 1), outside(45, 0, 1);
    // Nothing is known in B: anything may stand there, up to the safe height.
    EXPECT_EQ(bound.free_height(a, b, radius), job.safe_height);
    EXPECT_GT(bound.max_force({a, b}, radius, 25.4), 3 * job.force.max);
    bound.lower(a, b, radius);
    // Over the path it touches nothing but what the clearance is for; beside it, or off the work, nothing is known.
    EXPECT_LT(bound.free_height(a, b, radius), 1 + 1);
    EXPECT_EQ(bound.max_force({a, b}, radius, 25.4), 0);
    EXPECT_EQ(bound.free_height(a, beside, radius), job.safe_height);
    EXPECT_GT(bound.max_force({Eigen::Vector3d(0, 0, 1), beside}, radius, 25.4), 3 * job.force.max);
    EXPECT_EQ(bound.free_height(a, outside, radius), job.safe_height);
    // It is free to go along the path, as deep as the allowance, but not on, where metal may stand before its rim.
    const Eigen::Vector3d deeper(0, 0, -0.1), on(0, 30, 1);
    EXPECT_DOUBLE_EQ(bound.free_length({a, b}, radius, 0.001), 40);
    EXPECT_DOUBLE_EQ(bound.free_length({a + deeper, b + deeper}, radius, 0.11), 40);
    EXPECT_EQ(bound.free_length({a + deeper, b + deeper}, radius, 0.09), 0);
    EXPECT_DOUBLE_EQ(bound.free_length({a, b, on}, radius, 0.1), 40);
    EXPECT_EQ(bound.free_length({beside, b + beside - Eigen::Vector3d(0, 0, 1)}, radius, 0.1), 0);
    // What is predicted a little deeper is what a gantry meets in metal twice as hard, to a tenth.
    removal::HeightField ground = stock([](double, double) { return 1.0; }, 0.1);
    gantry::QuasiStaticOptions hard;
    hard.removal_factor = 0.5;
    hard.grinding_ratio = 1e15;
    gantry::QuasiStaticGantry gantry(ground, job, hard);
    gantry.travel({0, -10, 0});
    double met = 0;
    std::vector<Eigen::Vector3d> path = {{0, -10, 0}};
    for (double y = -9.5; y <= 10; y += 0.5) {
        path.emplace_back(0, y, 0);
        met = std::max(met, gantry.grind(path.back(), 25.4).peak_force);
    }
    EXPECT_NEAR(bound.max_force(path, radius, 25.4), met, 0.1 * met);
}

} // namespace force_limit_test
} // namespace fettle
