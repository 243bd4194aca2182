#include "core/error.h"
#include "own_folder.h"
#include "plan/gcode.h"
#include "plan/layers.h"
#include "plan/plan.h"
#include "plan/staircase.h"
#include "plan/tool_path.h"
#include "plan/wheel_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace fettle {
namespace plan_test {

constexpr double kInch = 25.4;

// --- layers ----------------------------------------------------------------------------------------------------------

TEST(Layers, FollowWang)
{
    // 20 / 40 / 60 lbf on 200 lbf/in: thickness 0.2 in (5-1), distance 0.1 in (5-2); in inches and pounds.
    const plan::Layers layers = plan::compute_layers({20, 40, 60, 200, 0});
    EXPECT_DOUBLE_EQ(layers.thickness, 0.2);
    EXPECT_DOUBLE_EQ(layers.distance, 0.1);
    EXPECT_EQ(layers.overlap_case, 3);
    EXPECT_EQ(plan::reference_offset(layers, 1), 0);
    EXPECT_DOUBLE_EQ(plan::reference_offset(layers, 4), 0.3); // (5-3)
    EXPECT_EQ(plan::compute_layers({20, 50, 60, 200, 0}).overlap_case, 1);
    EXPECT_EQ(plan::compute_layers({20, 30, 60, 200, 0}).overlap_case, 2);
}

// --- the staircase ---------------------------------------------------------------------------------------------------

job::Polygon polygon(std::initializer_list<std::pair<double, double>> corners)
{
    job::Polygon result(2, Eigen::Index(corners.size()));
    Eigen::Index i = 0;
    for (const auto& [x, y] : corners) result.col(i++) << x, y;
    return result;
}

job::Polygon moon()
{
    job::Polygon result(2, 60);
    for (int i = 0; i < 30; ++i) {
        const double a = std::numbers::pi * (0.2 + 1.6 * i / 29), b = std::numbers::pi * (1.7 - 1.4 * i / 29);
        result.col(i) << 20 * std::cos(a), 20 * std::sin(a);
        result.col(30 + i) << 5 + 15 * std::cos(b), 15 * std::sin(b);
    }
    return result;
}

Eigen::VectorXd level(const Eigen::Matrix2Xd& places) { return Eigen::VectorXd::Zero(places.cols()); }

// Inside the strip of the wheel around one of the passes?
bool is_covered(const std::vector<plan::Pass>& passes, double half_width, const Eigen::Vector2d& point)
{
    constexpr double kRounding = 1e-9;
    for (const plan::Pass& pass : passes)
        if (std::abs(pass.line - point.x()) <= half_width + kRounding)
            for (const job::Interval& interval : pass.intervals)
                if (point.y() >= interval.first - kRounding && point.y() <= interval.second + kRounding) return true;
    return false;
}

class StaircaseTest : public testing::TestWithParam<int> {
  protected:
    job::Polygon region() const
    {
        const job::Polygon regions[] = {
            polygon({{0, 0}, {50, 0}, {50, 50}, {0, 50}}),
            polygon({{3, 1}, {41, 22}, {9, 37}}),          // pointed at all ends
            polygon({{0, 0}, {30, 25}, {31, 28}, {1, 3}}), // a slanted strip
            polygon({{0, 0}, {40, 0}, {40, 40}, {25, 40}, {25, 10}, {15, 10}, {15, 40}, {0, 40}}), // a U
            moon(),
            polygon({{0, 0}, {3, 0}, {3, 20}, {0, 20}}), // narrower than the wheel
        };
        return regions[GetParam()];
    }
    static constexpr double kWidth = 6;
};

TEST_P(StaircaseTest, CoversTheRegionAndStaysOnIt)
{
    for (const double step_over : {2.0, 5.0, 6.0}) {
        const std::vector<plan::Pass> passes = plan::staircase(region(), level, plan::wheel_sections(25, kWidth, 'y'),
                                                               {.step_over = step_over, .max_scallop = 0.05});
        const Eigen::Vector2d low = region().rowwise().minCoeff(), high = region().rowwise().maxCoeff();
        for (double y = low.y(); y <= high.y(); y += 0.37)
            for (double x = low.x(); x <= high.x(); x += 0.37)
                EXPECT_TRUE(!job::contains(region(), {x, y}) || is_covered(passes, kWidth / 2, {x, y}))
                    << x << " " << y;
        for (Eigen::Index i = 0; i < region().cols(); ++i)
            EXPECT_TRUE(is_covered(passes, kWidth / 2, region().col(i))) << region().col(i).transpose();

        // At each position of the wheel, its width is over the region.
        for (std::size_t p = 0; p < passes.size(); ++p) {
            if (p > 0) {
                EXPECT_GT(passes[p].line, passes[p - 1].line);
                EXPECT_LE(passes[p].line, passes[p - 1].line + step_over * (1 + 1e-9));
            }
            for (const job::Interval& interval : passes[p].intervals)
                for (const double y :
                     {interval.first + 0.05, (interval.first + interval.second) / 2, interval.second - 0.05}) {
                    const Eigen::Vector2d edge(passes[p].line - kWidth / 2, y);
                    const auto over =
                        job::intersect(job::intervals_inside(region(), edge, Eigen::Vector2d::UnitX()), {{0, kWidth}});
                    EXPECT_FALSE(over.empty()) << passes[p].line << " " << y;
                }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Regions, StaircaseTest, testing::Range(0, 6));

TEST(Staircase, LiesFlushWithARectangle)
{
    const std::vector<plan::Pass> passes =
        plan::staircase(polygon({{10, 0}, {60, 0}, {60, 40}, {10, 40}}), level, plan::wheel_sections(25, 6, 'y'),
                        {.step_over = 5, .max_scallop = 0.05});
    EXPECT_NEAR(passes.front().line, 13, 1e-9);
    EXPECT_NEAR(passes.back().line, 57, 6.0 / 64);
    EXPECT_EQ(passes.size(), 10u); // 44 mm in steps of at most 5
    for (const plan::Pass& pass : passes) EXPECT_EQ(pass.intervals, (std::vector<job::Interval>{{0, 40}}));
}

// On a slope s across the passes the level wheel leaves steps of s times their distance.
TEST(Staircase, PassesAreCloserOnASlope)
{
    const double slope = 0.25, leftover = 0.05;
    const auto tilted = [&](const Eigen::Matrix2Xd& places) -> Eigen::VectorXd { return slope * places.row(0); };
    const std::vector<plan::Pass> passes =
        plan::staircase(polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}}), tilted, plan::wheel_sections(25, 6, 'y'),
                        {.step_over = 5, .max_scallop = leftover});
    // The wheel touches with its uphill edge, so the lowest line lies half a width outside.
    EXPECT_NEAR(passes.front().line, -3 + leftover / slope, 0.1);
    for (std::size_t p = 1; p < passes.size(); ++p) {
        EXPECT_LE(passes[p].line - passes[p - 1].line, leftover / slope + 1e-9);
        EXPECT_GE(passes[p].line - passes[p - 1].line, 0.5 * leftover / slope);
    }
}

