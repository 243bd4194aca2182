// The grid's spacing from the tolerance: the formulas by hand, the shape of known designs, and the true errors against
// the predicted ones.

#include "core/error.h"
#include "height_surface.h"
#include "machining/discretization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

using namespace fettle;

namespace discretization_test {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(Spacing, IsThatOfTheEquations)
{
    // e = 0.03, r = 6, R = 25. Published: convex √(0.03/(1/100 + 1/18)), concave min(2√0.75, √0.54).
    machining::DesignShape bulge{25, kInfinite, 1.0}, hollow{kInfinite, 25, 1.0};
    EXPECT_NEAR(machining::spacing_for(0.03, 6, bulge, true).step, std::sqrt(0.03 / (0.01 + 1.0 / 18)), 1e-14);
    EXPECT_NEAR(machining::spacing_for(0.03, 6, hollow, true).step, std::sqrt(0.54), 1e-14);
    EXPECT_NEAR(machining::spacing_for(0.03, 600, hollow, true).step, 2 * std::sqrt(0.75), 1e-14);
    EXPECT_NEAR(machining::spacing_for(0.03, 6, {25, 30, 0}, true).step,
                machining::spacing_for(0.03, 6, bulge, true).step, 1e-14);
    // Without the approximation the predicted error is the tolerance itself, for any slope.
    for (const double slope : {0.0, 0.5, 1.0})
        for (const double e : {1e-4, 0.03, 2.0})
            for (const machining::DesignShape& shape : {machining::DesignShape{25, kInfinite, slope},
                                                        {kInfinite, 25, slope},
                                                        {25, 9, slope},
                                                        {kInfinite, kInfinite, slope}}) {
                const machining::Spacing spacing = machining::spacing_for(e, 6, shape);
                EXPECT_NEAR(spacing.predicted_error, e, 1e-12);
                EXPECT_GE(spacing.surface_error, 0);
            }
    // A plane on a slope has e_p alone.
    EXPECT_NEAR(machining::spacing_for(0.03, 6, {kInfinite, kInfinite, 1.0}).step,
                std::sqrt(0.54 * 2 / (1 + 1 / std::pow(std::cos(1.0), 2))), 1e-14);
    EXPECT_EQ(machining::spacing_for(0.03, 6, {kInfinite, kInfinite, 0}).step, std::sqrt(0.54));
}

TEST(DesignShape, OfKnownSurfaces)
{
    const auto cap = [](double R) {
        return [R](double x, double y) { return std::copysign(std::sqrt(R * R - x * x - y * y), R); };
    };
    const machining::DesignShape bulge = machining::estimate_design_shape(height_surface(-12, 12, 60, cap(25))),
                                 hollow = machining::estimate_design_shape(height_surface(-12, 12, 60, cap(-25)));
    EXPECT_NEAR(bulge.convex_radius, 25, 1.5);
    EXPECT_EQ(bulge.concave_radius, kInfinite);
    EXPECT_NEAR(hollow.concave_radius, 25, 1.5);
    EXPECT_EQ(hollow.convex_radius, kInfinite);
    EXPECT_NEAR(bulge.slope, std::asin(std::hypot(12, 12) / 25), 0.12); // but for the corners' hundredth
    const machining::DesignShape wave = machining::estimate_design_shape(
        height_surface(-20, 20, 100, [](double x, double) { return 4 * std::cos(x / 5); }));
    EXPECT_NEAR(wave.convex_radius, 25.0 / 4, 0.3);
    EXPECT_NEAR(wave.concave_radius, 25.0 / 4, 0.3);
    EXPECT_NEAR(wave.slope, std::atan(0.8), 0.02);
    EXPECT_EQ(machining::kind_of(wave), machining::ShapeKind::mixed);
    const machining::DesignShape roof = machining::estimate_design_shape(
        height_surface(-5, 5, 10, [](double x, double) { return -std::abs(x); })); // an edge, no bulge
    EXPECT_EQ(roof.convex_radius, kInfinite);
    EXPECT_NEAR(roof.slope, std::numbers::pi / 4, 1e-12);
    mesh::Mesh down = height_surface(-5, 5, 2, [](double, double) { return 0; });
    down.triangles.row(0).swap(down.triangles.row(1));
    EXPECT_THROW(machining::estimate_design_shape(down), core::InputError);
}

/// A surface with its unit normal and signed distance from points near it.
struct Design {
    std::function<Eigen::Vector3d(double, double)> point, normal;
    std::function<double(const Eigen::Vector3d&)> distance;
    machining::DesignShape shape;
    double extent = 0; ///< nothing of it is farther from the axis, mm
};

/// Largest distance from the design of what a ball leaves that touches it over each point of a grid, and of the
/// triangles between these points, over places whose slope is at most that of the shape.
double true_error(const Design& design, double r, double step)
{
    double max = 0;
    const double min_z = std::cos(design.shape.slope);
    const int cells = static_cast<int>(std::ceil(design.extent / step));
    const int stride = std::max(1, cells / 40); // some cells of all kinds
    for (int j = -cells; j <= cells; j += stride)
        for (int i = -cells; i <= cells; i += stride) {
            std::vector<Eigen::Vector3d> centres;
            bool flat_enough = true;
            for (int b = -1; b <= 2; ++b)
                for (int a = -1; a <= 2; ++a) {
                    const double x = (i + a + 0.37) * step, y = (j + b + 0.21) * step;
                    const Eigen::Vector3d n = design.normal(x, y);
                    const bool of_cell = a >= 0 && a <= 1 && b >= 0 && b <= 1;
                    if (of_cell) flat_enough = flat_enough && n.z() >= min_z; // NaN: beyond the design
                    if (n.allFinite()) centres.push_back(design.point(x, y) + r * n);
                }
            if (!flat_enough) continue;
            const auto corner = [&](int a, int b) {
                return design.point((i + a + 0.37) * step, (j + b + 0.21) * step);
            };
            const Eigen::Vector3d A = corner(0, 0), B = corner(1, 0), C = corner(1, 1);
            for (double u = 0; u <= 1.0001; u += 0.125)
                for (double v = 0; v <= u + 0.0001; v += 0.125) {
                    const Eigen::Vector3d on_triangle = A + u * (B - A) + v * (C - B);
                    max = std::max(max, std::abs(design.distance(on_triangle)));
                    double z = kInfinite;
                    for (const Eigen::Vector3d& c : centres) {
                        const double beside = (c - on_triangle).head<2>().squaredNorm();
                        if (beside < r * r) z = std::min(z, c.z() - std::sqrt(r * r - beside));
                    }
                    max = std::max(max, design.distance({on_triangle.x(), on_triangle.y(), z}));
                }
        }
    return max;
}

Design sphere(double R, bool convex)
{
    const double s = convex ? 1 : -1;
    Design design;
    design.point = [=](double x, double y) { return Eigen::Vector3d(x, y, s * std::sqrt(R * R - x * x - y * y)); };
    design.normal = [=](double x, double y) { return Eigen::Vector3d(s * design.point(x, y) / R); };
    design.distance = [=](const Eigen::Vector3d& p) { return s * (p.norm() - R); };
    design.shape = convex ? machining::DesignShape{R, kInfinite} : machining::DesignShape{kInfinite, R};
    design.extent = R;
    return design;
}

/// A torus's upper half seen from above: bulges along its crest, a hollow (of radius `inner`, less the tube) across it.
Design torus(double ring, double tube)
{
    Design design;
    const auto z = [=](double x, double y) {
        const double d = std::hypot(x, y) - ring;
        return std::sqrt(tube * tube - d * d);
    };
    design.point = [=](double x, double y) { return Eigen::Vector3d(x, y, z(x, y)); };
    design.normal = [=](double x, double y) {
        const Eigen::Vector3d axis(x / std::hypot(x, y) * ring, y / std::hypot(x, y) * ring, 0);
        return Eigen::Vector3d((Eigen::Vector3d(x, y, z(x, y)) - axis) / tube);
    };
    design.distance = [=](const Eigen::Vector3d& p) { return std::hypot(p.head<2>().norm() - ring, p.z()) - tube; };
    design.shape = {tube, ring - tube};
    design.extent = ring + tube;
    return design;
}

TEST(Spacing, TrueErrorsAreNoGreaterThanPredicted)
{
    std::vector<double> ratios;
    for (const double slope_deg : {20.0, 45.0, 60.0})
        for (int k = 0; k < 20; ++k) {
            const double tolerance = 0.002 * std::pow(1.2, k); // to 0.064 mm
            // cutters that are small in the shape, and one before which the shape is small
            for (auto [design, r] : {std::pair(sphere(25, true), 6.0),
                                     {sphere(8, true), 40.0},
                                     {sphere(25, false), 6.0},
                                     {sphere(25, false), 18.0},
                                     {torus(20, 9), 6.0}}) {
                design.shape.slope = slope_deg * std::numbers::pi / 180;
                const machining::Spacing spacing = machining::spacing_for(tolerance, r, design.shape);
                const double ratio = true_error(design, r, spacing.step) / spacing.predicted_error;
                EXPECT_LE(ratio, 1.0) << machining::to_string(spacing.kind) << " e " << tolerance << " slope "
                                      << slope_deg;
                ratios.push_back(ratio);
            }
        }
    std::sort(ratios.begin(), ratios.end());
    EXPECT_GT(ratios.front(), 0.1); // every one has met cells of the design
    EXPECT_GE(ratios[ratios.size() / 2], 0.5);
    RecordProperty("median", std::to_string(ratios[ratios.size() / 2]));
    RecordProperty("most", std::to_string(ratios.back()));
    RecordProperty("least", std::to_string(ratios.front()));
}

} // namespace discretization_test
