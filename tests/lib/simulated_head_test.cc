// The head that a controller leads, against the quasi-static gantry and closed forms.

#include "gantry_stock.h"

#include "core/error.h"
#include "gantry/quasi_static.h"
#include "gantry/simulated_head.h"
#include "own_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

using namespace fettle;

namespace simulated_head_test {

constexpr double kPeriod = 1e-3; // of the controller, s

/// Leads it in a straight line, period by period.
void lead(gantry::SimulatedHead& head, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed)
{
    const int periods = static_cast<int>(std::ceil((to - from).norm() / speed / kPeriod));
    for (int n = 1; n <= periods; ++n)
        head.step(from + (to - from) * n / periods, kPeriod, gantry::SimulatedHead::Tool::wheel, {});
}

/// Down beside the hills, over them, and up, along Y_w (or X_w). The stock in the end.
removal::HeightField led(const job::Job& job, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
    gantry::SimulatedHead head(gantry::head_and_stock(stock(hills), job));
    const Eigen::Vector3d up(0, 0, 5);
    lead(head, from + up, from, 20);
    lead(head, from, to, job.feed.rate);
    lead(head, to, to + up, 50);
    return head.head().stock;
}

removal::HeightField driven(const job::Job& job, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
    gantry::QuasiStaticOptions options;
    options.lift_speed = 20;
    gantry::QuasiStaticGantry gantry(stock(hills), job, options);
    gantry.travel(from);
    constexpr int kSteps = 100;
    for (int n = 1; n <= kSteps; ++n) gantry.grind(from + (to - from) * n / kSteps, job.feed.rate);
    gantry.lift(20);
    return gantry.stock();
}

double largest_difference(const removal::HeightField& a, const removal::HeightField& b)
{
    return (a.z - b.z).abs().maxCoeff();
}

TEST(SimulatedHead, GrindsWhatTheQuasiStaticGantryGrinds)
{
    // Both paths begin and end beside the hills. Both cut what the rim does not leave between places two cells apart:
    // ridges of (0.2 mm)² / 8R = 2e-4 mm. Along the axis a sub-step is two columns of 64.
    job::Job job = small_job();
    job.force.max = 1e9;
    EXPECT_LT(largest_difference(led(job, {0, -30, 8}, {0, 30, 8.9}), driven(job, {0, -30, 8}, {0, 30, 8.9})), 2e-3);
    EXPECT_LT(largest_difference(led(job, {-12, 0, 9}, {12, 0, 9}), driven(job, {-12, 0, 9}, {12, 0, 9})), 1e-2);
}

TEST(SimulatedHead, WaitsAtRestUntilTheWheelIsOnItsStop)
{
    // Pressed on one place it grinds until nothing touches it: no force is left, and no more than the wheel is removed.
    job::Job job = small_job();
    gantry::SimulatedHead head(gantry::head_and_stock(flat(), job));
    for (int n = 0; n < 20000; ++n) head.step({0, 0, kTop - 0.3}, kPeriod, gantry::SimulatedHead::Tool::wheel, {});
    EXPECT_LT(head.force(), 0.01);
    EXPECT_NEAR(head.head().stock.z.minCoeff(), kTop - 0.3, 1e-3);
}

TEST(SimulatedHead, TouchesWithoutGrinding)
{
    job::Job job = small_job();
    gantry::SimulatedHead head(gantry::head_and_stock(stock(hills), job));
    const double surface = hills(1, 2);
    head.step({1, 2, surface + 0.1}, kPeriod, gantry::SimulatedHead::Tool::probe, {});
    EXPECT_EQ(head.deflection(), 0);
    head.step({1, 2, surface - 0.1}, kPeriod, gantry::SimulatedHead::Tool::probe, {});
    EXPECT_NEAR(head.deflection(), 0.1, 1e-4); // the hills bend by less between two cells
    EXPECT_NEAR(head.force(), job.force.stiffness * 0.1, 0.01);
    EXPECT_EQ(largest_difference(head.head().stock, stock(hills)), 0);
}

TEST(SimulatedHead, TouchOffMeasuresTheWheelsRadius)
{
    job::Job job = small_job();
    gantry::SimulatedHead head(gantry::head_and_stock(flat(), job));
    const gantry::Plate plate{{-40, 0, 12}, 5};
    lead(head, {0, -40, kTop - 1}, {0, 40, kTop - 1}, 5); // it wears
    ASSERT_LT(head.radius(), job.wheel.radius);
    head.step({-40, 1, 12 - 0.5}, kPeriod, gantry::SimulatedHead::Tool::wheel, plate);
    EXPECT_NEAR(head.deflection(), 0.5 - (job.wheel.radius - head.radius()), 1e-12);
    head.renew_wheel();
    EXPECT_EQ(head.radius(), job.wheel.radius);
}

TEST(SimulatedHead, IsTheSameFromAFile)
{
    const OwnFolder folder;
    const std::string path = "head";
    const gantry::HeadAndStock head = gantry::head_and_stock(stock(hills, 0.1, 0.3), small_job());
    {
        std::ofstream out(path, std::ios::binary);
        gantry::write_head(out, head);
    }
    const gantry::HeadAndStock again = gantry::read_head(path);
    EXPECT_TRUE((again.stock.z == head.stock.z).all());
    EXPECT_EQ(again.stock.origin, head.stock.origin);
    EXPECT_EQ(again.stock.theta, 0.3);
    EXPECT_EQ(again.spring.stiffness, head.spring.stiffness);
    EXPECT_EQ(again.removal, head.removal);
    EXPECT_EQ(again.grinding_ratio, head.grinding_ratio);
    EXPECT_THROW(gantry::read_head("nowhere"), core::InputError);
}

} // namespace simulated_head_test
