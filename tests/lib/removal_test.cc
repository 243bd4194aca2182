// Height field, wheel and Preston's balance against closed forms.

#include "core/error.h"
#include "removal/height_field.h"
#include "removal/preston.h"
#include "removal/wheel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace fettle;

namespace removal_test {

constexpr double kRadius = 25.4;
constexpr double kWidth = 6.4; // 64 cells of 0.1 mm

/// A flat stock at height z, 40 mm along X_w, 80 mm along Y_w.
removal::HeightField flat(double z, double cell, double theta = 0)
{
    const Eigen::AlignedBox2d box(Eigen::Vector2d(-20, -40), Eigen::Vector2d(20, 40));
    removal::HeightField field = removal::empty_height_field(box, {0, 0}, theta, cell);
    field.z.setConstant(z);
    return field;
}

/// Area of a disc's segment of height d.
double segment(double radius, double d)
{
    return radius * radius * std::acos(1 - d / radius) - (radius - d) * std::sqrt(d * (2 * radius - d));
}

double segment_error(double cell, double depth)
{
    removal::HeightField stock = flat(3, cell);
    removal::WheelInStock wheel(stock, kWidth);
    wheel.place({0.017, 0.023}, kRadius, 3 - depth);
    return std::abs(wheel.overlap(3 - depth).volume / (kWidth * segment(kRadius, depth)) - 1);
}

TEST(WheelInStock, OverlapWithFlatIsSegment)
{
    // The width is a whole number of cells; the midpoint rule along the rim is left, of order cell² with some scatter
    // at its ends.
    for (const double depth : {0.05, 0.5, 5.0}) {
        EXPECT_LT(segment_error(0.1, depth), 2e-2 * 0.1 * 0.1 / depth) << depth;
        EXPECT_LT(segment_error(0.025, depth), 2e-2 * 0.025 * 0.025 / depth) << depth;
    }
}

TEST(WheelInStock, AreaIsTheSlopeOfTheVolume)
{
    removal::HeightField stock = flat(3, 0.1);
    removal::WheelInStock wheel(stock, kWidth);
    wheel.place({0, 0}, kRadius, 2);
    constexpr double dz = 1e-9; // within one linear piece
    const auto above = wheel.overlap(2.4), below = wheel.overlap(2.4 - dz);
    EXPECT_EQ(above.area, below.area);
    EXPECT_NEAR((below.volume - above.volume) / dz, above.area, 1e-5 * above.area);
}

TEST(WheelInStock, CutRemovesTheOverlapAndNothingElse)
{
    removal::HeightField stock = flat(3, 0.1);
    const removal::HeightField before = stock;
    removal::WheelInStock wheel(stock, kWidth);
    wheel.place({5, 10}, kRadius, 2);
    const double volume = wheel.overlap(2).volume;
    wheel.cut(2);
    EXPECT_NEAR(removal::volume_between(before, stock), volume, 1e-12 * volume);
    EXPECT_EQ(wheel.overlap(2).volume, 0);
    const double reach = std::sqrt(2 * kRadius - 1);
    for (Eigen::Index j = 0; j < stock.rows(); ++j)
        for (Eigen::Index i = 0; i < stock.columns(); ++i) {
            const Eigen::Vector2d from = stock.centre(i, j) - Eigen::Vector2d(5, 10);
            const bool under = std::abs(from.x()) < kWidth / 2 && std::abs(from.y()) < reach;
            EXPECT_EQ(stock.z(i, j) < 3, under) << from.transpose();
        }
    // A second window that shares the columns contains the lowered rows.
    wheel.place({5, 10.3}, kRadius, 2);
    EXPECT_LT(wheel.overlap(2).volume, 0.05 * volume);
}

TEST(WheelInStock, TouchIsWhereTheOverlapBegins)
{
    removal::HeightField stock = flat(3, 0.1);
    stock.z.block(190, 350, 20, 20) += 2; // a block 2 mm high before the wheel, 3 to 5 mm off
    removal::WheelInStock wheel(stock, kWidth);
    wheel.place({0, 0}, kRadius, 0);
    const double y = 3.05; // nearest row of the block
    EXPECT_NEAR(wheel.touch(), 5 - (kRadius - std::sqrt(kRadius * kRadius - y * y)), 1e-12);
    EXPECT_EQ(wheel.overlap(wheel.touch()).volume, 0);
    EXPECT_GT(wheel.overlap(wheel.touch() - 1e-6).volume, 0);
}

/// The volume over the rim, cell by cell.
double volume_over(const removal::HeightField& stock, const Eigen::Vector2d& xy, double z_tip)
{
    double height = 0;
    for (Eigen::Index j = 0; j < stock.rows(); ++j)
        for (Eigen::Index i = 0; i < stock.columns(); ++i) {
            const Eigen::Vector2d from = stock.centre(i, j) - xy;
            if (std::abs(from.x()) > kWidth / 2 || std::abs(from.y()) > kRadius) continue;
            const double rim = z_tip + kRadius - std::sqrt(kRadius * kRadius - from.y() * from.y());
            if (stock.z(i, j) > rim) height += stock.z(i, j) - rim;
        }
    return height * stock.cell * stock.cell;
}

TEST(WheelInStock, FollowsTheStockUnderEveryMove)
{
    removal::HeightField stock = flat(0, 0.25);
    std::mt19937 random(1);
    for (double& z : stock.z.reshaped()) z = std::uniform_real_distribution<double>(0, 3)(random);
    stock.z.block(60, 100, 20, 30).setConstant(std::numeric_limits<double>::quiet_NaN());
    stock.z.block(70, 200, 30, 10) += 4;
    removal::WheelInStock wheel(stock, kWidth);
    // Along a pass, over rows that it has not seen to others and back, to the grid's ends, beside, across.
    for (const Eigen::Vector2d& xy : {Eigen::Vector2d(0, -30),
                                      {0, -29.5},
                                      {0, 35},
                                      {0, 2},
                                      {0, -30},
                                      {0.5, 2},
                                      {0.5, 39.9},
                                      {19, 5},
                                      {-19.9, 5},
                                      {-19.9, -39},
                                      {0, 2},
                                      {0, 12}})
        for (const double z_tip : {2.5, 1.5}) {
            wheel.place(xy, kRadius, z_tip);
            const double volume = volume_over(stock, xy, z_tip);
            EXPECT_NEAR(wheel.overlap(z_tip).volume, volume, 1e-12 * (volume + 1)) << xy.transpose();
            wheel.cut(z_tip);
            EXPECT_EQ(wheel.overlap(z_tip).volume, 0);
            EXPECT_EQ(volume_over(stock, xy, z_tip + 1e-12), 0);
        }
}

TEST(WheelInStock, NoMaterialNoContact)
{
    removal::HeightField stock = flat(std::numeric_limits<double>::quiet_NaN(), 0.1);
    removal::WheelInStock wheel(stock, kWidth);
    wheel.place({0, 0}, kRadius, -100);
    EXPECT_EQ(wheel.touch(), -std::numeric_limits<double>::infinity());

    stock.z.leftCols(stock.rows() / 2).setConstant(1); // a hole over y > 0
    removal::WheelInStock half(stock, kWidth);
    half.place({0, 0}, kRadius, 0);
    EXPECT_NEAR(half.overlap(0).volume, kWidth * segment(kRadius, 1) / 2, 1e-3 * segment(kRadius, 1));
    half.cut(0);
    EXPECT_EQ(stock.z.isNaN().count(), stock.z.size() / 2);

    half.place({500, 0}, kRadius, 0); // off the grid
    EXPECT_EQ(half.overlap(0).volume, 0);
}

TEST(Press, BalancesVolumeAndForce)
{
    removal::HeightField stock = flat(3, 0.1);
    removal::WheelInStock wheel(stock, kWidth);
    for (const double preload : {0.0, 20.0})
        for (const double stop : {2.9, 1.0, -5.0})
            for (const double guess : {stop, stop + 0.3, 3.0, 50.0}) {
                const removal::Spring spring{preload, 35};
                const double c_dt = 7.4 * 0.004;
                wheel.place({0, 0}, kRadius, stop);
                const removal::Balance balance = removal::press(wheel, spring, stop, c_dt, guess);
                ASSERT_GT(balance.z_tip, stop);
                EXPECT_NEAR(balance.force, preload + 35 * (balance.z_tip - stop), 1e-12);
                EXPECT_NEAR(balance.volume, c_dt * balance.force, 1e-10 * balance.volume);
                EXPECT_EQ(balance.volume, wheel.overlap(balance.z_tip).volume);
            }
}

TEST(Press, RestsOnTheStopWithinThePreload)
{
    removal::HeightField stock = flat(3, 0.1);
    removal::WheelInStock wheel(stock, kWidth);
    wheel.place({0, 0}, kRadius, 2.99);
    const double c_dt = 0.03;
    const removal::Balance balance = removal::press(wheel, {50, 35}, 2.99, c_dt, 2.99);
    EXPECT_EQ(balance.z_tip, 2.99);
    EXPECT_EQ(balance.volume, wheel.overlap(2.99).volume);
    EXPECT_DOUBLE_EQ(balance.force, balance.volume / c_dt);
    EXPECT_LT(balance.force, 50);

    wheel.place({0, 0}, kRadius, 3);
    const removal::Balance off = removal::press(wheel, {50, 35}, 3, c_dt, 3);
    EXPECT_EQ(off.force, 0);
    EXPECT_EQ(off.volume, 0);
}

TEST(HeightField, GridMovesWithItsBox)
{
    const Eigen::AlignedBox2d box(Eigen::Vector2d(1.25, -3), Eigen::Vector2d(52.05, 47.8)); // 50.8 by 50.8
    const removal::HeightField field = removal::empty_height_field(box, {3.175, 25.4}, 0, 0.1);
    EXPECT_EQ(field.columns(), 508 + 2 * 32);
    EXPECT_EQ(field.rows(), 508 + 2 * 254);
    EXPECT_NEAR(field.origin.x(), 1.25 - 3.2, 1e-12);
    for (int n = 1; n < 50; ++n) {
        const Eigen::Vector2d shift(0.31 * n, -17.77 * n);
        const removal::HeightField moved = removal::empty_height_field(box.translated(shift), {3.175, 25.4}, 0, 0.1);
        EXPECT_EQ(moved.columns(), field.columns());
        EXPECT_EQ(moved.rows(), field.rows());
        EXPECT_NEAR((moved.origin - shift - field.origin).norm(), 0, 1e-11);
    }
    EXPECT_THROW(removal::empty_height_field(box, {1, 1}, 0, 0), core::InputError);
    EXPECT_THROW(removal::empty_height_field(box, {1, 1}, 0, -0.1), core::InputError);
    EXPECT_THROW(removal::empty_height_field(box, {1, 1}, 0, std::nan("")), core::InputError);
    EXPECT_THROW(removal::empty_height_field(box, {1, 1}, 0, 1e-5), core::InputError);
    EXPECT_THROW(removal::empty_height_field(box, {1, 1}, 0, 1e-300), core::InputError);
}

TEST(HeightField, CloudHasThePointsWithMaterialInM)
{
    const double theta = 0.4;
    removal::HeightField before = flat(3, 5, theta);
    before.z(2, 3) = std::nan("");
    removal::HeightField after = before;
    after.z(1, 0) = 2.5;
    const cloud::Cloud cloud = removal::to_cloud(before, after);
    ASSERT_EQ(cloud.size(), 8 * 16 - 1);
    const Eigen::Vector2d second = Eigen::Rotation2Dd(theta) * Eigen::Vector2d(-20 + 7.5, -40 + 2.5);
    EXPECT_NEAR((cloud.xyz.col(1) - Eigen::Vector3d(second.x(), second.y(), 2.5)).norm(), 0, 1e-12);
    const Eigen::VectorXd removed = cloud::field(cloud, "removed");
    EXPECT_EQ(removed[1], 0.5);
    EXPECT_EQ(removed.sum(), 0.5);
    EXPECT_EQ(removal::volume_between(before, after), 0.5 * 25);
}

/// Two triangles in the plane z = 2 + 0.1 x − 0.2 y over [−100, 100]².
mesh::Mesh slope()
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 4);
    mesh.triangles.resize(3, 2);
    for (int n = 0; n < 4; ++n) {
        const double x = n == 1 || n == 2 ? 100 : -100, y = n >= 2 ? 100 : -100;
        mesh.vertices.col(n) << x, y, 2 + 0.1 * x - 0.2 * y;
    }
    mesh.triangles << 0, 0, 1, 2, 2, 3;
    return mesh;
}