TEST(Staircase, AlongTheWheelsAxisKeepsTheScallopsLow)
{
    // A round section leaves scallops of spacing² / 8R.
    const double leftover = 0.05, radius = 25;
    const std::vector<plan::Pass> passes =
        plan::staircase(polygon({{0, 0}, {20, 0}, {20, 20}, {0, 20}}), level, plan::wheel_sections(radius, 6, 'x'),
                        {.step_over = 5, .max_scallop = leftover});
    for (std::size_t p = 1; p < passes.size(); ++p) {
        const double spacing = passes[p].line - passes[p - 1].line;
        EXPECT_LE(spacing * spacing / (8 * radius), leftover);
    }
    EXPECT_LE(passes.size(), 9u); // 20 / √(8 · 25 · 0.05) = 6.3
}

TEST(StripProjection, IsExact)
{
    const job::Polygon triangle = polygon({{0, 0}, {10, 0}, {0, 10}});
    EXPECT_EQ(plan::strip_projection(triangle, 0, 2, 4), (std::vector<job::Interval>{{0, 8}}));
    EXPECT_EQ(plan::strip_projection(triangle, 1, 5, 20), (std::vector<job::Interval>{{0, 5}}));
    EXPECT_TRUE(plan::strip_projection(triangle, 0, 11, 12).empty());
}

