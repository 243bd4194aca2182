// The quasi-static gantry against closed forms and identities.

#include "gantry_stock.h"

#include "core/error.h"
#include "gantry/quasi_static.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace fettle;

namespace gantry_test {

gantry::QuasiStaticOptions no_wear()
{
    gantry::QuasiStaticOptions options;
    options.grinding_ratio = 1e15;
    return options;
}

/// One pass along Y_w at mid-width; returns the status at the end.
gantry::GantryStatus pass(gantry::QuasiStaticGantry& gantry, double z, double feed, double from = -40, double to = 40,
                          double x = 0)
{
    gantry.travel({x, from, z});
    for (double y = from + 0.5; y < to; y += 0.5) gantry.grind({x, y, z}, feed);
    return gantry.grind({x, to, z}, feed);
}

double middle(const gantry::QuasiStaticGantry& gantry)
{
    return gantry.stock().z(gantry.stock().columns() / 2, gantry.stock().rows() / 2);
}

TEST(QuasiStatic, SteadyDepthIsTheBalance)
{
    // Depth t per pass: t v w = c F, F = preload + k (D − t), D the commanded depth. Sub-steps leave a ridge of
    // (0.2 mm)² / 8R = 2e-4 mm.
    for (const double preload : {0.0, 5.0})
        for (const double depth : {0.4, 1.0}) {
            job::Job job = small_job();
            job.force.preload = preload;
            job.force.max = 1e9;
            gantry::QuasiStaticGantry gantry(flat(), job, no_wear());
            const double v = 25.4, w = 6.4, c = job.removal_coefficient, k = job.force.stiffness;
            const gantry::GantryStatus end = pass(gantry, kTop - depth, v);
            const double t = c * (preload + k * depth) / (v * w + c * k);
            EXPECT_NEAR(kTop - middle(gantry), t, 3e-4);
            EXPECT_NEAR(end.force, preload + k * (depth - t), 0.005 * end.force);
            EXPECT_NEAR(end.deflection, depth - t, 0.005 * (depth - t) + 3e-4);
        }
}

TEST(QuasiStatic, PositionLimitLeavesTheCommandedPlane)
{
    // At the stop the force is what the depth takes: F = t v w / c, in proportion to depth and feed, up to the preload.
    job::Job job = small_job();
    job.force.preload = 100;
    job.force.max = 1e9;
    for (const double depth : {0.1, 0.4})
        for (const double feed : {10.0, 50.0}) {
            gantry::QuasiStaticGantry gantry(flat(), job, no_wear());
            const gantry::GantryStatus end = pass(gantry, kTop - depth, feed);
            EXPECT_EQ(end.deflection, 0);
            EXPECT_NEAR(end.force, depth * feed * 6.4 / job.removal_coefficient,
                        0.01 * end.force); // rows come one by one
            const auto ground = gantry.stock().z.block(60, 350, 40, 700);
            EXPECT_GE(ground.minCoeff(), kTop - depth - 1e-12);
            EXPECT_LE(ground.maxCoeff(), kTop - depth + 3e-4);
        }
}

TEST(QuasiStatic, VolumeIsForceTimesTime)
{
    // Removed volume = Σ c F dt over every sub-step = integrated depth. Steps of one sub-step show each force.
    job::Job job = small_job();
    job.force.preload = 3;
    const removal::HeightField before = stock(hills);
    gantry::QuasiStaticGantry gantry(before, job);
    gantry.travel({0, -50, 10});
    const double already = gantry.totals().removed_volume;
    EXPECT_EQ(already, 0);
    double impulse = 0;
    for (double y = -49.8; y < 50; y += 0.2) {
        const double t = gantry.status().time;
        const gantry::GantryStatus status = gantry.grind({0, y, 8.3}, 25.4);
        impulse += status.force * (status.time - t);
    }
    const double volume = gantry.totals().removed_volume;
    EXPECT_GT(volume, 100);
    EXPECT_NEAR(volume, job.removal_coefficient * impulse, 1e-9 * volume);
    EXPECT_NEAR(volume, removal::volume_between(before, gantry.stock()), 1e-9 * volume);
}

TEST(QuasiStatic, NoContactNoForce)
{
    const removal::HeightField before = flat();
    gantry::QuasiStaticGantry gantry(before, small_job());
    const gantry::GantryStatus end = pass(gantry, kTop + 0.001, 25.4);
    EXPECT_EQ(end.force, 0);
    EXPECT_EQ(end.deflection, 0);
    EXPECT_EQ(gantry.totals().removed_volume, 0);
    EXPECT_TRUE((gantry.stock().z == before.z).all());
}

TEST(QuasiStatic, GrindsOnlyUnderItsWheel)
{
    job::Job job = small_job();
    job.force.max = 1e9;
    gantry::QuasiStaticGantry gantry(flat(), job);
    pass(gantry, kTop - 1, 25.4, -20, 20, 2);
    const double reach = std::sqrt(2 * 25.4 * 1);
    for (Eigen::Index j = 0; j < gantry.stock().rows(); ++j)
        for (Eigen::Index i = 0; i < gantry.stock().columns(); ++i) {
            const Eigen::Vector2d at = gantry.stock().centre(i, j);
            if (std::abs(at.x() - 2) < 3.2 && std::abs(at.y()) < 20 + reach) continue;
            ASSERT_EQ(gantry.stock().z(i, j), kTop) << at.transpose();
        }
}

TEST(QuasiStatic, WallRaisesTheForceAtOnce)
{
    // A step of 3 mm across the path: within one strategy step against it the peak shows more than the end of the step.
    const auto step = [](double, double y) { return y < 0 ? kTop - 3 : kTop; };
    gantry::QuasiStaticGantry gantry(stock(step), small_job(), no_wear());
    gantry.travel({0, -30, kTop - 2.9});
    double highest = 0;
    for (double y = -29.5; y < 5; y += 0.5) {
        const gantry::GantryStatus status = gantry.grind({0, y, kTop - 2.9}, 25.4);
        EXPECT_GE(status.peak_force, status.force);
        if (y < -std::sqrt(2 * 25.4 * 2.9 - 2.9 * 2.9)) {
            EXPECT_EQ(status.peak_force, 0) << y;
        }
        highest = std::max(highest, status.peak_force);
    }
    EXPECT_GT(highest, 30);
}

TEST(QuasiStatic, HalvingCellAndSubstepHalvesTheError)
{
    // First order: the force of a sub-step is that of its end. From 0.8 mm sub-steps of 0.4 mm cells downwards.
    std::vector<double> peak, height;
    for (const double cell : {0.4, 0.2, 0.1, 0.05}) {
        gantry::QuasiStaticGantry gantry(stock(hills, cell), small_job(), no_wear());
        gantry.travel({0, -40, 8.5});
        double highest = 0;
        for (int n = 1; n <= 100; ++n)
            highest = std::max(highest, gantry.grind({0, -40 + 0.8 * n, 8.5}, 25.4).peak_force);
        peak.push_back(highest);
        height.push_back(middle(gantry));
    }
    for (const auto& value : {peak, height})
        for (std::size_t n = 2; n < value.size(); ++n) {
            const double ratio = (value[n] - value[n - 1]) / (value[n - 1] - value[n - 2]);
            EXPECT_GT(ratio, 0.35);
            EXPECT_LT(ratio, 0.65);
        }
    EXPECT_LT(std::abs(peak[3] - peak[2]), 2e-3 * peak[3]);
}

TEST(QuasiStatic, TranslationAndRotationChangeNothing)
{
    const auto run = [](double theta, const Eigen::Vector2d& shift, double lift) {
        job::Job job = small_job();
        job.theta = theta;
        job.safe_height += lift;
        const auto raised = [&](double x, double y) { return hills(x, y) + lift; };
        gantry::QuasiStaticGantry gantry(stock(raised, 0.2, theta, shift), job);
        const auto to_machine = [&](double x, double y, double z) {
            const Eigen::Vector2d at = Eigen::Rotation2Dd(theta) * (Eigen::Vector2d(x, y) + shift);
            return Eigen::Vector3d(at.x(), at.y(), z + lift);
        };
        for (const double x : {-2.0, 3.1}) { // 3.1: cell centres lie on the side faces of the wheel
            gantry.travel(to_machine(x, -40, 8.3));
            for (int n = 1; n <= 80; ++n) gantry.grind(to_machine(x, -40 + n, 8.3), 25.4);
        }
        return std::pair<Eigen::ArrayXXd, double>(gantry.stock().z - lift, gantry.status().time);
    };
    const auto [z, time] = run(0, {0, 0}, 0);
    for (const double theta : {0.3, 2.0, -1.1}) {
        const auto [turned, turned_time] = run(theta, {713.21, -88.37}, 123.4);
        EXPECT_LT((turned - z).abs().maxCoeff(), 1e-9);
        EXPECT_NEAR(turned_time, time, 1e-9);
    }
}

TEST(QuasiStatic, FeedAlongTheAxisToo)
{
    // The wheel moved along its axis meets a wall of the same height: in steady state F v-proportional as along Y_w.
    job::Job job = small_job();
    job.force.preload = 100;
    job.force.max = 1e9;
    const auto half = [](double x, double) { return x < -4 ? kTop - 0.3 : kTop; };
    gantry::QuasiStaticGantry gantry(stock(half), job, no_wear());
    gantry.travel({-7.5, 0, kTop - 0.2});
    const double y_reach = std::sqrt(2 * 25.4 * 0.2 - 0.04);
    const double segment = 25.4 * 25.4 * std::acos(1 - 0.2 / 25.4) - (25.4 - 0.2) * y_reach;
    gantry::GantryStatus status;
    for (int n = 1; n <= 25; ++n) {
        status = gantry.grind({-7.5 + 0.37 * n, 0, kTop - 0.2}, 20); // cells and steps have nothing in common
        if (n < 10) continue;
        EXPECT_NEAR(status.force, segment * 20 / job.removal_coefficient, 0.005 * status.force);
        EXPECT_NEAR(status.peak_force, status.force, 0.005 * status.force);
    }
    // but for the sub-step that the next one would make up for
    const double face = -7.5 + 25 * 0.37 + 3.2;
    EXPECT_NEAR(gantry.totals().removed_volume, segment * (face + 4), 0.21 * segment);
}

TEST(QuasiStatic, WheelWearsByTheGrindingRatio)
{
    job::Job job = small_job();
    job.force.max = 1e9;
    gantry::QuasiStaticOptions options;
    options.grinding_ratio = 5;
    gantry::QuasiStaticGantry gantry(flat(), job, options);
    pass(gantry, kTop - 1, 25.4);
    const double lost = gantry.totals().removed_volume / 5;
    const double r = gantry.true_radius();
    // π w (R² − r²): the sub-steps are explicit, second order in a loss of 1e-5 mm each
    EXPECT_NEAR(std::numbers::pi * 6.4 * (25.4 * 25.4 - r * r), lost, 1e-4 * lost);

    const double measured = gantry.touch_off();
    EXPECT_LE(std::abs(measured - r), options.touch_resolution / 2 + 1e-12);
    EXPECT_EQ(gantry.totals().touch_offs, 1);
    gantry.change_wheel();
    EXPECT_EQ(gantry.true_radius(), 25.4);

    job.wheel.grinding_ratio = 5; // the job's wheel says it as well
    gantry::QuasiStaticGantry again(flat(), job, {});
    pass(again, kTop - 1, 25.4);
    EXPECT_EQ(again.true_radius(), r);

    options.grinding_ratio = 1e-3;
    gantry::QuasiStaticGantry soft(flat(), job, options);
    const auto grind_on = [&] {
        for (int n = 0; n < 1000; ++n) {
            soft.touch_off(); // else a wheel that has lost the depth touches no more
            pass(soft, kTop - 1, 25.4, -2, 2);
        }
    };
    EXPECT_THROW(grind_on(), core::InputError);
}

TEST(QuasiStatic, WornWheelGrindsTooHighUntilTouchOff)
{
    job::Job job = small_job();
    job.force.preload = 1000; // position decides
    job.force.max = 1e9;
    gantry::QuasiStaticOptions options;
    options.grinding_ratio = 2;
    gantry::QuasiStaticGantry gantry(flat(), job, options);
    pass(gantry, kTop - 0.5, 25.4);
    const double loss = 25.4 - gantry.true_radius();
    ASSERT_GT(loss, 0.05);
    pass(gantry, kTop - 1, 25.4);
    EXPECT_GT(middle(gantry), kTop - 1 + loss);
    gantry.touch_off();
    pass(gantry, kTop - 1, 25.4, -2, 2); // little to remove, little wear
    EXPECT_NEAR(middle(gantry), kTop - 1, 0.03);
}

TEST(QuasiStatic, TimeIsTheSumOfItsParts)
{
    gantry::QuasiStaticOptions options;
    gantry::QuasiStaticGantry gantry(flat(), small_job(), options);
    EXPECT_NEAR((gantry.status().commanded - Eigen::Vector3d(0, 0, 30)).norm(), 0, 1e-12);
    EXPECT_NEAR(gantry.travel({3, -4, 20}).time, 5 / 100. + 10 / 50., 1e-12);
    EXPECT_NEAR(gantry.travel({3, 6, 20}).time, 5 / 100. + 10 / 50. + 2 * 10 / 50. + 10 / 100., 1e-12);
    const double travelled = gantry.status().time;
    EXPECT_NEAR(gantry.grind({3, 10, 20}, 8).time, travelled + 0.5, 1e-12);
    EXPECT_NEAR(gantry.lift(25).time, travelled + 0.6, 1e-12);
    gantry.touch_off();
    gantry.change_wheel();
    const gantry::GrindTotals& totals = gantry.totals();
    EXPECT_NEAR(totals.service_time, options.touch_off_time + options.wheel_change_time, 1e-12);
    EXPECT_NEAR(totals.grinding_time, 0.5, 1e-12);
    EXPECT_NEAR(totals.grinding_length, 4, 1e-12);
    EXPECT_NEAR(gantry.status().time, totals.grinding_time + totals.travel_time + totals.service_time, 1e-12);
    EXPECT_EQ(gantry.status().commanded.z(), 30);
    EXPECT_THROW(gantry.grind({0, 0, 20}, 0), core::InputError);
    options.rapid = std::nan("");
    EXPECT_THROW(gantry::QuasiStaticGantry(flat(), small_job(), options), core::InputError);
}

// A touch-off takes ten seconds in one place, and a stop does not wait for its end; what was not measured is not taken
// for measured. Not stopped, it takes the same time to the last bit whether it is looked at or not.
TEST(QuasiStatic, IsStoppedInATouchOffAtOnce)
{
    gantry::QuasiStaticOptions options = no_wear();
    options.wheel_change_time = 120;
    gantry::QuasiStaticGantry gantry(flat(), small_job(), options), undisturbed(flat(), small_job(), options);
    undisturbed.touch_off();
    const double whole = undisturbed.status().time;
    for (const double asked : {0.0, 3.02, 9.9}) {
        const double begin = gantry.status().time;
        gantry.set_interrupt([&](const gantry::GantryStatus& now) { return now.time >= begin + asked; });
        EXPECT_THROW(gantry.touch_off(), gantry::Interrupted);
        EXPECT_NEAR(gantry.status().time - begin, asked, 0.06);
    }
    EXPECT_EQ(gantry.totals().touch_offs, 0);
    double begin = gantry.status().time;
    gantry.set_interrupt([&](const gantry::GantryStatus& now) { return now.time > begin + 1; });
    EXPECT_THROW(gantry.change_wheel(), gantry::Interrupted);
    begin = gantry.status().time;
    gantry.set_interrupt([&](const gantry::GantryStatus& now) { return now.time > begin + 1; });
    EXPECT_THROW(gantry.probe({0, 0}, -100), gantry::Interrupted);
    EXPECT_LT(gantry.status().time - begin, 1.06);
    EXPECT_DOUBLE_EQ(gantry.status().commanded.z(), small_job().safe_height);

    gantry::QuasiStaticGantry watched(flat(), small_job(), options);
    int asked = 0;
    watched.set_interrupt([&](const gantry::GantryStatus& /*now*/) { return ++asked < 0; });
    watched.touch_off();
    EXPECT_EQ(watched.status().time, whole);
    EXPECT_GT(asked, 100);
}

TEST(QuasiStatic, TravelsNoHigherThanItIsTold)
{
    gantry::QuasiStaticGantry gantry(flat(), small_job());
    const double begun = gantry.travel({3, -4, 20}).time;
    EXPECT_NEAR(gantry.travel_low({3, 6, 19}, 22, 20).time - begun, 2 / 50. + 10 / 100. + 3 / 50., 1e-12);
    EXPECT_NEAR(gantry.travel_low({3, -4, 21}, 18, 18).time - begun, 5 / 50. + 10 / 100. + 2 / 50. + 10 / 100., 1e-12);
    EXPECT_EQ(gantry.status().commanded, Eigen::Vector3d(3, -4, 21));
    const double force = gantry.travel_low({0, 0, kTop - 5}, 22, 20).force; // guarded as ever
    EXPECT_GE(force, 60);
    EXPECT_LE(force, 61);
}

TEST(QuasiStatic, TheWayDownIsGuarded)
{
    // 5 mm into the stock would take 175 N; the drives stop at F_max = 60 N, a sub-step late at most.
    gantry::QuasiStaticGantry gantry(flat(), small_job());
    const gantry::GantryStatus status = gantry.travel({0, 0, kTop - 5});
    EXPECT_GE(status.force, 60);
    EXPECT_LE(status.force, 60 + 35 * 0.2);
    EXPECT_GT(status.commanded.z(), kTop - 5);
    EXPECT_NEAR(status.force, 35 * status.deflection, 1e-9);
    const gantry::GantryStatus up = gantry.lift(kTop + 1);
    EXPECT_EQ(up.force, 0);
    EXPECT_EQ(up.deflection, 0);
    EXPECT_GE(up.peak_force, 60);
    EXPECT_EQ(up.commanded.z(), kTop + 1);
    EXPECT_EQ(gantry.lift(kTop + 2).peak_force, 0);
}

} // namespace gantry_test