job::Job square_job(const Eigen::Vector2d& centre)
{
    job::Job job;
    job.surface = job::SurfaceType::plane; // needs no sampling boundary
    job.anomaly.resize(3, 4);
    job.anomaly << -10, 10, 10, -10, -10, -10, 10, 10, 0, 0, 0, 0;
    job.anomaly.topRows<2>().colwise() += centre;
    return job;
}

TEST(HeightField, StandsOnTheScan)
{
    const sampling::Scan scan(slope());
    job::Job job = square_job({20, 30});
    job.theta = 0.3;
    const removal::HeightField stock = removal::stock_from_scan(scan, job, 0.5);
    for (Eigen::Index j = 0; j < stock.rows(); ++j)
        for (Eigen::Index i = 0; i < stock.columns(); ++i) {
            const Eigen::Vector2d at = Eigen::Rotation2Dd(job.theta) * stock.centre(i, j);
            EXPECT_NEAR(stock.z(i, j), 2 + 0.1 * at.x() - 0.2 * at.y(), 1e-9);
        }
    // As far as the wheel reaches: its radius along Y_w, half its width along X_w.
    const double side = 20 * (std::cos(0.3) + std::sin(0.3));
    EXPECT_NEAR(stock.columns() * stock.cell, side + job.wheel.width, 4 * stock.cell);
    EXPECT_NEAR(stock.rows() * stock.cell, side + 2 * job.wheel.radius, 4 * stock.cell);

    EXPECT_THROW(removal::stock_from_scan(scan, square_job({500, 0}), 0.5), core::InputError);
    EXPECT_TRUE(removal::stock_from_scan(scan, square_job({88, 0}), 0.5).z.isNaN().any()); // around B only
    try {
        removal::stock_from_scan(scan, square_job({95, 0}), 0.5, "part.stl");
        FAIL() << "a quarter of B has no surface";
    } catch (const core::InputError& error) {
        EXPECT_STREQ(error.what(), "part.stl: no surface over 25 % of the anomaly, first at x 100.25, y -9.75");
    }
}