// --- compensation ----------------------------------------------------------------------------------------------------

job::Job job_with(double radius, double width)
{
    job::Job job;
    job.wheel = {radius, width, radius / 2};
    job.anomaly.resize(3, 4);
    job.anomaly << -10, 10, 10, -10, -10, -10, 10, 10, 0, 0, 0, 0;
    job.sampling = 2 * job.anomaly;
    job.tolerance = 1;
    return job;
}

// In the plane of the wheel: centre = contact + R n; the point that a pass touches first and last is its interval's.
TEST(ToolPath, OnAPlaneIsOffsetAlongTheNormal)
{
    const double a = 0.1, b = 0.3, radius = 25, width = 6;
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 5, {a, b}};
    const job::Job job = job_with(radius, width);
    const plan::ToolPath path(job, surface, {{2, {{-10, 10}}}}, 1);
    const double c = 1 / std::hypot(1, b);
    for (const plan::ToolPass& pass : path.passes())
        for (std::size_t i = 0; i < pass.points.size(); ++i) {
            const Eigen::Vector3d& tool = pass.points[i];
            // Contact below the centre along the normal, on the edge that is uphill.
            const Eigen::Vector2d contact(2 + width / 2, tool.y() + radius * b * c);
            EXPECT_NEAR(contact.y(), pass.along[i], 1e-9);
            EXPECT_NEAR(tool.z(), 5 + a * contact.x() + b * contact.y() + radius * c - radius, 1e-4);
        }
}

surface::Surface sphere(double radius)
{
    surface::Surface surface;
    surface::Sphere shape;
    shape.point = Eigen::Vector3d::Zero();
    shape.normal = Eigen::Vector3d::UnitZ();
    shape.curvature = 1 / radius;
    surface.shape = shape;
    return surface;
}

// The sign convention of the curvature is the surface's: a crown is recognised by its heights.
bool is_crown(const surface::Surface& surface)
{
    return surface::height(surface, {5, 0}) < surface::height(surface, {0, 0});
}

TEST(ToolPath, OnASphereTheCentreIsARadiusAway)
{
    // A wheel as thin as a disc rolls over a sphere: its centre is at R_sphere ± R from the sphere's in its plane.
    const double R = 100, r = 25;
    for (const double sign : {1.0, -1.0}) {
        const surface::Surface surface = sphere(sign * R);
        const bool crown = is_crown(surface);
        const job::Job job = job_with(r, 1e-6);
        const plan::ToolPath path(job, surface, {{0, {{-10, 10}}}}, 1);
        const plan::ToolPass& pass = path.passes().front();
        const double centre_z = crown ? -R : R, reach = crown ? R + r : R - r;
        for (const Eigen::Vector3d& tool : pass.points)
            EXPECT_NEAR(std::hypot(tool.y(), tool.z() + r - centre_z), reach, 1e-4);
        // The ends: the contact's y is in proportion.
        EXPECT_NEAR(pass.points.back().y(), 10 * reach / R, 1e-3);
    }
}

TEST(ToolPath, OnACylinderAcrossTheWheelOnlyItsWidthMatters)
{
    // Axis along y: the section along the passes is level. Hollow: both edges touch; crown: the middle does.
    for (const double sign : {1.0, -1.0}) {
        surface::Surface surface;
        surface::Cylinder shape;
        shape.point = Eigen::Vector3d::Zero();
        shape.normal = Eigen::Vector3d::UnitZ();
        shape.axis = Eigen::Vector3d::UnitY();
        shape.curvature = sign / 100;
        surface.shape = shape;
        const plan::ToolPath path(job_with(25, 8), surface, {{0, {{-10, 10}}}}, 1);
        const double expected = is_crown(surface) ? 0 : 100 - std::sqrt(100 * 100 - 4 * 4.0);
        for (const Eigen::Vector3d& tool : path.passes().front().points) EXPECT_NEAR(tool.z(), expected, 1e-6);
    }
}

