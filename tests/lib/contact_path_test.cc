#include "belt/contact_path.h"

#include "belt/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace fettle {
namespace contact_path_test {

constexpr double kPi = std::numbers::pi;

/// Half a cylinder of radius 10 about y, as surfels on a lattice: u is the angle from +z to +x, v = y in [0, 12].
belt::Surfels half_cylinder(double spacing)
{
    std::vector<belt::Surfel> list;
    const double step = spacing / 10;
    for (double u = -kPi / 2; u < kPi / 2 + step / 2; u += step)
        for (double v = 0; v < 12 + spacing / 2; v += spacing) {
            const Eigen::Vector3d radial(std::sin(u), 0, std::cos(u));
            list.push_back({10 * radial + v * Eigen::Vector3d::UnitY(), radial, {u, v}, 0.71 * spacing, 3});
        }
    belt::Surfels surfels = belt::to_surfels(list);
    surfels.displacement.setConstant(0.5);
    return surfels;
}

/// Length of all passes; none of the steps is longer than the spacing.
double length_of_short_steps(const belt::ContactPath& path, double spacing)
{
    double length = 0;
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
        if (path.pass[i] != path.pass[i - 1]) continue;
        const double step = (path.poses[i].translation() - path.poses[i - 1].translation()).norm();
        EXPECT_LE(step, spacing * (1 + 1e-4));
        length += step;
    }
    return length;
}

belt::ContactPathOptions of_patch_3()
{
    belt::ContactPathOptions options;
    options.patch = 3;
    options.step_over = 2;
    options.spacing = 0.7;
    return options;
}

TEST(ContactPath, rows_lie_on_the_cylinder_and_look_out_of_it)
{
    for (const bool along_v : {false, true}) {
        belt::ContactPathOptions options = of_patch_3();
        options.along_v = along_v;
        const belt::ContactPath path = belt::contact_path(half_cylinder(0.25), options);
        ASSERT_FALSE(path.poses.empty());
        const double width = along_v ? 10 * kPi : 12; // across the rows
        EXPECT_EQ(path.pass.back() + 1, std::ceil(width / 2 - 0.01));
        for (std::size_t i = 0; i < path.poses.size(); ++i) {
            const Eigen::Vector3d p = path.poses[i].translation();
            const Eigen::Vector3d radial = Eigen::Vector3d(p.x(), 0, p.z()).normalized();
            const Eigen::Matrix3d turn = path.poses[i].linear();
            EXPECT_NEAR(std::hypot(p.x(), p.z()), 10, 1e-5);
            EXPECT_NEAR((turn.col(2) - radial).norm(), 0, 1e-5);
            EXPECT_NEAR(turn.determinant(), 1, 1e-12);
            const Eigen::Vector3d feed =
                along_v ? Eigen::Vector3d::UnitY() : Eigen::Vector3d(radial.z(), 0, -radial.x());
            EXPECT_NEAR(turn.col(0).dot(feed), path.pass[i] % 2 == 0 ? 1 : -1, 1e-5);
            if (i == 0 || path.pass[i] != path.pass[i - 1]) continue;
            EXPECT_LE((p - path.poses[i - 1].translation()).norm(), 0.7 + 1e-6);
        }
    }
}

TEST(ContactPath, goes_one_way_and_on_the_stock)
{
    belt::ContactPathOptions options = of_patch_3();
    options.one_way = options.on_stock = true;
    for (const Eigen::Isometry3d& pose : belt::contact_path(half_cylinder(0.25), options).poses) {
        EXPECT_NEAR(std::hypot(pose.translation().x(), pose.translation().z()), 10.5, 1e-5);
        EXPECT_GT(pose.linear().col(0).dot(pose.translation().cross(-Eigen::Vector3d::UnitY())), -1e-9);
    }
}

// The turns of a spiral are a step apart: its length times the step is the patch's area, but for the last half turn.
TEST(ContactPath, a_spiral_covers_the_patch)
{
    belt::ContactPathOptions options = of_patch_3();
    options.pattern = belt::PathPattern::spiral;
    options.step_over = 0.5;
    const belt::ContactPath path = belt::contact_path(half_cylinder(0.25), options);
    double length = 0;
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
        EXPECT_EQ(path.pass[i], 0);
        length += (path.poses[i].translation() - path.poses[i - 1].translation()).norm();
    }
    EXPECT_NEAR(length * 0.5, 10 * kPi * 12, 0.02 * 10 * kPi * 12);
}

// A hole of radius 2 about u = 0, v = 6 parts the rows that run into it.
TEST(ContactPath, passes_end_where_the_patch_does)
{
    belt::Surfels all = half_cylinder(0.25);
    std::vector<Eigen::Index> kept;
    const auto from_hole = [](const Eigen::Vector2d& uv) { return std::hypot(10 * uv[0], uv[1] - 6) - 2; };
    for (Eigen::Index i = 0; i < all.size(); ++i)
        if (from_hole(all.uv.col(i)) > 0) kept.push_back(i);
    const belt::Surfels holed = belt::surfels_from_cloud(cloud::select_points(belt::to_cloud(all), kept), "holed");
    const belt::ContactPath path = belt::contact_path(holed, of_patch_3());
    EXPECT_EQ(path.pass.back() + 1, 6 + 2); // two of the six rows are parted
    for (const Eigen::Isometry3d& pose : path.poses) {
        const Eigen::Vector3d p = pose.translation();
        EXPECT_GT(from_hole({std::atan2(p.x(), p.z()), p.y()}), -0.36); // within a radius of a surfel
    }
    EXPECT_THROW(belt::contact_path(holed, {.patch = 0}), std::runtime_error);
}