/// A sheet of n x n squares of `step` from `corner` on, in two triangles each, at random heights; `keep` says which
/// squares there are.
template <typename Keep>
mesh::Mesh rough_sheet(const Eigen::Vector2d& corner, double step, int n, const Keep& keep)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> height(-3, 3);
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (n + 1) * (n + 1));
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            mesh.vertices.col(j * (n + 1) + i) << corner + step * Eigen::Vector2d(i, j), height(random);
    std::vector<Eigen::Vector3i> triangles;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, c = a + n + 1;
            if (!keep(i, j)) continue;
            triangles.emplace_back(a, a + 1, c + 1);
            triangles.emplace_back(a, c + 1, c);
        }
    mesh.triangles = Eigen::Map<Eigen::Matrix3Xi>(triangles[0].data(), 3, static_cast<Eigen::Index>(triangles.size()));
    return mesh;
}

/// Each cell has the height that a touch at its centre finds, to the last digit. @return  cells without material
Eigen::Index expect_as_touched(const mesh::Mesh& mesh, const job::Job& job, double cell)
{
    const sampling::Scan scan(mesh);
    const removal::HeightField field = removal::stock_from_scan(scan, job, cell);
    for (Eigen::Index j = 0; j < field.rows(); ++j)
        for (Eigen::Index i = 0; i < field.columns(); ++i) {
            const auto z = scan.height(job::rotation_working_machine(job.theta).transpose() * field.centre(i, j));
            EXPECT_TRUE(z ? field.z(i, j) == *z : std::isnan(field.z(i, j))) << i << ' ' << j << ": " << field.z(i, j);
        }
    return field.z.isNaN().count();
}