// The identity behind it all: nowhere in its footprint is the wheel below the surface, and somewhere it touches.
TEST(ToolPath, NeverCutsBelowTheSurface)
{
    surface::Surface surface;
    surface::Swept shape;
    shape.origin = {0, 0};
    shape.ruling = Eigen::Vector2d(1, 2).normalized(); // askew to the wheel
    shape.scale = 20;
    shape.section = {1, 0.6, 1.2, -0.8};
    shape.slope = 0.1;
    surface.shape = shape;
    for (const char axis : {'y', 'x'})
        for (const double worn : {25.0, 18.0}) {
            job::Job job = job_with(25, 6);
            job.theta = 0.4;
            job.feed.axis = axis;
            plan::ToolPath path(job, surface, {{-4, {{-8, -1}, {3, 9}}}, {5, {{-9, 9}}}}, 1);
            path.set_radius(worn);
            const Eigen::Matrix2d machine_working = job::rotation_working_machine(job.theta).transpose();
            for (const plan::ToolPass& pass : path.passes())
                for (const Eigen::Vector3d& tool : pass.points) {
                    double gap = 1e9;
                    for (double dx = -3; dx <= 3; dx += 0.25)
                        for (double dy = -15; dy <= 15; dy += 0.1) {
                            const double rim = tool.z() + worn - std::sqrt(worn * worn - dy * dy);
                            const Eigen::Vector2d xy = tool.head<2>() + machine_working * Eigen::Vector2d(dx, dy);
                            gap = std::min(gap, rim - surface::height(surface, xy));
                        }
                    EXPECT_NEAR(gap, 0, 4e-4); // the wheel is sampled every 0.1 mm, a sag of 5e-5
                    EXPECT_GT(gap, -2e-4);
                }
        }
}

// --- a wheel that does not fit ---------------------------------------------------------------------------------------

