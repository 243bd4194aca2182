// Heights between surfels against what they must be, and a wheel pressed on surfels against the exact gap.

#include "belt/press.h"
#include "core/error.h"
#include "own_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>

using namespace fettle;

namespace press_test {

using Eigen::Index;
using Eigen::MatrixXd;

const belt::Gridding kBoth[] = {belt::Gridding::shepard, belt::Gridding::kriging};

/// Places spread evenly and in no rows over a square about the origin (additive recurrence of the plastic number).
Eigen::Matrix3Xd spread(Index count, double side, double (*height)(double, double))
{
    Eigen::Matrix3Xd points(3, count);
    for (Index i = 0; i < count; ++i) {
        const auto k = static_cast<double>(i + 1);
        const double x = side * (std::fmod(0.7548776662466927 * k, 1) - 0.5);
        const double y = side * (std::fmod(0.5698402909980532 * k, 1) - 0.5);
        points.col(i) << x, y, height(x, y);
    }
    return points;
}

TEST(Gridding, KeepsTheSurfelsAndTheLevel)
{
    const belt::ContactGrid cells{{1, 1}, 11, 11};
    for (const belt::Gridding gridding : kBoth) {
        Eigen::Matrix3Xd points = spread(400, 14, [](double, double) { return 3.0; });
        EXPECT_LE((belt::interpolate_heights(cells, points, gridding).height.array() - 3).abs().maxCoeff(), 1e-12);
        points.col(7) << cells.cell_center(4, 9), 5;
        EXPECT_NEAR(belt::interpolate_heights(cells, points, gridding).height(4, 9), 5, 1e-12);
    }
}

// Two heights at distances 1 and 3 on a line, variogram γ = d: weights 3/4 and 1/4. Shepard's: 9/10 and 1/10.
TEST(Gridding, WeighsTwoSurfels)
{
    Eigen::Matrix3Xd points(3, 2);
    points << -1, 3, 0, 0, 10, 20;
    const belt::ContactGrid one{{1, 1}, 1, 1};
    EXPECT_NEAR(belt::interpolate_heights(one, points, belt::Gridding::kriging).height(0, 0), 12.5, 1e-12);
    EXPECT_NEAR(belt::interpolate_heights(one, points, belt::Gridding::shepard).height(0, 0), 11, 1e-12);
}

// Kriging's system with a mirror: two surfels on either side at distance 1, weight w each, a third across, weight v.
TEST(Gridding, WeighsThreeSurfels)
{
    Eigen::Matrix3Xd points(3, 3);
    points << -1, 1, 0, 0, 0, 1, 1, 2, 6;
    const belt::ContactGrid one{{1, 1}, 1, 1};
    // Symmetry: w0 = w1 = w. 2 w + √2 v + μ = 1;  2 √2 w + μ = 1;  2 w + v = 1.
    const double root = std::sqrt(2.0), w = root / (4 * root - 2), v = 1 - 2 * w;
    EXPECT_NEAR(belt::interpolate_heights(one, points, belt::Gridding::kriging).height(0, 0), 3 * w + 6 * v, 1e-12);
}

// The part ends half a spacing beyond its last surfels, however large the cells are and wherever they lie, and goes on
// over a gap of one.
TEST(Gridding, StopsBesideTheLastSurfels)
{
    Eigen::Matrix3Xd points(3, 11 * 11 - 1);
    for (Index i = 0, k = 0; i < 11; ++i)
        for (Index j = 0; j < 11; ++j)
            if (i != 5 || j != 5) points.col(k++) = Eigen::Vector3d(double(i) - 5, double(j) - 5, 1);
    for (const double side : {0.125, 0.9, 1.3, 1.7}) {
        const Index cells = 2 * static_cast<Index>(10 / side);
        const belt::GriddedHeights found =
            belt::interpolate_heights({{side, side}, cells, cells}, points, belt::Gridding::kriging);
        EXPECT_NEAR(found.coverage.sum() * side * side, 11 * 11, 0.03 * 11 * 11) << side;
        EXPECT_TRUE(((found.coverage.array() > 0) == found.height.array().isFinite()).all());
        EXPECT_NEAR(found.height(cells / 2, cells / 2), 1, 1e-9);
        EXPECT_EQ(found.coverage(cells / 2, cells / 2), 1);
    }
}

// A plane is ground to half of a roof's side: between the last surfel that was touched and the next one the kink is
// where the two planes meet, not half-way.
TEST(Gridding, KeepsTheKinkWhereGrindingEnds)
{
    constexpr double kKink = 0.3, kSlope = -0.8;
    const auto before = [](double x) { return kSlope * (x - kKink); };
    Eigen::Matrix3Xd points(3, 21 * 21);
    Eigen::VectorXd removed(21 * 21);
    for (Index i = 0, k = 0; i < 21; ++i)
        for (Index j = 0; j < 21; ++j, ++k) {
            const double x = double(i) - 10;
            removed[k] = std::max(before(x), 0.0);
            points.col(k) << x, double(j) - 10, before(x) - removed[k];
        }
    const belt::ContactGrid cells{{0.1, 0.1}, 20, 20};
    const MatrixXd known = belt::interpolate_heights(cells, points, belt::Gridding::kriging, removed).height,
                   rounded = belt::interpolate_heights(cells, points, belt::Gridding::kriging).height;
    double error = 0, rounding = 0;
    for (Index i = 0; i < cells.rows; ++i) {
        const double exact = std::min(before(cells.cell_center(i, 10).x()), 0.0);
        error = std::max(error, std::abs(known(i, 10) - exact));
        rounding = std::max(rounding, std::abs(rounded(i, 10) - exact));
    }
    EXPECT_LE(error, 0.35 * rounding);
    EXPECT_GE(rounding, 0.1);
}

TEST(Gridding, StopsWhereThereAreNoSurfels)
{
    Eigen::Matrix3Xd points = spread(900, 30, [](double x, double) { return 0.1 * x; });
    points.row(0) = points.row(0).array() / 2 + 7.5; // x from 0 to 15
    for (const belt::Gridding gridding : kBoth) {
        const MatrixXd heights = belt::interpolate_heights({{1, 1}, 20, 20}, points, gridding).height;
        EXPECT_TRUE(heights.topRows(8).array().isNaN().all());
        EXPECT_TRUE(heights.bottomRows(10).array().isFinite().all());
    }
}

belt::Surfels sphere(double radius, double side, double spacing, double displacement)
{
    const auto n = static_cast<Index>(side / spacing);
    belt::Surfels surfels;
    surfels.position.resize(3, n * n);
    surfels.normal.resize(3, n * n);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
            const double x = (double(i) + 0.3 - double(n) / 2) * spacing,
                         y = (double(j) + 0.6 - double(n) / 2) * spacing;
            const double z = std::sqrt(radius * radius - x * x - y * y);
            surfels.position.col(i * n + j) << x, y, z - radius;
            surfels.normal.col(i * n + j) << x / radius, y / radius, z / radius;
        }
    surfels.radius.setConstant(n * n, spacing);
    surfels.displacement.setConstant(n * n, displacement);
    surfels.uv.setZero(2, n * n);
    surfels.patch.setZero(n * n);
    return surfels;
}