bool everywhere(int, int) { return true; }

TEST(HeightField, OfAMeshIsWhatTouchesFind)
{
    // Cells of 0.5 have their centres at odd quarters: with squares of 1.5 from a quarter on, vertices and edges of all
    // three directions lie on centres.
    const job::Job job = square_job({0, 0});
    const mesh::Mesh on_centres = rough_sheet({-30.25, -45.25}, 1.5, 61, everywhere);
    EXPECT_EQ(expect_as_touched(on_centres, job, 0.5), 0);
    // Squares far smaller and far larger than cells.
    EXPECT_EQ(expect_as_touched(rough_sheet({-47, -47}, 0.37, 254, everywhere), job, 1.1), 0);
    EXPECT_EQ(expect_as_touched(rough_sheet({-180, -200}, 130, 3, everywhere), job, 0.5), 0);
    // The mesh ends inside the field; a pinhole in B and a hole beside it.
    const auto with_holes = [](int i, int j) {
        return !(i == 20 && j == 30) && !(i >= 20 && i < 25 && j >= 3 && j < 9);
    };
    EXPECT_GT(expect_as_touched(rough_sheet({-30.25, -45.25}, 1.5, 40, with_holes), job, 0.5), 5 * 6 * 9);
}

TEST(HeightField, OfATurnedJobIsWhatTouchesFind)
{
    for (const double theta : {0.3, -1.2, std::numbers::pi / 2, 3.0}) {
        job::Job job = square_job({20, 30});
        job.theta = theta;
        const mesh::Mesh sheet = rough_sheet({-40, -30}, 1.5, 80, everywhere);
        EXPECT_EQ(expect_as_touched(sheet, job, 0.7), 0) << theta;
        // The mesh turned with the job: its lines run along rows and columns but for rounding.
        mesh::Mesh turned = rough_sheet({-30.25, -45.25}, 1.5, 61, everywhere);
        const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(theta).transpose();
        turned.vertices.topRows<2>() = R_machine_working * turned.vertices.topRows<2>();
        job::Job there = square_job({0, 0});
        there.theta = theta;
        there.anomaly.topRows<2>() = R_machine_working * there.anomaly.topRows<2>();
        EXPECT_EQ(expect_as_touched(turned, there, 0.5), 0) << theta;
    }
}