std::string refusal(const job::Job& job, const surface::Surface& surface)
{
    try {
        plan::check_wheel_fits(job, surface);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(WheelFit, RadiusAgainstAHollow)
{
    surface::Surface hollow = sphere(30);
    if (is_crown(hollow)) hollow = sphere(-30);
    surface::Surface crown = sphere(30);
    if (!is_crown(crown)) crown = sphere(-30);
    // In the wheel's plane the tightest section of the sphere over B is that at x = 10: √(30² − 10²) = 28.28.
    EXPECT_EQ(refusal(job_with(28.2, 6), hollow), "");
    const std::string message = refusal(job_with(28.6, 6), hollow);
    EXPECT_NE(message.find("wheel.radius: 28.6 does not fit the hollow of radius 28.2"), std::string::npos) << message;
    EXPECT_NE(message.find("at (-10, -10) mm"), std::string::npos) << message;
    EXPECT_EQ(refusal(job_with(31, 6), crown), "");
}

TEST(WheelFit, WidthAgainstTheTolerance)
{
    const surface::Surface surface = sphere(100);
    job::Job job = job_with(25, 8);
    job.tolerance = 8 * 8 / (8 * std::sqrt(100 * 100 - 10 * 10.0)) * 1.01;
    EXPECT_EQ(refusal(job, surface), "");
    job.tolerance *= 0.98;
    EXPECT_NE(refusal(job, surface).find("wheel.width: 8 across a curvature of radius 99."), std::string::npos)
        << refusal(job, surface);
}

TEST(WheelFit, NamesThePlaceInTheJobsUnits)
{
    // z = y³ / 1000: a hollow that tightens towards y = 10.
    surface::Surface surface;
    surface::Swept shape;
    shape.origin = {0, 0};
    shape.ruling = {1, 0};
    shape.scale = 10;
    shape.section = {0, 0, 0, 1};
    surface.shape = shape;
    job::Job job = job_with(25, 6);
    job.units.length = units::Units::Length::in;
    const std::string message = refusal(job, surface);
    EXPECT_NE(message.find("in"), std::string::npos) << message;
    EXPECT_NE(message.find("wheel.radius: 0.984252"), std::string::npos) << message;
}

// --- the plan and its file -------------------------------------------------------------------------------------------

TEST(Plan, StartsAtTheSmallestXThenY)
{
    job::Job job = job_with(25, 6);
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 1, {0.1, 0}};
    const plan::Plan along_y = plan::make_plan(job, surface);
    EXPECT_TRUE(along_y.start.isApprox(Eigen::Vector3d(-10, -10, 0))); // (5-4), (5-5)
    EXPECT_EQ(along_y.bounds.layers, 1 + int(std::floor((50.8 - 0) / along_y.layers.distance)));

    job.anomaly.col(0) << -4, -12, 0;
    job.feed.axis = 'x'; // smallest y, then smallest x
    EXPECT_TRUE(plan::make_plan(job, surface).start.isApprox(Eigen::Vector3d(-4, -12, 0.6)));
}

TEST(Plan, ComesBackFromItsFile)
{
    job::Job job = job_with(25, 6);
    job.units = {units::Units::Length::in, units::Units::Force::lbf};
    job.theta = 0.3;
    job.feed.axis = 'x';
    surface::Surface surface;
    surface.units = job.units;
    surface.shape = surface::Plane{{0, 0}, 1, {0.01, 0.02}};
    const plan::Plan plan = plan::make_plan(job, surface);
    const OwnFolder folder;
    const std::string path = "plan.json";
    std::ofstream(path) << plan::to_json(plan);
    const plan::Plan read = plan::read_plan(path);
    EXPECT_EQ(plan::to_json(read).text(), plan::to_json(plan::read_plan(path)).text());
    ASSERT_EQ(read.passes.size(), plan.passes.size());
    for (std::size_t p = 0; p < plan.passes.size(); ++p) {
        EXPECT_NEAR(read.passes[p].line, plan.passes[p].line, 1e-12);
        ASSERT_EQ(read.passes[p].intervals.size(), plan.passes[p].intervals.size());
        for (std::size_t i = 0; i < plan.passes[p].intervals.size(); ++i) {
            EXPECT_NEAR(read.passes[p].intervals[i].first, plan.passes[p].intervals[i].first, 1e-12);
            EXPECT_NEAR(read.passes[p].intervals[i].second, plan.passes[p].intervals[i].second, 1e-12);
        }
    }
    EXPECT_EQ(read.bounds.layers, plan.bounds.layers);
    EXPECT_NEAR((read.start - plan.start).norm(), 0, 1e-12);
    std::remove(path.c_str());
}

TEST(Plan, RefusesASafeHeightBelowTheSurface)
{
    job::Job job = job_with(25, 6);
    job.safe_height = 0.5;
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 1, {0, 0}};
    EXPECT_THROW(plan::make_plan(job, surface), core::InputError);
}

// Every straight move of the program stays within the chord error of the exact path.
TEST(Gcode, KeepsTheChordError)
{
    surface::Surface surface = sphere(100);
    if (!is_crown(surface)) surface = sphere(-100);
    const plan::Plan plan = plan::make_plan(job_with(25, 6), surface);
    const plan::ToolPath path(plan.job, plan.surface, plan.passes, plan.step);
    std::ostringstream out;
    plan::write_gcode(out, plan, path, plan::GcodeDialect::linuxcnc, 0.01);
    std::istringstream lines(out.str());
    std::string line;
    std::vector<Eigen::Vector3d> ends;
    double max = 0;
    bool units = false, feed = false;
    while (std::getline(lines, line)) {
        units = units || line == "G21";
        feed = feed || line.rfind("F", 0) == 0;
        Eigen::Vector3d point;
        if (line.rfind("G0", 0) == 0) ends.clear();
        if (std::sscanf(line.c_str(), "G1 X%lf Y%lf Z%lf", &point.x(), &point.y(), &point.z()) != 3) continue;
        if (!ends.empty())
            for (double s = 0.1; s < 1; s += 0.1) {
                const Eigen::Vector3d on = ends.back() + s * (point - ends.back());
                max = std::max(max, std::abs(on.z() - path.tool_point(path.across_along(on)).z()));
            }
        ends.push_back(point);
    }
    EXPECT_TRUE(units && feed);
    EXPECT_GT(max, 0.001);  // it is used
    EXPECT_LT(max, 0.0105); // along z instead of across the chord; rounding of the digits
}

} // namespace plan_test
} // namespace fettle