belt::ContactWheel wheel()
{
    belt::ContactWheel wheel;
    wheel.radius = 100;
    wheel.width = 50;
    wheel.layer = {10, 5, 0.45};
    return wheel;
}

/// Relative error of the pressure on a sphere with an even stock, tilted and shifted, against that on the exact gap.
double pressure_error(double spacing, belt::Gridding gridding)
{
    const double R = 60, stock = 0.2;
    belt::Surfels surfels = sphere(R, 40, spacing, stock);
    Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
    at.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    at.translation() << 5, -80, 33;
    surfels.position = (at.linear() * surfels.position).colwise() + at.translation();
    surfels.normal = at.linear() * surfels.normal;
    at.translation() += stock * at.linear().col(2); // on the stock
    const belt::ContactWheel rubber = wheel();
    belt::WheelContactOptions options;
    options.gridding = gridding;
    belt::WheelContactSolver press(surfels, rubber, options);
    const belt::WheelContact found = press.solve(at, {true, 30});
    EXPECT_TRUE(found.contact.converged);
    EXPECT_NEAR(found.contact.force, 30, 1e-9);
    EXPECT_FALSE(found.is_near_edge);

    const belt::ContactGrid& cells = found.grid;
    MatrixXd gap(cells.rows, cells.columns);
    for (Index j = 0; j < cells.columns; ++j)
        for (Index i = 0; i < cells.rows; ++i) {
            const Eigen::Vector2d p = cells.cell_center(i, j);
            gap(i, j) = belt::wheel_profile(rubber, p.x(), p.y()) + R + stock -
                        std::sqrt(std::pow(R + stock, 2) - p.squaredNorm());
        }
    const belt::Contact exact =
        belt::LayerContact(rubber.layer, cells.cell_size, cells.rows, cells.columns).solve_by_force(gap, 30, 1e-8);
    EXPECT_NEAR(found.contact.indentation, exact.indentation, 0.01 * exact.indentation);
    EXPECT_NEAR(press.solve(at, {false, found.contact.indentation}).contact.force, 30, 1e-3);
    return (found.contact.pressure - exact.pressure).norm() / exact.pressure.norm();
}