TEST(HeightField, TakesTheUpperSideOfABodyWithNeedlesAndWalls)
{
    // A fan of needles from one corner of the square, its mirror image below, and upright walls between the two.
    constexpr int kNeedles = 400;
    mesh::Mesh body;
    body.vertices.resize(3, 2 * (kNeedles + 2));
    body.triangles.resize(3, 4 * kNeedles);
    for (int n = 0; n <= kNeedles + 1; ++n) {
        const double angle = std::numbers::pi / 2 * (n - 1) / kNeedles;
        const Eigen::Vector2d xy = n == 0
                                       ? Eigen::Vector2d(-60.3, -70.2)
                                       : Eigen::Vector2d(-60.3 + 180 * std::cos(angle), -70.2 + 180 * std::sin(angle));
        body.vertices.col(2 * n) << xy, 5 + 0.01 * xy.x() + (n % 2);
        body.vertices.col(2 * n + 1) << xy, -5;
    }
    for (int n = 0; n < kNeedles; ++n) {
        const int a = 2 * (n + 1), b = a + 2;
        body.triangles.middleCols<4>(4 * n) << 0, 1, a, a, a, b + 1, a + 1, b + 1, b, a + 1, b + 1, b;
    }
    job::Job job = square_job({0, 0});
    EXPECT_EQ(expect_as_touched(body, job, 0.5), 0);
    job.theta = 0.7;
    EXPECT_EQ(expect_as_touched(body, job, 0.5), 0);
    EXPECT_GT(removal::stock_from_scan(sampling::Scan(body), job, 0.5).z.minCoeff(), 4);
}

} // namespace removal_test
