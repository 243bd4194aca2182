// Triangle patches against the numbers of a hand, planes, identities and the closest point.

#include "compare/signed_distance.h"
#include "height_surface.h"
#include "machining/patch_error.h"
#include "machining/walls.h"
#include "mesh/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace fettle;

namespace patch_test {

TEST(Patch, ByHand)
{
    // Design z = 3/4 x over the triangle (0, 0) (4, 0) (0, 1): N·Z/|N| = 0.8; Z errors 0.1, 0.2, 0.6: d = 0.3.
    mesh::Mesh machined;
    machined.vertices.resize(3, 3);
    machined.vertices << 0, 4, 0, 0, 0, 1, 0.1, 3.2, 0.6;
    machined.triangles = Eigen::Vector3i(0, 1, 2);
    const machining::PatchErrors errors =
        machining::patch_errors(machined, height_surface(-5, 5, 1, [](double x, double) { return 0.75 * x; }));
    EXPECT_NEAR(errors.z_error[1], 0.2, 1e-14);
    EXPECT_NEAR(errors.d[0], 0.3, 1e-14);
    EXPECT_NEAR(errors.mu[0], 0.24, 1e-14);
    EXPECT_NEAR(errors.area[0], 2 / 0.8, 1e-14);
    EXPECT_LT((errors.normal.col(0) - Eigen::Vector3d(-0.6, 0, 0.8)).norm(), 1e-14);
    EXPECT_NEAR(errors.centre(0, 0), 4.0 / 3, 1e-14);
}

TEST(Patch, OfAPlaneIsItsNormalDistance)
{
    for (const double slope : {0.0, 0.5, -1.0, 3.0})
        for (const double off : {0.2, -0.01}) {
            const auto plane = [&](double x, double y) { return slope * x + 0.3 * y; };
            const double lift = off * std::sqrt(1 + slope * slope + 0.09);
            const machining::PatchErrors errors = machining::patch_errors(
                height_surface(0, 10, 23, [&](double x, double y) { return plane(x, y) + lift; }),
                height_surface(-1, 11, 7, plane));
            EXPECT_LT((errors.mu.array() - off).abs().maxCoeff(), 1e-12);
        }
}

TEST(Patch, ErrorsTimesAreasAreTheVolumeBetween)
{
    const auto design = [](double x, double y) { return std::sin(x) + 0.2 * x * y; };
    const auto machined = [&](double x, double y) { return design(x, y) + 0.1 * std::cos(3 * x + y); };
    const mesh::Mesh fine = height_surface(0, 3, 30, machined);
    const machining::PatchErrors errors = machining::patch_errors(fine, height_surface(0, 3, 30, design));
    // On equal grids the prisms under the patches hold d times the area seen from above.
    double volume = 0;
    for (Eigen::Index t = 0; t < fine.triangles.cols(); ++t) volume += errors.d[t] * 0.1 * 0.1 / 2;
    EXPECT_NEAR((errors.mu.array() * errors.area.array()).sum(), volume, 1e-12);
}

TEST(Patch, UndefinedIsNeverZero)
{
    // A step from 0 to 1 at x = 5.05, with a wall; the machined surface reaches beyond the design, and one of its
    // triangles is turned over.
    mesh::Mesh design = height_surface(0, 10, 1, [](double, double) { return 0; });
    design.vertices.resize(3, 8);
    design.vertices << 0, 5.05, 5.05, 0, 5.05, 10, 10, 5.05, /**/ 0, 0, 10, 10, 0, 0, 10, 10, /**/ 0, 0, 0, 0, 1, 1, 1,
        1;
    design.triangles.resize(3, 6);
    design.triangles << 0, 0, 4, 4, 1, 1, /**/ 1, 2, 5, 6, 7, 2, /**/ 2, 3, 6, 7, 4, 7;
    mesh::Mesh machined = height_surface(0.5, 11.5, 11, [](double x, double) { return x < 5.05 ? 0 : 1; });
    machined.triangles.col(0).reverseInPlace();
    const machining::PatchErrors errors = machining::patch_errors(machined, design);
    int counts[4] = {};
    for (Eigen::Index t = 0; t < machined.triangles.cols(); ++t) {
        const machining::PatchState state = errors.state[static_cast<std::size_t>(t)];
        ++counts[static_cast<int>(state)];
        EXPECT_EQ(std::isnan(errors.mu[t]), state != machining::PatchState::defined);
        EXPECT_EQ(std::isnan(errors.d[t]), state != machining::PatchState::defined);
        if (state == machining::PatchState::defined) {
            EXPECT_NEAR(errors.mu[t], 0, 1e-14);
        }
    }
    // 11 x 11 cells of 1 mm from 0.5 on: beyond 10 are the last two columns and rows; the wall runs through the fifth.
    EXPECT_EQ(counts[static_cast<int>(machining::PatchState::turned_away)], 1);
    EXPECT_EQ(counts[static_cast<int>(machining::PatchState::not_hit)], 2 * (121 - 81));
    EXPECT_EQ(counts[static_cast<int>(machining::PatchState::vertical)], 2 * 9);
    EXPECT_EQ(counts[static_cast<int>(machining::PatchState::defined)], 2 * 81 - 2 * 9 - 1);
}

TEST(Patch, AgreesWithTheClosestPointOnTheReSampledDesign)
{
    // Slopes to 45 degrees, errors up to a tolerance of 0.05 mm. The spacing is that of the tolerance for a radius of
    // curvature of 10 mm (eq. 2 with its slope correction: 2 √(R e) / √1.5): there the closest point lies in the
    // patch's own triangle. And one as small as the errors: there it does not.
    constexpr double kTolerance = 0.05;
    const auto design = [](double x, double) { return 10 * std::sin(x / 10); };
    double max_difference = 0;
    for (const double step : {2 * std::sqrt(10 * kTolerance) / std::sqrt(1.5), kTolerance}) {
        const double size = std::min(60.0, 150 * step);
        const auto machined = [&](double x, double y) {
            return design(x, y) + kTolerance * std::sin(x / 5) * std::cos(y / 7);
        };
        const mesh::Mesh part = height_surface(0, size, static_cast<int>(size / step) + 1, machined);
        const machining::PatchErrors errors = machining::patch_errors(part, height_surface(-5, size + 5, 400, design));
        const Eigen::VectorXd closest = compare::signed_distance(errors.centre, errors.design).error;
        for (Eigen::Index t = 0; t < closest.size(); ++t) {
            const Eigen::Vector2d at = errors.centre.col(t).head<2>();
            if (at.minCoeff() < 1 || at.maxCoeff() > size - 1) continue; // beyond the rim there is no closest point
            ASSERT_FALSE(std::isnan(closest[t]));
            max_difference = std::max(max_difference, std::abs(closest[t] - errors.mu[t]));
        }
    }
    EXPECT_LE(max_difference, 0.02 * kTolerance);
    EXPECT_GT(max_difference, 1e-9);
    RecordProperty("share_of_tolerance", std::to_string(max_difference / kTolerance));
}

TEST(Patch, StatesHaveNames)
{
    const std::pair<machining::PatchState, const char*> names[] = {{machining::PatchState::defined, "defined"},
                                                                   {machining::PatchState::not_hit, "not_hit"},
                                                                   {machining::PatchState::vertical, "vertical"},
                                                                   {machining::PatchState::turned_away, "turned_away"}};
    for (const auto& [state, name] : names) EXPECT_EQ(machining::to_string(state), name);
}

TEST(Patch, ClassesBySeparateTolerances)
{
    const machining::PatchTolerances t{0.1, 0.3, 0.1};
    EXPECT_EQ(machining::classify(-0.1001, t), machining::ErrorClass::serious_over_cut);
    EXPECT_EQ(machining::classify(-0.1, t), machining::ErrorClass::slight_over_cut);
    EXPECT_EQ(machining::classify(-0.0101, t), machining::ErrorClass::slight_over_cut);
    EXPECT_EQ(machining::classify(-0.0099, t), machining::ErrorClass::neutral);
    EXPECT_EQ(machining::classify(0.0299, t), machining::ErrorClass::neutral);
    EXPECT_EQ(machining::classify(0.0301, t), machining::ErrorClass::slight_under_cut);
    EXPECT_EQ(machining::classify(0.3, t), machining::ErrorClass::slight_under_cut);
    EXPECT_EQ(machining::classify(0.3001, t), machining::ErrorClass::serious_under_cut);
}

TEST(Walls, AreFoundInPlanView)
{
    mesh::Mesh mesh; // one upright triangle over the segment (1, 1) (3, 2)
    mesh.vertices.resize(3, 3);
    mesh.vertices << 1, 3, 2, 1, 2, 1.5, 0, 0, 4;
    mesh.triangles = Eigen::Vector3i(0, 1, 2);
    const machining::Walls walls(mesh, 0.5);
    const auto met = [&](double ax, double ay, double bx, double by, double cx, double cy) {
        Eigen::Matrix<double, 2, 3> t;
        t << ax, bx, cx, ay, by, cy;
        return walls.intersects(t);
    };
    EXPECT_TRUE(met(1.9, 1.2, 2.1, 1.2, 2, 1.8));   // across it
    EXPECT_TRUE(met(0, 0, 9, 0, 0, 9));             // all within
    EXPECT_TRUE(met(3, 2, 4, 2, 3, 3));             // its end at a corner
    EXPECT_FALSE(met(1, 1.1, 2, 1.7, 1, 1.7));      // beside, boxes overlap
    EXPECT_FALSE(met(3.1, 2.05, 4, 2.5, 3.1, 2.5)); // beyond its end
    EXPECT_FALSE(machining::Walls(height_surface(0, 1, 1, [](double x, double) { return 50 * x; }), 1)
                     .intersects(mesh.vertices.topRows<2>()));
}

} // namespace patch_test