// The two differ only by the spacing of the surfels, in second order.
TEST(Press, AgreesWithTheExactGap)
{
    const double coarse = pressure_error(0.4, belt::Gridding::kriging),
                 fine = pressure_error(0.2, belt::Gridding::kriging);
    EXPECT_LE(coarse, 0.04);
    EXPECT_LE(fine, coarse / 2);
    EXPECT_LE(coarse, pressure_error(0.4, belt::Gridding::shepard)); // which is flat at every surfel
}

// Fields of the answer are the contact's, at the surface, in the part frame.
TEST(Press, WritesTheContactInThePartFrame)
{
    const belt::Surfels surfels = sphere(60, 30, 0.5, 0);
    const belt::ContactWheel rubber = wheel();
    belt::WheelContactOptions options;
    options.cells_per_side = 32;
    belt::WheelContactSolver press(surfels, rubber, options);
    const belt::WheelContact& found = press.solve(Eigen::Isometry3d::Identity(), {true, 5});
    const cloud::Cloud cloud = belt::to_cloud(found, press.residual_gap(), Eigen::Isometry3d::Identity());
    EXPECT_EQ(cloud.size(), 32 * 32);
    EXPECT_NEAR(cloud::field(cloud, "pressure").sum() * found.grid.cell_size.prod(), 5, 1e-6);
    EXPECT_GE(cloud::field(cloud, "gap").minCoeff(), 0);
    for (Index i = 0; i < cloud.size(); ++i)
        EXPECT_NEAR((cloud.xyz.col(i) + Eigen::Vector3d(0, 0, 60)).norm(), 60, 0.005);
}

// One pose after the other is the same as each alone, also where the next one needs a larger grid.
TEST(Press, ForgetsWhatWasBefore)
{
    const belt::Surfels surfels = sphere(60, 40, 0.5, 0);
    const belt::ContactWheel rubber = wheel();
    belt::WheelContactSolver in_turn(surfels, rubber, {});
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (const double force : {5.0, 6.0, 40.0, 8.0}) {
        pose.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()));
        const belt::Contact& one = in_turn.solve(pose, {true, force}).contact;
        belt::WheelContactSolver alone(surfels, rubber, {});
        const belt::Contact& other = alone.solve(pose, {true, force}).contact;
        EXPECT_NEAR(one.indentation, other.indentation, 0.01 * other.indentation); // another grid, the same contact
        EXPECT_NEAR(one.force, force, 1e-9 * force);
    }
}

