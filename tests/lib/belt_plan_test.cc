// Plans for allowances that are known to be met by some feeds or forces, and what limits do.

#include "belt/belt_plan.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace fettle;

namespace belt_plan_test {

using Eigen::Index;

constexpr double kSpacing = 0.5;

belt::Surfels plate()
{
    const Index rows = 72, columns = 40;
    belt::Surfels surfels;
    surfels.position.setZero(3, rows * columns);
    for (Index j = 0; j < columns; ++j)
        for (Index i = 0; i < rows; ++i)
            surfels.position.col(j * rows + i) << (double(i) + 0.5) * kSpacing - 18, (double(j) + 0.5) * kSpacing - 10,
                0;
    surfels.normal.setZero(3, rows * columns);
    surfels.normal.row(2).setOnes();
    surfels.radius.setConstant(surfels.size(), kSpacing);
    surfels.displacement.setZero(surfels.size());
    surfels.uv.setZero(2, surfels.size());
    surfels.patch.setZero(surfels.size());
    return surfels;
}

/// It takes so little that the contact does not change with it: the choices that made an allowance are those that meet
/// it.
belt::ContactWheel crowned()
{
    belt::ContactWheel wheel;
    wheel.radius = 20;
    wheel.width = 30;
    wheel.crown_radius = 30;
    wheel.layer = {3, 2, 0.45};
    wheel.belt_speed = 15000;
    wheel.law.coefficient = 1e-8;
    return wheel;
}

/// Three passes 4 mm apart, from -12 to 12 mm.
std::vector<belt::BeltPoint> passes(double (*feed)(double x, double y), double (*force)(double x, double y))
{
    std::vector<belt::BeltPoint> path;
    for (const double y : {-4.0, 0.0, 4.0})
        for (int k = 0; k <= 12; ++k) {
            const double x = -12 + 2 * k;
            belt::BeltPoint point{Eigen::Isometry3d::Identity(), {true, force(x, y)}, feed(x, y), 0, k == 0};
            point.T_part_tool.translation() << x, y, 0;
            path.push_back(point);
        }
    return path;
}

double even_feed(double, double) { return 5; }
double even_force(double, double) { return 10; }
double wavy_feed(double x, double y) { return 5 + 2 * std::sin(x / 5 + y); }
double wavy_force(double x, double y) { return 10 + 5 * std::sin(x / 5 + y); }

/// What such a path takes is the allowance.
belt::Surfels allowance_of(const std::vector<belt::BeltPoint>& path)
{
    belt::Surfels surfels = plate();
    surfels.displacement = belt::grind(surfels, crowned(), path, {}).removed;
    return surfels;
}

belt::BeltPlanOptions limits(double min, double max)
{
    belt::BeltPlanOptions options;
    options.min = min;
    options.max = max;
    options.smoothness = 1e-9;
    return options;
}

TEST(BeltPlan, FindsTheFeedsAgain)
{
    const std::vector<belt::BeltPoint> known = passes(wavy_feed, even_force);
    const belt::Surfels surfels = allowance_of(known);
    const belt::BeltPlan plan = belt::plan_belt(surfels, crowned(), passes(even_feed, even_force), limits(1, 50));
    EXPECT_TRUE(plan.converged);
    EXPECT_LE(plan.rms_planned, 0.03 * plan.rms_constant);
    EXPECT_LT(plan.rms_constant, plan.rms_before);
    for (std::size_t k = 0; k < known.size(); ++k) {
        EXPECT_NEAR(plan.path[k].feed, known[k].feed, 0.05 * known[k].feed);
        EXPECT_EQ(plan.path[k].load.value, 10);
    }
    EXPECT_GT(plan.reached, 0);
    EXPECT_LT(plan.reached, plan.touched);
}

TEST(BeltPlan, FindsTheForcesAgain)
{
    const belt::Surfels surfels = allowance_of(passes(even_feed, wavy_force));
    const belt::BeltPlan plan = [&] {
        belt::BeltPlanOptions options = limits(1, 50);
        options.by_force = true;
        return belt::plan_belt(surfels, crowned(), passes(even_feed, even_force), options);
    }();
    EXPECT_LE(plan.rms_planned, 0.05 * plan.rms_constant);
    for (const belt::BeltPoint& point : plan.path) {
        EXPECT_EQ(point.feed, 5);
        EXPECT_NEAR(point.load.value,
                    wavy_force(point.T_part_tool.translation().x(), point.T_part_tool.translation().y()), 1.5);
    }
}

// The law's exponents bend what a feed takes; the answer is the same.
TEST(BeltPlan, FollowsThePowerLaw)
{
    belt::ContactWheel wheel = crowned();
    wheel.law.pressure_exponent = 1.5;
    wheel.law.feed_exponent = -0.3;
    wheel.law.wear_work = 5e5;
    belt::Surfels surfels = plate();
    const std::vector<belt::BeltPoint> known = passes(wavy_feed, even_force);
    surfels.displacement = belt::grind(surfels, wheel, known, {}).removed;
    const belt::BeltPlan plan = belt::plan_belt(surfels, wheel, passes(even_feed, even_force), limits(1, 50));
    EXPECT_LE(plan.rms_planned, 0.03 * plan.rms_constant);
    for (std::size_t k = 0; k < known.size(); ++k) EXPECT_NEAR(plan.path[k].feed, known[k].feed, 0.05 * known[k].feed);
}

TEST(BeltPlan, KeepsItsLimits)
{
    const belt::Surfels surfels = allowance_of(passes(wavy_feed, even_force));
    const belt::BeltPlan plan = belt::plan_belt(surfels, crowned(), passes(even_feed, even_force), limits(4, 6));
    for (const belt::BeltPoint& point : plan.path) {
        EXPECT_GE(point.feed, 4);
        EXPECT_LE(point.feed, 6);
    }
    EXPECT_GT(plan.at_min, 0);
    EXPECT_GT(plan.at_max, 0);
    EXPECT_LT(plan.rms_planned, plan.rms_constant);
}

// The smoother, the more even, at the cost of the error.
TEST(BeltPlan, IsSmoothOnRequest)
{
    const belt::Surfels surfels = allowance_of(passes(wavy_feed, even_force));
    const auto planned = [&](double smoothness) {
        belt::BeltPlanOptions options = limits(1, 50);
        options.smoothness = smoothness;
        return belt::plan_belt(surfels, crowned(), passes(even_feed, even_force), options);
    };
    const belt::BeltPlan rough = planned(1e-9), smooth = planned(1e-3);
    const auto spread = [](const belt::BeltPlan& plan) {
        double min = 1e9, max = 0;
        for (const belt::BeltPoint& point : plan.path) {
            min = std::min(min, point.feed);
            max = std::max(max, point.feed);
        }
        return max / min;
    };
    EXPECT_LT(spread(smooth), 0.7 * spread(rough));
    EXPECT_LE(rough.rms_planned, smooth.rms_planned);
}

// Where the wheel is off the part nothing is planned, and its loads there do not count: the same plan as without.
TEST(BeltPlan, PassesOverPointsOffThePart)
{
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const bool by_force : {false, true}) {
        const belt::Surfels surfels =
            allowance_of(by_force ? passes(even_feed, wavy_force) : passes(wavy_feed, even_force));
        const std::vector<belt::BeltPoint> on = passes(even_feed, even_force);
        std::vector<belt::BeltPoint> with;
        for (const belt::BeltPoint& point : on) {
            if (point.touches_down) {
                belt::BeltPoint off{point.T_part_tool, {true, kNan}, kNan, kNan, true};
                off.T_part_tool.matrix().setConstant(kNan);
                with.insert(with.end(), 4, off);
            }
            with.push_back(point);
        }
        belt::BeltPlanOptions options = limits(1, 50);
        options.by_force = by_force;
        options.max_rounds = 1;
        options.smoothness = 1e-3;
        const belt::BeltPlan expected = belt::plan_belt(surfels, crowned(), on, options);
        belt::BeltPlan plan = belt::plan_belt(surfels, crowned(), with, options);
        EXPECT_NEAR(plan.rms_planned, expected.rms_planned, 1e-6 * expected.rms_planned);
        EXPECT_EQ(plan.constant, expected.constant);
        std::erase_if(plan.path, [](const belt::BeltPoint& point) { return !point.is_on_part(); });
        ASSERT_EQ(plan.path.size(), on.size());
        for (std::size_t k = 0; k < on.size(); ++k) {
            EXPECT_NEAR(plan.path[k].feed, expected.path[k].feed, 1e-6 * expected.path[k].feed);
            EXPECT_NEAR(plan.path[k].load.value, expected.path[k].load.value, 1e-5);
        }
    }
}

TEST(BeltPlan, RefusesForcesWhereDepthsAreGiven)
{
    std::vector<belt::BeltPoint> path = passes(even_feed, even_force);
    path[3].load = {false, 0.2};
    belt::BeltPlanOptions options = limits(1, 50);
    options.by_force = true;
    EXPECT_THROW(belt::plan_belt(plate(), crowned(), path, options), core::InputError);
}

} // namespace belt_plan_test
