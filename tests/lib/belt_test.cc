// Grinding along a path: the law's integral, refinement, and what must not change.

#include "belt/belt_grinding.h"
#include "cloud/poses.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace fettle;

namespace belt_test {

using Eigen::Index;

constexpr double kSpacing = 0.5, kLength = 80, kWidth = 30; // mm
constexpr double kForce = 20, kFeed = 40;

/// A plate in z = 0; its stock's surface is tilted by `slope` along y about x.
belt::Surfels plate(double slope = 0)
{
    const auto rows = static_cast<Index>(kLength / kSpacing), columns = static_cast<Index>(kWidth / kSpacing);
    belt::Surfels surfels;
    surfels.position.resize(3, rows * columns);
    surfels.normal.resize(3, rows * columns);
    for (Index j = 0; j < columns; ++j)
        for (Index i = 0; i < rows; ++i) {
            const Index k = j * rows + i;
            surfels.position.col(k) << (double(i) + 0.5) * kSpacing - kLength / 2,
                (double(j) + 0.5) * kSpacing - kWidth / 2, 0;
            surfels.normal.col(k) = Eigen::Vector3d(0, -slope, 1).normalized();
        }
    surfels.radius.setConstant(surfels.size(), kSpacing);
    surfels.displacement.setConstant(surfels.size(), 0.2);
    surfels.uv.setZero(2, surfels.size());
    surfels.patch.setZero(surfels.size());
    return surfels;
}

belt::ContactWheel crowned()
{
    belt::ContactWheel wheel;
    wheel.radius = 100;
    wheel.width = 50;
    wheel.crown_radius = 60;
    wheel.layer = {10, 5, 0.45};
    wheel.belt_speed = 15000;
    wheel.law.coefficient = 1e-7;
    return wheel;
}

/// Along x through the middle, from -20 to 20 mm.
std::vector<belt::BeltPoint> line(double step)
{
    std::vector<belt::BeltPoint> path;
    const int count = static_cast<int>(std::lround(40 / step));
    for (int k = 0; k <= count; ++k) {
        belt::BeltPoint point{Eigen::Isometry3d::Identity(), {true, kForce}, kFeed, 0};
        point.T_part_tool.translation() << -20 + step * k, 0.13, 0;
        path.push_back(point);
    }
    return path;
}

double volume(const Eigen::VectorXd& removed) { return removed.sum() * kSpacing * kSpacing; }

TEST(Belt, RemovesWhatTheLawSays)
{
    belt::Surfels surfels = plate();
    const belt::Surfels before = surfels;
    const belt::ContactWheel wheel = crowned();
    const belt::BeltRun run = belt::grind(surfels, wheel, line(0.5), {});
    // Preston's law is linear in p: C V_b F t, for any distribution of the pressure.
    const double law = wheel.law.coefficient * wheel.belt_speed * kForce * 40 / kFeed;
    EXPECT_NEAR(run.trace.back().time, 40 / kFeed, 1e-9);
    EXPECT_NEAR(run.removed_volume, law, 1e-5 * law);
    EXPECT_NEAR(volume(run.removed), law, 1e-3 * law);
    EXPECT_LE((before.displacement - surfels.displacement - run.removed).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_GE(run.removed.minCoeff(), 0);
    // Beyond the contact's width nothing changes.
    for (Index i = 0; i < surfels.size(); ++i)
        if (std::abs(surfels.position(1, i)) > 12) {
            EXPECT_EQ(surfels.displacement[i], 0.2);
        }
}

/// A law that takes 0.2 mm/MPa in 2 mm of slow_line(), where the layer yields about 0.1 mm/MPa to a ripple of two
/// surfels' length: with the pressure at the beginning of each step the ripple grows.
belt::ContactWheel fast()
{
    belt::ContactWheel wheel = crowned();
    wheel.law.coefficient = 3e-5;
    return wheel;
}

/// The line at a feed at which a fast law takes a good part of a millimetre.
std::vector<belt::BeltPoint> slow_line(double step)
{
    std::vector<belt::BeltPoint> path = line(step);
    for (belt::BeltPoint& point : path) point.feed = kFeed / 8;
    return path;
}

// A checkerboard laid on the stock shrinks with Preston's law and with a steeper one: to less than half in a pass.
TEST(Belt, GrindsOffARippleOfTwoSurfels)
{
    constexpr double kAmplitude = 0.02;
    const auto rows = static_cast<Index>(kLength / kSpacing);
    for (const double exponent : {1.0, 2.3}) {
        belt::ContactWheel wheel = fast();
        constexpr double kPressure = 0.15; // MPa, in the middle of the contact: there both laws take the same
        wheel.law.pressure_exponent = exponent;
        wheel.law.coefficient *= std::pow(kPressure, 1 - exponent);
        belt::Surfels surfels = plate();
        for (Index k = 0; k < surfels.size(); ++k)
            surfels.displacement[k] += (k % rows + k / rows) % 2 == 0 ? kAmplitude : -kAmplitude;
        belt::BeltOptions options;
        options.contact.tolerance = 1e-4;
        const belt::BeltRun run = belt::grind(surfels, wheel, slow_line(2), options);
        EXPECT_EQ(run.coarse_grids, 0);
        double ripple = 0;
        const auto height = Eigen::MatrixXd::Map(surfels.displacement.data(), rows, surfels.size() / rows);
        for (Index j = height.cols() / 2 - 4; j < height.cols() / 2 + 4; ++j)
            for (Index i = rows / 2 - 10; i < rows / 2 + 10; ++i)
                ripple = std::max(ripple, std::abs(4 * height(i, j) - height(i - 1, j) - height(i + 1, j) -
                                                   height(i, j - 1) - height(i, j + 1)) /
                                              8);
        EXPECT_LE(ripple, 0.5 * kAmplitude) << exponent;
    }
}

TEST(Belt, DependsNotOnThePathsSpacing)
{
    const belt::ContactWheel wheel = crowned();
    const auto ground = [&](double step) {
        belt::Surfels surfels = plate();
        return belt::grind(surfels, wheel, line(step), {}).removed;
    };
    const Eigen::VectorXd coarse = ground(1), fine = ground(0.5);
    const belt::Surfels where = plate();
    double max = 0, deepest = 0;
    for (Index i = 0; i < where.size(); ++i) {
        if (std::abs(where.position(0, i)) > 8) continue; // away from the path's ends
        max = std::max(max, std::abs(coarse[i] - fine[i]));
        deepest = std::max(deepest, fine[i]);
    }
    EXPECT_LE(max, 0.005 * deepest);
}

// A bead of 3 mm under a fast law: half the distance of the contact points changes the depth by 2 % rms at most.
TEST(Belt, ConvergesOnABead)
{
    const belt::ContactWheel wheel = fast();
    const auto ground = [&](double step) {
        belt::Surfels surfels = plate();
        for (Index k = 0; k < surfels.size(); ++k)
            surfels.displacement[k] = 3 * std::exp(-std::pow(surfels.position(1, k) / 3, 2));
        belt::BeltOptions options;
        options.contact.tolerance = 1e-4;
        return belt::grind(surfels, wheel, slow_line(step), options).removed;
    };
    const Eigen::VectorXd coarse = ground(2), fine = ground(1);
    EXPECT_GE(fine.maxCoeff(), 0.3);
    EXPECT_LE((coarse - fine).norm(), 0.02 * fine.norm());
}

// The depth is normal to the tangent plane: a surfel whose normal leans loses its cosine of it.
TEST(Belt, TakesTheCosineFromLeaningNormals)
{
    const belt::ContactWheel wheel = crowned();
    belt::Surfels level = plate(), leaning = plate(0.1);
    level.displacement.setZero();
    leaning.displacement.setZero();
    const belt::BeltRun a = belt::grind(level, wheel, line(1), {}), b = belt::grind(leaning, wheel, line(1), {});
    EXPECT_NEAR(volume(b.removed) / volume(a.removed), 1 / std::sqrt(1.01), 1e-3);
}

// A break ends a run: no distance is counted across it, and the next contact is a new start.
TEST(Belt, LiftsAtABreak)
{
    const belt::ContactWheel wheel = crowned();
    std::vector<belt::BeltPoint> path = line(1);
    const std::size_t n = path.size();
    belt::BeltPoint off = path.front();
    off.T_part_tool.translation().setConstant(std::numeric_limits<double>::quiet_NaN());
    path.push_back(off);
    for (std::size_t k = 0; k < n; ++k) path.push_back(path[k]);
    belt::Surfels surfels = plate();
    const belt::BeltRun run = belt::grind(surfels, wheel, path, {});
    EXPECT_NEAR(run.trace.back().time, 2 * 40 / kFeed, 1e-9);
    EXPECT_TRUE(std::isnan(run.trace[n].force));
    EXPECT_NEAR(run.removed_volume, 2 * wheel.law.coefficient * wheel.belt_speed * kForce * 40 / kFeed, 1e-6);
}

TEST(Belt, DwellsAndWears)
{
    belt::ContactWheel wheel = crowned();
    std::vector<belt::BeltPoint> path = line(1);
    path.resize(1);
    path[0].dwell = 0.5;
    belt::Surfels surfels = plate();
    const double fresh = belt::grind(surfels, wheel, path, {}).removed_volume;
    EXPECT_NEAR(fresh, wheel.law.coefficient * wheel.belt_speed * kForce * 0.5, 1e-6);
    belt::BeltOptions worn;
    worn.prior_work = wheel.law.wear_work = 1e6;
    EXPECT_NEAR(belt::grind(surfels, wheel, path, worn).removed_volume, fresh / std::exp(1), 1e-6);
    wheel.law.dwell_exponent = 2;
    EXPECT_NEAR(belt::grind(surfels, wheel, path, {}).removed_volume, fresh / 2, 1e-6);
}

// The belt's work is F V_b t, and it cuts exp(-work / wear_work) as fast: the volume is the integral of that.
TEST(Belt, WearsAlongThePath)
{
    belt::ContactWheel wheel = crowned();
    const double work = kForce * wheel.belt_speed * 40 / kFeed;
    wheel.law.wear_work = work / 2;
    belt::Surfels surfels = plate();
    const belt::BeltRun run = belt::grind(surfels, wheel, line(0.25), {});
    EXPECT_NEAR(run.work, work, 1e-9 * work);
    const double law = wheel.law.coefficient * wheel.law.wear_work * (1 - std::exp(-2));
    EXPECT_NEAR(run.removed_volume, law, 0.01 * law); // steps of 1/160 of the path
}

// Hammann's model removes the same volume, evenly over a rectangle.
TEST(Belt, SpreadsTheForceInTheGlobalModel)
{
    const belt::ContactWheel wheel = crowned();
    belt::Surfels local = plate(), global = plate();
    belt::BeltOptions options;
    const belt::BeltRun by_pressure = belt::grind(local, wheel, line(0.5), options);
    options.model = belt::BeltModel::global;
    options.keep_removals = true;
    const belt::BeltRun even = belt::grind(global, wheel, line(0.5), options);
    EXPECT_NEAR(even.removed_volume, by_pressure.removed_volume, 1e-6 * by_pressure.removed_volume);
    EXPECT_NEAR(volume(even.removed), even.removed_volume, 1e-3 * even.removed_volume);
    EXPECT_LT(even.removed.maxCoeff(), 0.8 * by_pressure.removed.maxCoeff());
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(global.size());
    std::vector<double> deepest(81, 0);
    for (const belt::SurfelRemoval& loss : even.removals) {
        sum[loss.surfel] += loss.depth;
        deepest[loss.point] = std::max(deepest[loss.point], loss.depth);
    }
    EXPECT_LE((sum - even.removed).cwiseAbs().maxCoeff(), 1e-12);
    // r = C V_b F / (V_w L_w) in the middle, where each place is passed from end to end
    double middle = 0, min = 1;
    for (Index i = 0; i < global.size(); ++i)
        if (global.position.col(i).cwiseAbs().head<2>().maxCoeff() < 3) {
            middle = std::max(middle, even.removed[i]);
            min = std::min(min, even.removed[i]);
        }
    EXPECT_LE(middle - min, 0.02 * middle);
    EXPECT_TRUE(by_pressure.removals.empty());
}

TEST(Belt, FollowsThePowerLaw)
{
    belt::BeltLaw law;
    law.coefficient = 2;
    law.pressure_exponent = 1.5;
    law.speed_exponent = 0.5;
    law.feed_exponent = -1;
    law.threshold = 0.1;
    EXPECT_EQ(belt::removal_step(law, 9, 4, 3, 0).depth(0.1), 0);
    EXPECT_NEAR(belt::removal_step(law, 9, 4, 3, 0).depth(0.35), 2 * 0.125 * 3 / 4.0 * 3, 1e-12);
}

// Two passes 10 mm apart: the wheel does not travel between them, and each end dwells.
TEST(Belt, BeginsARunWithEachPass)
{
    cloud::Cloud cloud;
    cloud::PosePath poses(4, Eigen::Isometry3d::Identity());
    poses[1].translation().x() = 2;
    poses[2].translation() << 2, 10, 0;
    poses[3].translation().y() = 10;
    cloud.xyz.setZero(3, 4);
    cloud::set_poses(cloud, poses);
    belt::BeltSettings settings;
    settings.force = 5;
    settings.dwell = 0.5;
    EXPECT_NEAR(belt::tributary_lengths(belt::belt_path(cloud, settings)).sum(), 14, 1e-6);
    EXPECT_EQ(belt::belt_path(cloud, settings)[1].dwell, 0);
    cloud::set_field(cloud, "pass", Eigen::Vector4d(0, 0, 1, 1));
    const std::vector<belt::BeltPoint> path = belt::belt_path(cloud, settings);
    EXPECT_NEAR(belt::tributary_lengths(path).sum(), 4, 1e-6);
    for (const belt::BeltPoint& point : path) EXPECT_EQ(point.dwell, 0.5);
    cloud::set_field(cloud, "feed", Eigen::Vector4d(1, 1, 0, 1));
    EXPECT_THROW(belt::belt_path(cloud, settings), core::InputError);
}

// The deeper the hub, the larger the force; each point reports its force.
TEST(Belt, PressesToADepth)
{
    const belt::ContactWheel wheel = crowned();
    std::vector<belt::BeltPoint> path = line(10);
    for (std::size_t k = 0; k < path.size(); ++k) {
        path[k].load = {false, 0.1 + 0.1 * static_cast<double>(k)};
        path[k].T_part_tool.translation().z() = 0.2;
    }
    belt::Surfels surfels = plate();
    const belt::BeltRun run = belt::grind(surfels, wheel, path, {});
    for (std::size_t k = 1; k < path.size(); ++k) EXPECT_GT(run.trace[k].force, run.trace[k - 1].force);
    EXPECT_NEAR(run.trace[2].indentation, 0.3, 1e-12);
}

TEST(Belt, NamesThePointWithNothingUnderIt)
{
    const belt::ContactWheel wheel = crowned();
    std::vector<belt::BeltPoint> path = line(10);
    path[2].T_part_tool.translation().y() = 500;
    belt::Surfels surfels = plate();
    try {
        belt::grind(surfels, wheel, path, {});
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_STREQ(error.what(), "point 2: there is nothing under the wheel");
    }
}

// A run that is stopped and goes on elsewhere ends as one that was not, to the last digit.
TEST(Belt, GoesOnWhereItWasStopped)
{
    const belt::ContactWheel wheel = crowned();
    const std::vector<belt::BeltPoint> path = line(1);
    belt::BeltOptions options;
    options.range = belt::ToleranceRange{0.19, 0.1999};
    belt::Surfels whole = plate(), begun = plate();
    const belt::BeltRun run = belt::grind(whole, wheel, path, options);
    belt::BeltGrinding first(begun, wheel, path, options);
    for (int k = 0; k < 17; ++k) first.step();
    belt::Surfels later = begun;
    belt::BeltGrinding second(later, wheel, path, options);
    second.restore(first.state());
    while (!second.is_done()) second.step();
    EXPECT_EQ(later.displacement, whole.displacement);
    EXPECT_EQ(second.run().removed, run.removed);
    EXPECT_EQ(second.run().trace.back().indentation, run.trace.back().indentation);
    EXPECT_EQ(second.run().errors.back().rms, run.errors.back().rms);
}

// What changes from point to point adds up to the sums over all surfels.
TEST(Belt, KeepsTheErrorsUpToDate)
{
    const belt::ContactWheel wheel = crowned();
    belt::Surfels surfels = plate();
    surfels.displacement[3] = std::numeric_limits<double>::quiet_NaN();
    belt::BeltOptions options;
    options.range = belt::ToleranceRange{0.19, 0.1999};
    const belt::BeltRun run = belt::grind(surfels, wheel, line(1), options);
    const belt::RunningError all = belt::running_error(surfels.displacement, *options.range);
    const belt::BeltError& last = run.errors.back();
    ASSERT_EQ(run.errors.size(), run.trace.size());
    EXPECT_EQ(last.gouge, all.counts.gouge);
    EXPECT_EQ(last.within, all.counts.within);
    EXPECT_EQ(last.undercut, all.counts.undercut);
    EXPECT_EQ(all.counts.undefined, 1);
    EXPECT_GT(last.within, run.errors.front().within);
    EXPECT_NEAR(last.mean, all.mean(), 1e-12);
    EXPECT_NEAR(last.rms, all.rms(), 1e-12);
    EXPECT_EQ(last.min, all.min);
}

} // namespace belt_test