TEST(Press, RefusesWhereThereIsNothing)
{
    const belt::Surfels surfels = sphere(60, 30, 0.5, 0);
    const belt::ContactWheel rubber = wheel();
    belt::WheelContactSolver press(surfels, rubber, {});
    Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
    away.translation() << 500, 0, 0;
    EXPECT_THROW(press.solve(away, {true, 5}), core::InputError);
    Eigen::Isometry3d under = Eigen::Isometry3d::Identity();
    under.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
    EXPECT_THROW(press.solve(under, {true, 5}), core::InputError); // from behind
}

// The refusal of a wheel in inches to which `keys` are added, "read" if there is none.
std::string reading(const std::string& keys, belt::ContactWheel* wheel = nullptr)
{
    const OwnFolder folder;
    std::ofstream("wheel.json")
        << R"({"kind": "wheel", "units": {"length": "in", "stress": "MPa"}, "radius": 4, "width": 2,
        "layer": {"thickness": 0.5, "young": 3, "poisson": 0.4}, "belt_speed": 600, "law": {"type": "preston", "coefficient": 1e-8})"
        << keys << "}";
    try {
        const belt::ContactWheel found = belt::read_contact_wheel("wheel.json");
        if (wheel != nullptr) *wheel = found;
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "read";
}

TEST(ContactWheel, IsReadInMillimetres)
{
    belt::ContactWheel wheel;
    const std::string serration = R"(, "serration": {"pitch": 0.4, "land": 0.3, "depth": 0.1, "angle_deg": 45})";
    EXPECT_EQ(reading(R"(, "crown_radius": 12)" + serration, &wheel), "read");
    EXPECT_DOUBLE_EQ(wheel.radius, 101.6);
    EXPECT_DOUBLE_EQ(wheel.crown_radius, 304.8);
    EXPECT_DOUBLE_EQ(wheel.serration.pitch, 10.16);
    EXPECT_DOUBLE_EQ(wheel.serration.land, 7.62);
    EXPECT_DOUBLE_EQ(wheel.serration.depth, 2.54);
    EXPECT_DOUBLE_EQ(wheel.serration.angle, std::numbers::pi / 4);
    EXPECT_EQ(reading(R"(, "crown_radius": 0.9)"), "wheel.json: crown_radius: is less than half the width");
    EXPECT_EQ(reading(R"(, "serration": {"pitch": 0.4, "land": 0.5, "depth": 0.1})"),
              "wheel.json: serration.land: is wider than the pitch");
    EXPECT_NE(reading(R"(, "serration": {"pitch": 0.4, "land": 0.3, "depth": 0})").find("serration.depth"),
              std::string::npos);
}

TEST(ContactWheel, HasItsProfile)
{
    belt::ContactWheel crowned = wheel();
    crowned.crown_radius = 300;
    EXPECT_NEAR(belt::wheel_profile(crowned, 60, 0), 20, 1e-12);
    EXPECT_NEAR(belt::wheel_profile(crowned, 0, 20), 300 - std::sqrt(300.0 * 300 - 400), 1e-12);
    EXPECT_TRUE(std::isinf(belt::wheel_profile(crowned, 0, 25.1)));
    EXPECT_TRUE(std::isinf(belt::wheel_profile(crowned, 100, 0)));
    crowned.crown_radius = 0;
    crowned.serration = {10, 6, 3, std::numbers::pi / 2}; // grooves across the axis
    EXPECT_EQ(belt::wheel_profile(crowned, 0, 5.9), 0);
    EXPECT_EQ(belt::wheel_profile(crowned, 0, 6.1), 3);
    EXPECT_EQ(belt::wheel_profile(crowned, 0, -0.1), 3);
    // Gent's formula, tabled: 2.1 MPa at 45, 3.6 MPa at 60 Shore A (Gent 1958).
    EXPECT_NEAR(belt::young_from_shore_a(60), 3.6, 0.1);
}

} // namespace press_test
