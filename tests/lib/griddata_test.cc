#include "core/error.h"
#include "fit/griddata.h"
#include "sampling/estimate.h"
#include "surface/clough_tocher.h"
#include "surface/griddata.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <random>
#include <vector>

namespace fettle {
namespace griddata_test {

Eigen::MatrixXd table(const std::string& name, int columns)
{
    const char* samples = std::getenv("SAMPLES"); // set where the test runs in a folder of its own
    std::ifstream in((samples == nullptr ? "" : std::string(samples) + "/../") + "tests/data/" + name);
    std::vector<double> numbers;
    for (std::string word; in >> word;) numbers.push_back(std::stod(word));
    return Eigen::Map<Eigen::MatrixXd>(numbers.data(), columns, static_cast<Eigen::Index>(numbers.size()) / columns);
}

Eigen::Matrix3Xd scattered(int count, double extent)
{
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> place(0, extent), height(-1, 1);
    Eigen::Matrix3Xd points(3, count);
    for (Eigen::Index i = 0; i < count; ++i) points.col(i) << place(random), place(random), height(random);
    return points;
}

Eigen::Matrix3Xd square_grid(int side, double step)
{
    Eigen::Matrix3Xd points(3, side * side);
    for (int i = 0; i < side * side; ++i) points.col(i) << step * (i % side), step * (i / side), std::sin(1.0 * i);
    return points;
}

// SciPy's CloughTocher2DInterpolator over qhull's triangles (tests/data/griddata-reference.py).
TEST(Griddata, agrees_with_scipy)
{
    const Eigen::Matrix3Xd points = table("griddata-points.txt", 3);
    const Eigen::MatrixXd values = table("griddata-values.txt", 4);
    ASSERT_EQ(points.cols(), 24);
    ASSERT_EQ(values.cols(), 80);
    const surface::Griddata once = surface::make_griddata(points, 0, 0), twice = surface::make_griddata(points, 9, 0);
    int inside = 0;
    for (Eigen::Index i = 0; i < values.cols(); ++i) {
        const Eigen::Vector2d xy = values.col(i).head<2>();
        ASSERT_EQ(std::isnan(surface::height(once, xy)), std::isnan(values(2, i))) << xy.transpose();
        if (std::isnan(values(2, i))) continue;
        ++inside;
        EXPECT_NEAR(surface::height(once, xy), values(2, i), 1e-11);
        EXPECT_NEAR(surface::height(twice, xy), values(3, i), 1e-4); // the reference's grid is sheared by 1e-7 of 100
    }
    EXPECT_GT(inside, 40);
}

TEST(Griddata, reproduces_planes)
{
    Eigen::Matrix3Xd points = scattered(30, 80);
    points.row(2) = (0.3 * points.row(0) - 0.7 * points.row(1)).array() + 12;
    for (const double spacing : {0.0, 7.0}) {
        const surface::Griddata surface = surface::make_griddata(points, spacing, 0.4);
        for (const Eigen::Vector2d& xy : {Eigen::Vector2d(40, 40), Eigen::Vector2d(23.5, 51), Eigen::Vector2d(61, 33)})
            EXPECT_NEAR(surface::height(surface, xy), 0.3 * xy.x() - 0.7 * xy.y() + 12, 1e-10);
    }
}

// Within the hull, and at its corners, where only one side is defined.
TEST(Griddata, has_the_normal_of_a_plane)
{
    Eigen::Matrix3Xd points(3, 25);
    for (int i = 0; i < 25; ++i) points.col(i) << 3 * (i % 5), 2 * (i / 5), 1 + 1.5 * (i % 5) - 0.5 * (i / 5);
    surface::Surface surface;
    surface.shape = surface::make_griddata(points, 0, 0);
    for (const Eigen::Vector2d& xy :
         {Eigen::Vector2d(5, 3), Eigen::Vector2d(0, 0), Eigen::Vector2d(12, 8), Eigen::Vector2d(0, 8)})
        EXPECT_LT((surface::normal(surface, xy) - Eigen::Vector3d(-0.5, 0.25, 1).normalized()).norm(), 1e-9)
            << xy.transpose();
}

TEST(Griddata, goes_through_the_points_when_interpolated_once)
{
    const Eigen::Matrix3Xd points = scattered(30, 80);
    const surface::Griddata surface = surface::make_griddata(points, 0, 0);
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        EXPECT_NEAR(surface::height(surface, points.col(i).head<2>()), points(2, i), 1e-9);
}

TEST(Griddata, gradient_is_the_weight_of_each_point)
{
    const Eigen::Matrix3Xd points = scattered(20, 80);
    for (const double spacing : {0.0, 9.0}) {
        const surface::Griddata surface = surface::make_griddata(points, spacing, 0.2);
        const Eigen::Vector2d xy(40, 37);
        const Eigen::VectorXd weights = surface::height_gradient(surface, xy);
        EXPECT_NEAR(weights.dot(points.row(2)), surface::height(surface, xy), 1e-12);
        EXPECT_NEAR(weights.sum(), 1, 1e-12);
        Eigen::Matrix3Xd moved = points;
        moved(2, 7) += 1;
        EXPECT_NEAR(surface::height(surface::make_griddata(moved, spacing, 0.2), xy) - surface::height(surface, xy),
                    weights[7], 1e-12);
    }
}

// With exact values and gradients the macro-element reproduces quadratics; a cubic is beyond it (its derivative across
// an edge is not linear there).
TEST(CloughTocher, reproduces_quadratics_from_exact_gradients)
{
    const Eigen::Matrix3Xd points = scattered(25, 10);
    const surface::CloughTocher surface(surface::delaunay(points.topRows<2>()));
    const auto f = [](const Eigen::Vector2d& p) {
        return Eigen::Vector3d(2 + p.x() - p.y() + 0.3 * p.x() * p.x() - 0.2 * p.x() * p.y() + 0.7 * p.y() * p.y(),
                               1 + 0.6 * p.x() - 0.2 * p.y(), -1 - 0.2 * p.x() + 1.4 * p.y());
    };
    for (double x = 3; x < 7; x += 0.37)
        for (double y = 3; y < 7; y += 0.41) {
            const auto weights = surface.weights({x, y});
            ASSERT_TRUE(weights);
            double z = 0;
            for (int k = 0; k < 3; ++k) z += f(points.col(weights->corners[k]).head<2>()).dot(weights->weights.col(k));
            EXPECT_NEAR(z, f({x, y})[0], 1e-11);
        }
}

// Along a line through many triangles the slope has no steps: its change over 2h shrinks with h.
TEST(Griddata, has_continuous_slopes)
{
    const surface::Griddata surface = surface::make_griddata(scattered(30, 80), 0, 0);
    const auto largest_step = [&](double h) {
        double largest = 0;
        for (double t = 0; t < 1; t += 0.001) {
            const Eigen::Vector2d p(20 + 40 * t, 25 + 30 * t), d(0.6, -0.8);
            const double slope_change = (surface::height(surface, p + h * d) - 2 * surface::height(surface, p) +
                                         surface::height(surface, p - h * d)) /
                                        h;
            largest = std::max(largest, std::abs(slope_change));
        }
        return largest;
    };
    EXPECT_LT(largest_step(1e-4), 0.02 * largest_step(1e-2));
}

TEST(Griddata, is_not_defined_outside_the_hull)
{
    Eigen::Matrix3Xd points(3, 5);
    points << 0, 10, 10, 0, 4, 0, 0, 10, 10, 5, 0, 1, 2, 3, 1;
    for (const double spacing : {0.0, 2.0}) {
        const surface::Griddata surface = surface::make_griddata(points, spacing, 0);
        EXPECT_TRUE(std::isfinite(surface::height(surface, {0.001, 9.999})));
        EXPECT_TRUE(std::isfinite(surface::height(surface, {10, 5})));
        for (const Eigen::Vector2d& xy :
             {Eigen::Vector2d(-0.001, 5), Eigen::Vector2d(5, 10.001), Eigen::Vector2d(99, 5)}) {
            EXPECT_TRUE(std::isnan(surface::height(surface, xy)));
            EXPECT_TRUE(std::isnan(surface::height_gradient(surface, xy)[0]));
        }
    }
}

TEST(Griddata, merges_points_over_the_same_place)
{
    Eigen::Matrix3Xd points = scattered(12, 50);
    Eigen::Matrix3Xd twice(3, 13);
    twice << points, points.col(3);
    twice(2, 12) += 0.5;
    points(2, 3) += 0.25;
    EXPECT_NEAR(surface::height(surface::make_griddata(twice, 0, 0), {25, 25}),
                surface::height(surface::make_griddata(points, 0, 0), {25, 25}), 1e-12);
}

// All squares of a grid have their corners on circles: the diagonals must not depend on rounding.
TEST(Delaunay, divides_a_regular_grid_alike_however_it_is_turned)
{
    const Eigen::Matrix3Xd points = square_grid(6, 0.1);
    const surface::Triangulation straight = surface::delaunay(points.topRows<2>());
    EXPECT_EQ(straight.triangles.cols(), 50);
    for (const double angle : {0.3, 1.1, 2.9}) {
        const Eigen::Matrix2Xd turned = Eigen::Rotation2Dd(angle).toRotationMatrix() * points.topRows<2>();
        EXPECT_EQ(surface::delaunay(turned).triangles, straight.triangles);
    }
    EXPECT_EQ(surface::hull_corners(straight).size(), 20u);
}

TEST(Delaunay, has_empty_circles)
{
    const Eigen::Matrix2Xd points = scattered(40, 1).topRows<2>();
    const surface::Triangulation mesh = surface::delaunay(points);
    EXPECT_EQ(mesh.triangles.cols(),
              2 * 40 - 2 - static_cast<Eigen::Index>(surface::hull_corners(mesh).size())); // Euler
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Eigen::Vector2d a = points.col(mesh.triangles(0, t));
        Eigen::Matrix2d sides;
        sides << points.col(mesh.triangles(1, t)) - a, points.col(mesh.triangles(2, t)) - a;
        EXPECT_GT(sides.determinant(), 0);
        const Eigen::Vector2d centre = sides.transpose().inverse() * sides.colwise().squaredNorm().transpose() / 2;
        for (Eigen::Index i = 0; i < points.cols(); ++i)
            EXPECT_GE((points.col(i) - a - centre).norm(), centre.norm() * (1 - 1e-9));
    }
}

TEST(Griddata, refuses_what_makes_no_surface)
{
    Eigen::Matrix3Xd points = scattered(10, 50);
    EXPECT_THROW(surface::make_griddata(points.leftCols(2), 0, 0), core::InputError);
    EXPECT_THROW(surface::make_griddata(points, 1e-3, 0), core::InputError); // 50000 x 50000 nodes
    Eigen::Matrix3Xd line = points;
    line.row(1) = 2 * line.row(0);
    EXPECT_THROW(surface::make_griddata(line, 0, 0), core::InputError);
    EXPECT_THROW(surface::make_griddata(points.col(0).replicate<1, 5>(), 0, 0), core::InputError);
    points(2, 4) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(surface::make_griddata(points, 0, 0), core::InputError);
}

/// Wang's layout about a square anomaly: n lines in each direction.
fit::FitInput lines_input(const std::function<double(const Eigen::Vector2d&)>& z)
{
    fit::FitInput input;
    input.job.anomaly.resize(3, 4);
    input.job.anomaly << -10, 10, 10, -10, -10, -10, 10, 10, 0, 0, 0, 0;
    input.xyz.resize(3, 16);
    input.roles.resize(16);
    input.curves.resize(16);
    int i = 0;
    for (int line = 0; line < 4; ++line)
        for (const double along : {-25.0, -10.0, 10.0, 25.0}) {
            const double across = line % 2 == 0 ? -10.0 / 3 : 10.0 / 3;
            const Eigen::Vector2d xy = line < 2 ? Eigen::Vector2d(across, along) : Eigen::Vector2d(along, across);
            input.xyz.col(i) << xy, z(xy);
            input.roles[i] = std::abs(along) > 20 ? 2 : 1;
            input.curves[i++] = line;
        }
    const Eigen::Matrix3Xd estimated = sampling::estimated_points(input.job, input.xyz, input.curves, input.roles);
    input.xyz.conservativeResize(3, 16 + estimated.cols());
    input.xyz.rightCols(estimated.cols()) = estimated;
    input.roles.conservativeResize(input.xyz.cols());
    input.curves.conservativeResize(input.xyz.cols());
    input.roles.tail(estimated.cols()).setConstant(3);
    input.curves.tail(estimated.cols()).setConstant(-1);
    return input;
}

// The covariance against refits: move one touch, estimate again, fit again; the sum of the squared moves of the height
// is its variance over σ².
TEST(GriddataFit, covariance_is_that_of_the_touches)
{
    const auto flat = [](const Eigen::Vector2d&) { return 0.0; };
    const Eigen::Vector2d xy(2, 1);
    double variance = 0;
    for (int touch = 0; touch < 16; ++touch) {
        int next = 0;
        const fit::FitInput input = lines_input([&](const Eigen::Vector2d&) { return next++ == touch ? 1.0 : 0.0; });
        const double moved = surface::height(fit::fit_griddata(input).surface, xy);
        variance += moved * moved;
    }
    const surface::Surface surface = fit::fit_griddata(lines_input(flat)).surface;
    EXPECT_EQ(surface.touches.cols(), 20);
    EXPECT_NEAR(surface::sigma(surface, xy), std::sqrt(variance) * surface.touch_sigma, 1e-6);
}

/// lines_input() with the sampling boundary, the square of the outer touches; z of its corners, NaN: not measured.
fit::FitInput input_with_corners(const std::function<double(const Eigen::Vector2d&)>& z, bool measured)
{
    fit::FitInput input = lines_input(z);
    input.job.sampling = 2.5 * input.job.anomaly;
    for (Eigen::Index i = 0; i < 4; ++i)
        input.job.sampling(2, i) = measured ? z(input.job.sampling.col(i).head<2>()) : std::nan("");
    return input;
}

// Corners of the anomaly lie outside the hull of the touches on the lines. With the measured corners of the sampling
// boundary the surface is defined there; on a plane it is the plane.
TEST(GriddataFit, takes_the_measured_sampling_boundary)
{
    const auto plane = [](const Eigen::Vector2d& p) { return 3 + 0.2 * p.x() - 0.1 * p.y(); };
    for (const double x : {-10.0, 10.0})
        for (const double y : {-10.0, 10.0}) {
            const Eigen::Vector2d corner(2.4 * x, 2.4 * y), of_anomaly(x, y);
            const surface::Surface with = fit::fit_griddata(input_with_corners(plane, true)).surface;
            EXPECT_EQ(with.touches.cols(), 24);
            EXPECT_NEAR(surface::height(with, of_anomaly), plane(of_anomaly), 1e-9);
            EXPECT_NEAR(surface::height(with, corner), plane(corner), 1e-9);
            const surface::Surface without = fit::fit_griddata(input_with_corners(plane, false)).surface;
            EXPECT_EQ(without.touches.cols(), 20);
            EXPECT_TRUE(std::isnan(surface::height(without, corner)));
        }
}

// The corners' heights have the touches' noise, estimated points depend on the lines alone.
TEST(GriddataFit, covariance_holds_the_sampling_boundary)
{
    const auto flat = [](const Eigen::Vector2d&) { return 0.0; };
    const Eigen::Vector2d xy(18, 17);
    double variance = 0;
    for (int touch = 0; touch < 20; ++touch) {
        int next = 0;
        const auto one = [&](const Eigen::Vector2d&) { return next++ == touch ? 1.0 : 0.0; };
        const double moved = surface::height(fit::fit_griddata(input_with_corners(one, true)).surface, xy);
        variance += moved * moved;
    }
    const surface::Surface surface = fit::fit_griddata(input_with_corners(flat, true)).surface;
    EXPECT_NEAR(surface::sigma(surface, xy), std::sqrt(variance) * surface.touch_sigma, 1e-6);
}

// Where a touch is at a corner, the touch is taken, not the job's height.
TEST(GriddataFit, prefers_touches_to_the_job)
{
    fit::FitInput input = input_with_corners([](const Eigen::Vector2d&) { return 1.0; }, true);
    input.job.sampling.row(2).setConstant(50);
    const Eigen::Index before = input.xyz.cols();
    input.xyz.conservativeResize(3, before + 4);
    input.xyz.rightCols(4) << input.job.sampling.topRows<2>(), Eigen::RowVector4d::Ones();
    input.roles.conservativeResize(before + 4);
    input.roles.tail(4).setConstant(2);
    input.curves.conservativeResize(before + 4);
    input.curves.tail(4).setConstant(-1);
    const surface::Surface surface = fit::fit_griddata(input).surface;
    EXPECT_EQ(surface.touches.cols(), 24);
    EXPECT_NEAR(surface::height(surface, {20, 20}), 1, 1e-9);
}

/// input_with_corners() with touches of the anomaly's boundary beside those of the lines, 0.5 mm away.
fit::FitInput input_with_boundary(const std::function<double(const Eigen::Vector2d&)>& z)
{
    fit::FitInput input = input_with_corners(z, true);
    input.use_boundary = true;
    const Eigen::Index before = input.xyz.cols(), added = 8;
    input.xyz.conservativeResize(3, before + added);
    input.roles.conservativeResize(before + added);
    input.curves.conservativeResize(before + added);
    for (Eigen::Index i = 0; i < added; ++i) {
        // the inner touches of the lines are 1 and 2, 5 and 6, …
        Eigen::Vector2d xy = input.xyz.col(4 * (i / 2) + 1 + i % 2).head<2>();
        xy[i < 4 ? 0 : 1] += 0.5;
        input.xyz.col(before + i) << xy, z(xy);
    }
    input.roles.tail(added).setZero();
    input.curves.tail(added).setConstant(-1);
    return input;
}

// Touches of the boundary beside others are averaged with them: no wave of a few tenths of a millimetre remains. The
// surface covers all that it covered, a plane stays the plane, and each touch keeps its weight in the covariance.
TEST(GriddataFit, averages_boundary_touches_beside_others)
{
    int next = 0;
    const auto noise = [&](const Eigen::Vector2d&) { return next++ % 2 == 0 ? 0.1 : -0.1; };
    fit::FitInput input = input_with_boundary(noise);
    const surface::Surface surface = fit::fit_griddata(input).surface;
    EXPECT_EQ(surface.touches.cols(), 32);
    const auto points = [](const surface::Surface& fitted) { return std::get<surface::Griddata>(fitted.shape).points; };
    EXPECT_EQ(points(surface).cols(), 24);
    Eigen::Matrix3Xd pair(3, 2);
    pair << input.xyz.col(1), input.xyz.rightCols(8).col(0);
    const Eigen::Matrix3Xd nodes = points(surface);
    EXPECT_LT((nodes.colwise() - pair.rowwise().mean()).colwise().norm().minCoeff(), 1e-12);
    input.spacing = 0.4; // closer than the touches: they are resolved
    EXPECT_EQ(points(fit::fit_griddata(input).surface).cols(), 32);

    const auto plane = [](const Eigen::Vector2d& p) { return 3 + 0.2 * p.x() - 0.1 * p.y(); };
    const surface::Surface level = fit::fit_griddata(input_with_boundary(plane)).surface;
    for (const Eigen::Vector2d& xy : {Eigen::Vector2d(24, -24), {10, 10}, {-3, -9}, {2, 1}})
        EXPECT_NEAR(surface::height(level, xy), plane(xy), 1e-9);

    double variance = 0;
    const Eigen::Vector2d beside(-3, -9);
    for (int touch = 0; touch < 28; ++touch) {
        next = 0;
        const auto one = [&](const Eigen::Vector2d&) { return next++ == touch ? 1.0 : 0.0; };
        const double moved = surface::height(fit::fit_griddata(input_with_boundary(one)).surface, beside);
        variance += moved * moved;
    }
    EXPECT_NEAR(surface::sigma(level, beside), std::sqrt(variance) * level.touch_sigma, 1e-6);
}

TEST(GriddataFit, names_the_source)
{
    fit::FitInput input = lines_input([](const Eigen::Vector2d&) { return 1.0; });
    input.source = "touches.pcd";
    input.xyz.row(1) = input.xyz.row(0);
    try {
        fit::fit_griddata(input);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_EQ(std::string(error.what()).rfind("touches.pcd: ", 0), 0u) << error.what();
    }
}

} // namespace griddata_test
} // namespace fettle