// Like a blade's profile: at the nose the parameter runs at a tenth of its speed at the ends, the surfels are evenly
// spaced.
TEST(ContactPath, rows_go_on_where_the_parameter_runs_slowly)
{
    belt::Surfels surfels = half_cylinder(0.25);
    const double end = std::sinh(3.0);
    for (Eigen::Index i = 0; i < surfels.size(); ++i)
        surfels.uv(0, i) = std::asinh(surfels.uv(0, i) / (kPi / 2) * end) / 3;
    const belt::ContactPathOptions options = of_patch_3();
    const belt::ContactPath path = belt::contact_path(surfels, options);
    EXPECT_EQ(path.pass.back() + 1, 6);
    const double length = length_of_short_steps(path, options.spacing);
    EXPECT_NEAR(length, 6 * 10 * kPi, 0.01 * 60 * kPi);
    EXPECT_LE(double(path.poses.size()), 2 * length / options.spacing); // and not many more than it takes
}

// Lengths are those between probes, one surfel in sixteen here. Between two of them the place runs ten times as fast.
TEST(ContactPath, points_stand_close_where_no_probe_has_been)
{
    constexpr int kColumns = 1024, kRows = 157, kFast = 30 * 16 + 4;
    constexpr double kPitch = 0.03;
    std::vector<belt::Surfel> list;
    for (int j = 0; j < kRows; ++j) {
        double u = 0;
        for (int i = 0; i < kColumns; ++i) {
            list.push_back({{kPitch * i, kPitch * j, 0}, Eigen::Vector3d::UnitZ(), {u, kPitch * j}, kPitch, 3});
            u += i >= kFast && i < kFast + 8 ? kPitch / 10 : kPitch;
        }
    }
    belt::ContactPathOptions options = of_patch_3();
    options.spacing = 0.1;
    options.step_over = 5;
    const belt::ContactPath path = belt::contact_path(belt::to_surfels(list), options);
    const double length = length_of_short_steps(path, options.spacing);
    EXPECT_NEAR(length, (path.pass.back() + 1) * kPitch * (kColumns - 1), 0.01 * length);
}

TEST(Interpolation, keeps_the_spacing_within_passes)
{
    cloud::Cloud path;
    path.xyz = (Eigen::Matrix3Xd(3, 5) << 0, 1, 1, 4, 5, 0, 0, 2, 2, 2, 0, 0, 0, 0, 0).finished();
    cloud::PosePath poses(5, Eigen::Isometry3d::Identity());
    for (std::size_t i = 0; i < 5; ++i) poses[i].translation() = path.xyz.col(static_cast<Eigen::Index>(i));
    poses[1].linear() = Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    poses[4].translation().setConstant(std::numeric_limits<double>::quiet_NaN());
    cloud::set_poses(path, poses);
    cloud::set_field(path, "pass", (Eigen::VectorXd(5) << 0, 0, 1, 1, 1).finished());
    cloud::set_field(path, "force", (Eigen::VectorXd(5) << 10, 20, 30, 60, 70).finished());
    const cloud::Cloud dense = belt::interpolate_path(path, 0.5);
    // 2 + the end of pass 0, 6 + 1 of pass 1, and the NaN
    ASSERT_EQ(dense.size(), 2 + 1 + 6 + 1 + 1);
    const cloud::PosePath between = cloud::read_poses(dense);
    EXPECT_NEAR(Eigen::AngleAxisd(between[1].linear()).angle(), 0.5, 1e-12);
    EXPECT_NEAR(between[1].translation().x(), 0.5, 1e-12);
    EXPECT_NEAR(cloud::field(dense, "force")[1], 15, 1e-6);
    EXPECT_NEAR(cloud::field(dense, "force")[6], 45, 1e-6);
    EXPECT_EQ(cloud::field(dense, "pass")[6], 1);
    EXPECT_TRUE(between[10].translation().hasNaN());
}

// A contact point 100 mm along x of the part's frame, below a wheel at (1500, 0, 700): the part hangs at (1400, 0,
// 700).
TEST(HeldPart, is_where_its_contact_point_meets_the_wheel)
{
    cloud::PosePath contact(1, Eigen::Isometry3d::Identity());
    contact[0].translation() << 100, 0, 0;
    Eigen::Isometry3d wheel = Eigen::Isometry3d::Identity();
    wheel.translation() << 1500, 0, 700;
    const Eigen::Isometry3d tool = belt::held_part_path(contact, wheel)[0];
    EXPECT_LT((tool.translation() - Eigen::Vector3d(1400, 0, 700)).norm(), 1e-12);
    // The robot's own tool frame, whose z points out of it, is the part's.
    const Eigen::Matrix3d part = tool.linear() * Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();
    EXPECT_LT((part - Eigen::Matrix3d::Identity()).norm(), 1e-12);

    contact[0].linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    wheel.linear() = Eigen::AngleAxisd(2.1, Eigen::Vector3d(3, -1, 1).normalized()).toRotationMatrix();
    const Eigen::Isometry3d T_cell_part =
        belt::held_part_path(contact, wheel)[0] * Eigen::AngleAxisd(-kPi, Eigen::Vector3d::UnitX());
    EXPECT_LT(((T_cell_part * contact[0]).matrix() - wheel.matrix()).norm(), 1e-9);
}

} // namespace contact_path_test
} // namespace fettle
