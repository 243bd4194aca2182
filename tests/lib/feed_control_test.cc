// Layer 1 in one covering: strokes of a pass, feed-rate and force control, the wheel's wear between two measurements.

#include "strategy/feed_control.h"
#include "strategy/force_control.h"
#include "strategy/layer_switching.h"
#include "strategy/wheel_wear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <set>

using namespace fettle;

namespace feed_control_test {

constexpr double kRemaining = 0.1;

strategy::LayerSwitching::Settings settings()
{
    strategy::LayerSwitching::Settings s;
    s.force_min = 5, s.force_down = 10, s.force_max = 15;
    s.step_over = 1;
    s.max_remaining = kRemaining;
    s.finish_passes = true;
    s.bounds = {.layers = 5, .re_cuts = 40, .coverings = 1, .time = 1e6, .steps = 100000};
    return s;
}

std::vector<plan::ToolPass> square(int count, int points)
{
    std::vector<plan::ToolPass> passes(static_cast<std::size_t>(count));
    for (int p = 0; p < count; ++p) {
        passes[static_cast<std::size_t>(p)].line = p;
        passes[static_cast<std::size_t>(p)].starts = {0};
        for (int i = 0; i < points; ++i) passes[static_cast<std::size_t>(p)].along.push_back(i);
    }
    return passes;
}

TEST(Strokes, LeaveNoPlaceTooHighAndMoveByNeighbours)
{
    // Random stock, of which each visit leaves 0.4. At the end no place is too high; every place was visited, each move
    // was to a neighbour or to the same end of the next pass, and no place was visited more often than two of its
    // neighbourhood needed.
    std::mt19937 random(5);
    for (int run = 0; run < 200; ++run) {
        const int count = 1 + int(random() % 4), points = 2 + int(random() % 9);
        std::vector<std::vector<double>> z(std::size_t(count), std::vector<double>(std::size_t(points), 0));
        for (auto& pass : z)
            for (double& height : pass) height = random() % 3 == 0 ? double(random() % 1000) / 200 : 0;
        const auto passes = square(count, points);
        strategy::LayerSwitching strategy(passes, settings());
        std::set<std::pair<int, int>> visited;
        strategy::Action action = strategy.first();
        double time = 0;
        while (action.kind != strategy::Action::Kind::finish) {
            ASSERT_NE(action.kind, strategy::Action::Kind::fail) << strategy.failure();
            double& height = z[std::size_t(action.to.pass)][std::size_t(action.to.point)];
            visited.insert({action.to.pass, action.to.point});
            const strategy::PathIndex before = action.to;
            const double remaining = height;
            height *= 0.4;
            action = strategy.next({0, remaining, ++time});
            if (action.kind != strategy::Action::Kind::grind) continue;
            if (action.to.pass == before.pass) {
                ASSERT_EQ(std::abs(action.to.point - before.point), 1);
            } else {
                ASSERT_EQ(action.to.pass, before.pass + 1);
                ASSERT_EQ(action.to.point, before.point);
                ASSERT_TRUE(before.point == 0 || before.point == points - 1);
            }
        }
        EXPECT_EQ(int(visited.size()), count * points);
        EXPECT_EQ(strategy.counts().coverings, 1);
        for (const auto& pass : z)
            for (const double height : pass) ASSERT_LE(height, 0.4 * kRemaining);
    }
}

TEST(Strokes, GoOnlyWhereTooMuchIsLeft)
{
    // Two in the middle of 20 places need a second visit: back from the far end to one beyond them, and on to the
    // nearer end.
    const auto passes = square(1, 20);
    strategy::LayerSwitching strategy(passes, settings());
    std::vector<double> z(20, 0);
    z[6] = z[7] = 0.2;
    strategy::Action action = strategy.first();
    std::string points_visited;
    for (double time = 0; action.kind != strategy::Action::Kind::finish; ++time) {
        points_visited += std::to_string(action.to.point) + " ";
        const double remaining = z[std::size_t(action.to.point)];
        z[std::size_t(action.to.point)] *= 0.4;
        action = strategy.next({0, remaining, time});
    }
    EXPECT_EQ(points_visited,
              "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 18 17 16 15 14 13 12 11 10 9 8 7 6 5 4 3 2 1 0 ");
    EXPECT_EQ(strategy.counts().strokes, 1);
}

TEST(FeedControl, HoldsTheTargetWhateverTheMetalYields)
{
    // The wheel climbs by s v and sinks by c F / A, steps of 1 ms; s such that the job's feed leaves 1.2 times the
    // limit. At rest what is left is the target, three quarters of the limit, for metal of half to twice the job's c /
    // A.
    job::Job job;
    for (const double yields : {0.25, 0.5, 0.9}) {
        const double limit = 0.05, contact = std::sqrt(2 * job.wheel.radius * 0.75 * limit);
        const double rate = yields * job.removal_coefficient / (contact * job.wheel.width), k = job.force.stiffness;
        const double s = rate * k * 1.2 * limit / job.feed.rate;
        strategy::FeedControl control(job, limit);
        EXPECT_EQ(control.feed(), job.feed.rate);
        double z = 0;
        for (int n = 0; n < 400; ++n) {
            const double before = z;
            for (int i = 0; i < 20; ++i) z += (s * control.feed() - rate * k * z) * 1e-3;
            control.update(before, z, 0.02);
        }
        EXPECT_NEAR(z, 0.75 * limit, 0.002 * limit) << yields;
        EXPECT_NEAR(control.feed(), job.feed.rate * 0.75 / 1.2, 0.01 * job.feed.rate);
    }
}

TEST(FeedControl, DoesWithTheFewestStrokes)
{
    // Flat stock of the height h; a stroke at the feed v leaves δ with (h − δ) w v = c k δ. As many strokes as the
    // control foresees, each at its feed, leave the target, three quarters of the limit; one less would need less than
    // half of the job's feed.
    const job::Job job;
    const double limit = 0.05, target = 0.75 * limit, k = job.force.stiffness, v = job.feed.rate;
    const auto left = [&](double h, double feed) {
        return h / (1 + k * job.removal_coefficient / (job.wheel.width * feed));
    };
    for (const double h : {0.3, 0.5, 1.0, 3.0}) {
        strategy::FeedControl control(job, limit);
        const double z = left(h, v);
        control.update(z, z, 0.02);
        EXPECT_GE(control.feed(), 0.5 * v);
        EXPECT_LE(control.feed(), v);
        int strokes = 0, slow = 0;
        for (double high = h; high > target * (1 + 1e-9); high = left(high, control.feed())) ++strokes;
        for (double high = h; high > target * (1 + 1e-9); high = left(high, 0.5 * v)) ++slow;
        EXPECT_EQ(strokes, std::max(slow, 2)) << h;
    }
    strategy::FeedControl control(job, limit);
    control.update(0, 0, 0.02); // air
    EXPECT_EQ(control.feed(), v);
    // Stock so hard that a stroke takes a twentieth of what is left: more strokes than are foreseen.
    job::Job hard;
    hard.removal_coefficient = 0.05 * hard.wheel.width * v / k;
    strategy::FeedControl slow(hard, limit);
    slow.update(1.5 * target, 1.5 * target, 0.02);
    EXPECT_LT(slow.feed(), v);
    slow.update(20 * target, 20 * target, 0.02);
    EXPECT_EQ(slow.feed(), v);
}

/// Strokes to and fro over a flat stock `high` above the reference until no more than `limit` is left in the
/// middle. Each
/// step is a balance of Preston's law and the spring: (stock − r) v = q k (r + u). Returns how many, and the lowest r.
std::pair<int, double> strokes_by_force(const job::Job& job, double q, double high, double limit, bool pressed,
                                        const std::optional<strategy::KnownRemoval>& known = std::nullopt)
{
    strategy::ForceControl control(job, limit, known);
    std::vector<double> along(100), z(100, high);
    for (std::size_t n = 0; n < along.size(); ++n) along[n] = 0.5 * double(n);
    control.begin_pass(along);
    const double k = job.force.stiffness, v = job.feed.rate;
    double lowest = high;
    for (int stroke = 1; stroke < 100; ++stroke) {
        double max = 0;
        for (int i = 0; i < 100; ++i) {
            const int n = stroke % 2 == 1 ? i : 99 - i;
            const double u = pressed ? control.next_force_offset(n, stroke % 2 == 1 ? 1 : -1) : 0;
            double& stock = z[std::size_t(n)];
            const double r = std::max((stock * v - q * k * u) / (v + q * k), -u);
            stock = std::min(stock, r);
            if (pressed) control.record(n, r, std::max(k * (r + u), 0.0) * 0.5 / v);
            if (n >= 30 && n < 70) max = std::max(max, r); // at the ends of a stroke the press begins and ends
            lowest = std::min(lowest, r);
        }
        if (max <= limit) return {stroke, lowest};
    }
    return {100, lowest};
}

TEST(ForceControl, TakesFewerStrokesThanTheSpringAndNeverGrindsTooDeep)
{
    // In stock a tenth to four times as soft as in the job, low and high.
    job::Job job;
    for (const double yields : {0.1, 0.5, 1.0, 4.0})
        for (const double high : {0.2, 1.0}) {
            const double q = yields * job.removal_coefficient / job.wheel.width, limit = 0.05;
            const auto [with, lowest] = strokes_by_force(job, q, high, limit, true);
            const auto [without, spring] = strokes_by_force(job, q, high, limit, false);
            EXPECT_GE(lowest, 0) << yields << " " << high;
            EXPECT_GE(spring, 0);
            EXPECT_LE(with, without);
            if (without > 3) {
                EXPECT_LT(with, without) << yields << " " << high;
            }
        }
}

TEST(ForceControl, TakesFewerStrokesWhereTheLawIsKnown)
{
    job::Job job;
    for (const double error : {0.95, 1.0, 1.05}) {
        const double q = error * job.removal_coefficient / job.wheel.width, limit = 0.05;
        const strategy::KnownRemoval known{.coefficient_sigma = 0.05};
        const auto [taught, lowest] = strokes_by_force(job, q, 1.0, limit, true, known);
        const auto [untaught, ignored] = strokes_by_force(job, q, 1.0, limit, true);
        EXPECT_LT(taught, untaught) << error;
        EXPECT_GE(lowest, 0) << error;
    }
}

TEST(ForceControl, SetsTheForceByTheEstimatedRate)
{
    job::Job job;
    const double limit = 0.05, q = job.removal_coefficient / job.wheel.width;
    strategy::ForceControl control(job, limit);
    control.begin_pass({0, 0.5, 1, 1.5});
    EXPECT_EQ(control.next_force_offset(0, 1), 0); // nothing is known
    for (const int n : {0, 1, 2, 3}) control.record(n, 0.4, 1);
    EXPECT_EQ(control.next_force_offset(2, -1), 0); // of q, nothing
    for (const int n : {2, 1, 0}) control.record(n, 0.3, 0.1 * 0.5 / q);
    // Forth again: not more than by the share of q that is sure, and growing no faster than the wheel follows.
    const double u = control.next_force_offset(1, 1);
    EXPECT_GT(u, 0);
    EXPECT_LE(u, 0.5 * limit / std::sqrt(2 * job.wheel.radius * limit) + 1e-12);
    control.begin_pass({0, 0.5, 1, 1.5});
    EXPECT_EQ(control.next_force_offset(1, 1), 0);
}

TEST(ForceControl, TakesWhatTheLastPassTaughtNearby)
{
    // The last pass met stock four times as soft as in the job. Where it was, this one begins with less force; far from
    // it, with that of the learnt law.
    const job::Job job;
    const double limit = 0.05, q = job.removal_coefficient / job.wheel.width;
    const auto first_offset = [&](bool taught, double start) {
        strategy::ForceControl control(job, limit, strategy::KnownRemoval{.coefficient_sigma = 0.05});
        if (taught) {
            control.begin_pass({0, 0.5, 1, 1.5});
            for (const int n : {0, 1, 2, 3}) control.record(n, 0.4, 1);
            for (const int n : {2, 1, 0}) control.record(n, 0.3, 0.1 * 0.5 / (4 * q));
        }
        control.begin_pass({start, start + 5});
        for (const int n : {0, 1}) control.record(n, 0.2, 1);
        return control.next_force_offset(0, -1);
    };
    EXPECT_GT(first_offset(false, 0), 0);
    EXPECT_LT(first_offset(true, 0), 0.5 * first_offset(false, 0));
    EXPECT_EQ(first_offset(true, 100), first_offset(false, 100));
}

TEST(WheelWear, LearnsAndStaysCautious)
{
    job::Job job;
    strategy::WheelWear wear(job, 0.05);
    wear.set_measured_radius(25);
    wear.add_force(20, 10);
    EXPECT_EQ(wear.loss(), 0);       // nothing learned yet
    wear.set_measured_radius(24.98); // 0.02 mm by 200 N s
    wear.add_force(10, 10);
    EXPECT_GT(wear.loss(), 0.5 * 0.01);
    EXPECT_LT(wear.loss(), 0.01);
    EXPECT_FALSE(wear.measurement_due());
    wear.add_force(10, 40); // 0.05 mm by now: what the prediction may miss is more than a quarter of 0.05 mm
    EXPECT_TRUE(wear.measurement_due());
    wear.set_measured_radius(24.93);
    EXPECT_FALSE(wear.measurement_due());
    EXPECT_EQ(wear.loss(), 0);
    wear.start_new_wheel();
    wear.set_measured_radius(30); // a new wheel has not grown
    wear.add_force(10, 10);
    EXPECT_NEAR(wear.loss(), 0.7 * 0.01, 1e-9);
}

TEST(WheelWear, KnowsWhatFormerRunsTaught)
{
    job::Job job;
    const double circle = 2 * std::numbers::pi * job.wheel.radius * job.wheel.width, c = job.removal_coefficient;
    const strategy::KnownRemoval known{
        .coefficient_sigma = 0.03, .removed_volume = 600, .lost_volume = 10, .wear_sigma = 0.04};
    strategy::WheelWear wear(job, 0.05, known);
    EXPECT_TRUE(wear.is_known());
    wear.set_measured_radius(job.wheel.radius);
    wear.add_force(20, 10);
    EXPECT_NEAR(wear.expected_loss(), 200 * c / 60 / circle, 1e-12);
    EXPECT_NEAR(wear.loss(), 0.95 * wear.expected_loss(), 1e-12);
    // A quarter of what may remain for an error of a twentieth: due at five times that.
    const double impulse_due = 5 * 0.05 * circle * 60 / c;
    wear.add_force(1, 0.99 * impulse_due - 200);
    EXPECT_FALSE(wear.measurement_due());
    wear.add_force(1, 0.02 * impulse_due);
    EXPECT_TRUE(wear.measurement_due());
}

} // namespace feed_control_test
