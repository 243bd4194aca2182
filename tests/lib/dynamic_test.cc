// Drives and the dynamic gantry against closed forms, Runge-Kutta, identities and the quasi-static gantry.

#include "gantry_stock.h"

#include "core/error.h"
#include "gantry/dynamic.h"
#include "gantry/force_tuning.h"
#include "gantry/quasi_static.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>

using namespace fettle;

namespace dynamic_test {

gantry::Drive drive() { return drive_of_80_kg(1); }

gantry::Machine machine()
{
    gantry::Machine machine;
    machine.axes = {drive(), drive(), drive()};
    machine.axes[2].load = 30;
    machine.c = drive();
    machine.c.mass = 0.01;
    machine.c.speed = machine.c.acceleration = 1;
    machine.head = {.damping = 0, .travel = 15, .lvdt = 1e-6, .noise = 0, .stiffness = 400};
    machine.spindle = {.speed = 500, .power = 1e8, .inertia = 10, .tangential = 0, .side = 0};
    return machine;
}

gantry::DynamicOptions no_wear()
{
    gantry::DynamicOptions options;
    options.grinding_ratio = 1e15;
    return options;
}

TEST(ExactStep, FreeDriveUnderAStep)
{
    // m v' + d v = f: v = f/d (1 − e^(−t/τ)), p = f/d (t − τ (1 − e^(−t/τ))); under f = rate t the integral of that.
    const double m = 0.08, d = 1.5, tau = m / d, f = 20;
    const gantry::ExactStep step({m, d, 0}, 1e-3);
    gantry::Motion constant, ramp;
    for (int n = 1; n <= 500; ++n) {
        constant = step(constant, f, 0);
        ramp = step(ramp, f * (n - 1) * 1e-3, f);
        const double t = n * 1e-3, rise = 1 - std::exp(-t / tau), p = f / d * (t - tau * rise);
        EXPECT_NEAR(constant.v, f / d * rise, 1e-12 * f / d);
        EXPECT_NEAR(constant.p, p, 1e-12);
        EXPECT_NEAR(ramp.v, p, 1e-12);
        EXPECT_NEAR(ramp.p, f / d * (t * t / 2 - tau * t + tau * tau * rise), 1e-12);
    }
}

TEST(ExactStep, SpringUnderAStep)
{
    // Under-damped: p = f/k (1 − e^(−σt) (cos ωt + σ/ω sin ωt)); over-damped by the same formula with complex ω.
    for (const double d : {1.5, 8.0}) {
        const double m = 0.08, k = 35, f = 60, sigma = d / (2 * m);
        const std::complex<double> w = std::sqrt(std::complex<double>(k / m - sigma * sigma));
        const gantry::ExactStep step({m, d, k}, 1e-3);
        gantry::Motion x;
        for (int n = 1; n <= 500; ++n) {
            x = step(x, f, 0);
            const double t = n * 1e-3;
            const std::complex<double> wave = std::cos(w * t) + sigma / w * std::sin(w * t);
            EXPECT_NEAR(x.p, f / k * (1 - std::exp(-sigma * t) * wave.real()), 1e-12);
        }
    }
}

/// Acceleration of Wang's equation 6-7, of p, v, the voltage and the spring's other end.
struct Equation {
    gantry::Drive drive;
    double preload, k, b;
    double operator()(double p, double v, double voltage, double end, double rate) const
    {
        const double spring = preload + k * (end - p) + b * (rate - v);
        return (drive.gain * voltage - drive.load + spring - drive.damping * v) / drive.mass;
    }
};

/// Runge and Kutta, fourth order, ten steps to a period.
gantry::Motion runge_kutta(const Equation& equation, gantry::Motion x, double voltage, double end, double rate,
                           double period)
{
    const double h = period / 10;
    for (int n = 0; n < 10; ++n) {
        const auto slope = [&](double dt, const gantry::Motion& at) {
            return gantry::Motion{at.v, equation(at.p, at.v, voltage, end + rate * (n * h + dt), rate)};
        };
        const auto on = [&](double dt, const gantry::Motion& s) {
            return gantry::Motion{x.p + dt * s.p, x.v + dt * s.v};
        };
        const gantry::Motion a = slope(0, x), b = slope(h / 2, on(h / 2, a)), c = slope(h / 2, on(h / 2, b)),
                             d = slope(h, on(h, c));
        x = {x.p + h / 6 * (a.p + 2 * b.p + 2 * c.p + d.p), x.v + h / 6 * (a.v + 2 * b.v + 2 * c.v + d.v)};
    }
    return x;
}

TEST(ServoAxis, TenTimesFinerRungeKuttaAgrees)
{
    // The loop at work for two seconds against the spring, whose end rises and falls: 1e-6 of the largest of each.
    gantry::Drive weighted = drive();
    weighted.load = 30;
    const Equation equation{weighted, 5, 35, 0.8};
    gantry::ServoAxis axis(weighted, equation.k, equation.b, 1e-3, 20);
    gantry::Motion x = axis.motion();
    double end = 21, difference = 0, rate_difference = 0, longest = 0, fastest = 0;
    for (int n = 0; n < 2000; ++n) {
        const double t = n * 1e-3, rate = 3 * std::cos(7 * t);
        const gantry::Reference reference{20 + std::sin(3 * t), 3 * std::cos(3 * t), -9 * std::sin(3 * t)};
        axis.step_with_spring(reference, equation.preload, end, rate);
        x = runge_kutta(equation, x, axis.voltage(), end, rate, 1e-3);
        end += rate * 1e-3;
        difference = std::max(difference, std::abs(x.p - axis.motion().p));
        rate_difference = std::max(rate_difference, std::abs(x.v - axis.motion().v));
        longest = std::max(longest, std::abs(x.p - 20));
        fastest = std::max(fastest, std::abs(x.v));
    }
    EXPECT_GT(longest, 0.9);
    EXPECT_LT(difference, 1e-6 * longest);
    EXPECT_LT(rate_difference, 1e-6 * fastest);
}

TEST(ServoAxis, FollowsWithinCountsAndHoldsAgainstALoad)
{
    const gantry::Drive of = drive();
    gantry::ServoAxis axis(of, 0, 0, 1e-3, 0);
    double worst = 0;
    for (int n = 0; n < 3000; ++n) { // feed-forward is the inverse of the drive: what is left are counts
        const double t = n * 1e-3;
        axis.step({20 * std::sin(2 * t), 40 * std::cos(2 * t), -80 * std::sin(2 * t)}, 0);
        if (n > 500) worst = std::max(worst, std::abs(axis.motion().p - 20 * std::sin(2 * (t + 1e-3))));
    }
    EXPECT_LT(worst, 20 * of.encoder);
    const double there = axis.motion().p;
    for (int n = 0; n < 3000; ++n) axis.step({there, 0, 0}, -60); // the integral takes it up
    EXPECT_NEAR(axis.motion().p, there, 2 * of.encoder);
    EXPECT_NEAR(of.gain * axis.voltage(), 60, 20);
}

/// Does the loop come to rest if the drive is `factor` times as strong as the controller thinks? A loop of our own,
/// without limits and counts.
bool stable(const gantry::Drive& drive, const gantry::ServoGains& gains, const gantry::Oscillator& load, double factor,
            double period)
{
    const gantry::ExactStep step(load, period);
    gantry::Motion x{1, 0};
    double integral = 0, last = -1, late = 0;
    for (int n = 0; n < 20000; ++n) {
        const double error = -x.p;
        integral += gains.ki * error * period;
        const double u = gains.kp * error + integral + gains.kd * (error - last) / period;
        last = error;
        x = step(x, factor * drive.gain * u, 0);
        if (!std::isfinite(x.p)) return false;
        if (n >= 19000) late = std::max(late, std::abs(x.p));
    }
    return late < 1e-3;
}

TEST(Tuning, HoldsItsMargins)
{
    // A sensitivity peak of 1.5 promises a gain margin of 3 upwards (and 1/(1 + 1/1.5) = 0.6 downwards).
    for (const double encoder : {0.00005, 0.0005, 0.005})
        for (const double k : {0.0, 35.0}) {
            gantry::Drive of = drive();
            of.encoder = encoder;
            const gantry::ServoGains gains = gantry::tune_servo(of, k, 0.5, 1e-3);
            const gantry::Oscillator free{of.mass, of.damping, 0}, sprung{of.mass, of.damping + 0.5, k};
            EXPECT_GT(gains.bandwidth, 10);
            for (const gantry::Oscillator& load : {free, sprung}) {
                EXPECT_TRUE(stable(of, gains, load, 2.99, 1e-3));
                EXPECT_TRUE(stable(of, gains, load, 0.61, 1e-3));
                const gantry::Margins margins =
                    gantry::servo_response(of, load, 1e-3, gantry::kMarginFrequencies).margins(gains);
                EXPECT_LE(margins.sensitivity, gantry::kMaxSensitivity + 1e-3); // searched at fewer frequencies
                EXPECT_GE(margins.gain, 3);
                EXPECT_GE(margins.phase, 2 * std::asin(1 / (2 * gantry::kMaxSensitivity)));
                EXPECT_TRUE(stable(of, gains, load, 0.97 * margins.gain, 1e-3));
                EXPECT_FALSE(stable(of, gains, load, 1.03 * margins.gain, 1e-3));
            }
            EXPECT_FALSE(stable(of, gains, free, 400, 1e-3));
        }
    gantry::Drive coarse = drive();
    coarse.encoder = 20;
    EXPECT_THROW(gantry::tune_servo(coarse, 0, 0, 1e-3), core::InputError);
}

TEST(ForceLoop, HoldsItsMarginsAndTheForceOnASlope)
{
    const gantry::Drive of = drive();
    const gantry::ServoGains servo = gantry::tune_servo(of, 35, 0.5, 1e-3);
    const gantry::Pid gains = gantry::tune_force(of, 35, 0.5, 1e-3);
    EXPECT_GT(gains.kp, 20);
    for (const gantry::Oscillator& load :
         {gantry::Oscillator{of.mass, of.damping, 0}, gantry::Oscillator{of.mass, of.damping + 0.5, 35}}) {
        const gantry::Margins margins = gantry::force_response(of, servo, load, 1e-3).margins(gains);
        EXPECT_LE(margins.sensitivity, gantry::kMaxSensitivity);
        EXPECT_GE(margins.gain, 3);
        EXPECT_GE(margins.phase, 2 * std::asin(1 / (2 * gantry::kMaxSensitivity)));
    }
    // A controller at 25 Hz holds the drive, but not the force.
    EXPECT_GT(gantry::tune_servo(of, 35, 0.5, 0.04).bandwidth, 0);
    EXPECT_THROW(gantry::tune_force(of, 35, 0.5, 0.04), core::InputError);
    // Up a slope that nothing grinds: the integral leaves no error.
    job::Job job = small_job();
    job.removal_coefficient = 1e-6;
    const auto slope = [](double, double y) { return kTop + 0.2 * y; };
    gantry::DynamicGantry gantry(stock(slope), job, machine(), no_wear());
    gantry.travel({0, -40, kTop});
    gantry::GantryStatus status;
    for (double y = -39.5; y < 20; y += 0.5) {
        status = gantry.press({0, y, -100}, 25, 40);
        if (y > -20) {
            EXPECT_NEAR(status.force, 40, 1) << y;
        }
    }
    EXPECT_NEAR(status.commanded.y(), 20, 0.6);
    EXPECT_NEAR(status.time, 0, 10);
    gantry.lift(kTop + 10); // 16 is above the stock, and it stops there
    EXPECT_EQ(gantry.press({0, 21, kTop + 6}, 25, 40).force, 0);
    EXPECT_NEAR(gantry.status().commanded.z(), kTop + 6, 0.1);
}

TEST(ReadMachine, DrivesOfTheSamplesObeyWang)
{
    // Driven by V without a load the screw turns at N K_m/R_m V / (B + N² K_m²/R_m) (eq. 6-1, the motor's brake in B);
    // a force f at the nut holds against a torque f / (η K_b) of the screw (6-2).
    const gantry::Machine m = gantry::read_machine(std::getenv("SAMPLES") + std::string("/machines/prototype.json"));
    const double km = 0.056, r = 1.1, b = 1e-4, k_b = 2 * std::numbers::pi / 5.0, eta = 0.9; // pitch 0.19685 in ≈ 5 mm
    const gantry::Drive& x = m.axes[0];
    EXPECT_NEAR(x.gain / x.damping, km / r / (b + km * km / r) / k_b, 1e-5 * x.gain / x.damping);
    EXPECT_NEAR(x.gain, km / r * 1000 * eta * k_b, 1e-5 * x.gain);
    EXPECT_NEAR(x.mass / x.damping, 4e-5 / (b + km * km / r), 1e-12);
    EXPECT_NEAR(x.emf, km * k_b, 1e-5 * x.emf); // V s = N m/A
    EXPECT_NEAR(x.encoder, 0.0025, 1e-7);
    EXPECT_NEAR(m.axes[2].load, 0.027e3 * eta * k_b, 1e-3);
    EXPECT_NEAR(m.spindle.power, 35e3, 1e-9);
}

TEST(Dynamic, MovesTakeTheTimeOfTrapezoids)
{
    gantry::DynamicGantry gantry(flat(), small_job(), machine());
    EXPECT_EQ(gantry.status().time, 0);
    const double v = 100, a = 1000;
    const gantry::GantryStatus down = gantry.lift(15); // 15 mm, guarded: √(F_max a / k) = 41.4 mm/s
    const double touching = std::sqrt(60 * a / 35);
    EXPECT_NEAR(down.time, 15 / touching + touching / a, 0.03);
    const gantry::GantryStatus up = gantry.lift(30);
    EXPECT_NEAR(up.time - down.time, 15 / v + v / a, 0.03);
    const gantry::GantryStatus across = gantry.travel({5, -50, 30});
    EXPECT_NEAR(across.time - up.time, std::hypot(5, 50) / v + v / a, 0.03);
    EXPECT_NEAR((across.commanded - Eigen::Vector3d(5, -50, 30)).norm(), 0, 0.003);
    EXPECT_NEAR(gantry.totals().travel_time, across.time, 1e-9);
    EXPECT_EQ(gantry.totals().removed_volume, 0);
}

TEST(Dynamic, TurnsItsHeadFirst)
{
    job::Job job = small_job();
    job.theta = -2; // rad, at 1 rad/s and 1 rad/s²
    gantry::DynamicGantry gantry(stock(hills, 0.2, -2), job, machine());
    EXPECT_NEAR(gantry.status().time, 3, 0.05);
    gantry::Machine narrow = machine();
    narrow.c.min_position = -1;
    EXPECT_THROW(gantry::DynamicGantry(flat(), job, narrow), core::InputError);
}

/// One pass over hills at `feed`.
template <class AnyGantry>
removal::HeightField ground(AnyGantry&& gantry, double feed)
{
    gantry.travel({0, -20, 8.3});
    for (double y = -19.5; y < 20.01; y += 0.5) gantry.grind({0, y, 8.3}, feed);
    return gantry.stock();
}

TEST(Dynamic, AgreesWithTheQuasiStaticWhereFeedGoesToZero)
{
    // What differs falls with the feed: removal by the normal or the vertical force, corners, where contacts fall.
    double last = 1e9;
    for (const double feed : {8.0, 2.0, 0.5}) {
        gantry::QuasiStaticOptions quasi;
        quasi.grinding_ratio = 1e15;
        const removal::HeightField a = ground(gantry::QuasiStaticGantry(stock(hills, 0.2), small_job(), quasi), feed);
        const removal::HeightField b =
            ground(gantry::DynamicGantry(stock(hills, 0.2), small_job(), machine(), no_wear()), feed);
        const Eigen::ArrayXXd inside = (a.z - b.z).block(10, 260, 60, 180);
        const double difference = inside.abs().maxCoeff();
        EXPECT_LT(difference, last / 2) << feed;
        last = difference;
    }
    EXPECT_LT(last, 0.005);
}

TEST(Dynamic, SteadyDepthIsTheBalance)
{
    // As for the quasi-static gantry: t v w = c F, F = preload + k (D − t); by the normal force it is t F / cos φ, a
    // mean slope of √(2 t / R) / 2 of its rim in the cut.
    job::Job job = small_job();
    job.force.preload = 5;
    job.force.max = 1e9;
    gantry::DynamicGantry gantry(flat(), job, machine(), no_wear());
    const double v = 25.4, w = 6.4, c = job.removal_coefficient, k = job.force.stiffness, depth = 0.4;
    gantry.travel({0, -40, kTop - depth});
    gantry::GantryStatus end;
    for (double y = -39.5; y < 40.1; y += 0.5) end = gantry.grind({0, y, kTop - depth}, v);
    const double t = c * (5 + k * depth) / (v * w + c * k);
    EXPECT_NEAR(kTop - gantry.stock().z(80, 700), t, 0.01 * t);
    EXPECT_NEAR(end.force, 5 + k * (depth - t), 0.02 * end.force);
    EXPECT_NEAR(gantry.totals().grinding_time, 80 / v, 0.05);
}

TEST(Dynamic, VolumeIsNormalForceTimesTimeAtAWall)
{
    // A wall higher than the wheel's axis meets its rim where that is upright: all of the force is across the spring,
    // and bends the machine. Removed volume = c ∫ F dt, but for a row that remains (0.05 mm
    // of at most 13 mm above the rim) and 2 % for rows that are not quite upright.
    const auto wall = [](double, double y) { return y < 0 ? kTop - 5 : kTop + 30; };
    job::Job job = small_job();
    job.safe_height = kTop + 40;
    gantry::DynamicGantry gantry(stock(wall, 0.05), job, machine(), no_wear());
    gantry.travel({0, -30, kTop});
    double impulse = 0;
    for (double y = -29.98; y < -24; y += 0.02) {
        const double t = gantry.status().time;
        const gantry::GantryStatus status = gantry.grind({0, y, kTop}, 5);
        impulse -= gantry.side_load().y() * (status.time - t);
    }
    EXPECT_GT(gantry.totals().removed_volume, 50);
    const double volume = gantry.totals().removed_volume;
    EXPECT_NEAR(volume, 7.4 * impulse, 0.02 * volume + 0.05 * 6.4 * 13);
}

TEST(Dynamic, DamperLetsTheHeadDownByItsTimeConstant)
{
    // The stock ends under the pressed wheel: its deflection decays as e^(−k t / b). First order in the time between
    // two contacts, 8 ms of 200 ms.
    gantry::Machine damped = machine();
    damped.head.damping = 7;
    job::Job job = small_job();
    job.removal_coefficient = 1e-6;
    const auto edge = [](double, double y) { return y < 0 ? kTop : kTop - 20; };
    gantry::DynamicGantry gantry(stock(edge), job, damped, no_wear());
    gantry.travel({0, -5, kTop - 1});
    gantry.grind({0, 8, kTop - 1}, 25.4); // off the edge, whose corner the rim leaves at 7.06
    const gantry::GantryStatus a = gantry.grind({0, 10, kTop - 1}, 25.4), b = gantry.grind({0, 13, kTop - 1}, 25.4);
    EXPECT_GT(b.deflection, 0.1);
    EXPECT_NEAR(std::log(a.deflection / b.deflection), (b.time - a.time) * 35 / 7, 0.03 * (b.time - a.time) * 35 / 7);
}

TEST(Dynamic, TheWayDownIsGuarded)
{
    gantry::DynamicGantry gantry(flat(), small_job(), machine());
    const gantry::GantryStatus status = gantry.travel({0, 0, kTop - 5});
    EXPECT_GT(status.force, 40);
    EXPECT_LT(status.peak_force, 62);
    EXPECT_GT(status.commanded.z(), kTop - 5);
}

TEST(Dynamic, TravelsLowOnTheSameWayDown)
{
    gantry::DynamicGantry high(flat(), small_job(), machine()), low(flat(), small_job(), machine());
    for (gantry::DynamicGantry* gantry : {&high, &low}) gantry->travel({0, -20, kTop + 1});
    const double begun = low.status().time;
    const gantry::GantryStatus a = high.travel({0, 20, kTop - 5}),
                               b = low.travel_low({0, 20, kTop - 5}, kTop + 2, kTop + 1);
    EXPECT_LT(b.time - begun, 0.6 * (a.time - begun));
    EXPECT_LT(b.peak_force, 62);
    EXPECT_NEAR(b.force, a.force, 2);
}

// At any moment of a cut, of the way down and of the way across: the wheel is off the part 0.25 s later, and what
// follows is as it ever is.
TEST(Dynamic, IsStoppedAtAnyMoment)
{
    for (int n = 0; n < 60; ++n) {
        gantry::DynamicGantry gantry(flat(), small_job(), machine());
        gantry.travel({0, -20, kTop});
        const double begun = gantry.status().time, moment = 0.03 * n;
        double asked = 0;
        gantry.set_interrupt([&](const gantry::GantryStatus& now) {
            asked = now.time;
            return now.time >= begun + moment;
        });
        bool interrupted = false;
        try {
            for (double y = -19.5; y < 20; y += 0.5) gantry.grind({0, y, kTop - 0.8}, 25.4);
            gantry.travel({3, 0, kTop - 0.8});
        } catch (const gantry::Interrupted&) {
            interrupted = true;
        }
        ASSERT_TRUE(interrupted) << n;
        EXPECT_NEAR(asked, begun + moment, 0.0011) << n;
        const gantry::GantryStatus free = gantry::retract(gantry, small_job().safe_height);
        EXPECT_EQ(free.force, 0) << n;
        EXPECT_LE(free.time - asked, 0.25) << n;
        EXPECT_LT(free.peak_force, 60) << n;
        EXPECT_NEAR(gantry.lift(30).commanded.z(), 30, 3 * drive().encoder) << n; // a move ends within three counts
        EXPECT_NEAR(gantry.travel({1, 2, kTop + 1}).commanded.x(), 1, 0.01) << n;
    }
}

TEST(Dynamic, SensorsHaveTheirResolution)
{
    gantry::Machine coarse = machine();
    coarse.head.lvdt = 0.125;
    coarse.head.noise = 0.05;
    const auto run = [&](std::uint64_t seed) {
        gantry::DynamicOptions options;
        options.seed = seed;
        gantry::DynamicGantry gantry(flat(), small_job(), coarse, options);
        gantry.travel({0, -20, kTop - 0.8});
        std::vector<double> read;
        for (double y = -19.5; y < 20; y += 0.5) read.push_back(gantry.grind({0, y, kTop - 0.8}, 25.4).deflection);
        return read;
    };
    const std::vector<double> one = run(1);
    for (const double deflection : one) EXPECT_EQ(std::fmod(deflection, 0.125), 0);
    EXPECT_EQ(one, run(1));
    EXPECT_NE(one, run(2));
}

/// Message of the machine when it stops, cutting 1 mm deep.
std::string fault_of(const gantry::Machine& machine, double depth = 1)
{
    try {
        job::Job job = small_job();
        job.force.max = 1e9;
        gantry::DynamicGantry gantry(flat(), job, machine);
        gantry.travel({0, -20, kTop - depth});
        for (double y = -19.5; y < 20; y += 0.5) gantry.grind({0, y, kTop - depth}, 25.4);
    } catch (const gantry::GantryFault& fault) {
        return fault.what();
    }
    return "";
}

TEST(Dynamic, StopsForGood)
{
    EXPECT_EQ(fault_of(machine()), "");
    gantry::Machine weak = machine();
    weak.spindle.tangential = 0.4;
    weak.spindle.inertia = 0.01;
    weak.spindle.power = 1e8;
    EXPECT_EQ(fault_of(weak), "");
    weak.spindle.power = 1e4;
    EXPECT_NE(fault_of(weak).find("the spindle stalls"), std::string::npos);
    gantry::Machine tight = machine();
    tight.axes[1].following_error = 0.001;
    EXPECT_NE(fault_of(tight).find("axis y"), std::string::npos);
    gantry::Machine shallow = machine();
    shallow.head.travel = 0.3;
    EXPECT_NE(fault_of(shallow).find("travel"), std::string::npos);
    gantry::Machine small = machine();
    small.axes[1].min_position = -10;
    EXPECT_THROW(fault_of(small), core::InputError);
}

} // namespace dynamic_test
