#include "belt/assess.h"
#include "belt/displaced_normals.h"
#include "belt/sampling.h"
#include "belt/stock.h"
#include "core/error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace fettle {
namespace surfel_test {

constexpr double kPi = std::numbers::pi;

mesh::Mesh box(const Eigen::Vector3d& min, const Eigen::Vector3d& max)
{
    mesh::Mesh mesh{Eigen::Matrix3Xd(3, 8), Eigen::Matrix3Xi(3, 12)};
    for (int i = 0; i < 8; ++i)
        mesh.vertices.col(i) << (i & 1 ? max : min).x(), (i & 2 ? max : min).y(), (i & 4 ? max : min).z();
    const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int k = 0; k < 6; ++k) {
        mesh.triangles.col(2 * k) << quads[k][0], quads[k][1], quads[k][2];
        mesh.triangles.col(2 * k + 1) << quads[k][0], quads[k][2], quads[k][3];
    }
    return mesh;
}

mesh::Mesh sphere(double radius, int rings)
{
    const int last = (rings - 1) * 2 * rings + 1; // the poles are the first vertex and the last
    const auto at = [&](int i, int j) {
        return i == 0 ? 0 : i == rings ? last : 1 + (i - 1) * 2 * rings + j % (2 * rings);
    };
    mesh::Mesh mesh{Eigen::Matrix3Xd(3, last + 1), Eigen::Matrix3Xi(3, 4 * rings * (rings - 1))};
    Eigen::Index t = 0;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < 2 * rings; ++j) {
            const double polar = kPi * i / rings, around = kPi * j / rings;
            mesh.vertices.col(at(i, j)) = radius * Eigen::Vector3d(std::sin(polar) * std::cos(around),
                                                                   std::sin(polar) * std::sin(around), std::cos(polar));
            if (i < rings - 1) mesh.triangles.col(t++) << at(i, j), at(i + 1, j), at(i + 1, j + 1);
            if (i > 0 && i < rings) mesh.triangles.col(t++) << at(i, j), at(i + 1, j + 1), at(i, j + 1);
        }
    return mesh;
}

/// A quarter of a cylinder of radius 10 about y, 20 long, by the rational quadratic that is exactly one; u from 0 to 1
/// around from +z to +x, v along -y. P_u × P_v points inward.
surface::Patch quarter_cylinder()
{
    surface::Patch patch;
    patch.degree_u = 2;
    patch.degree_v = 1;
    patch.knots_u = Eigen::VectorXd(6);
    patch.knots_u << 0, 0, 0, 1, 1, 1;
    patch.knots_v = Eigen::Vector4d(0, 0, 1, 1);
    for (auto& coordinate : patch.control) coordinate.resize(3, 2);
    patch.control[0] << 0, 0, 10, 10, 10, 10;
    patch.control[1] << 20, 0, 20, 0, 20, 0;
    patch.control[2] << 10, 10, 10, 10, 0, 0;
    patch.weights.setOnes(3, 2);
    patch.weights.row(1).setConstant(std::sqrt(0.5));
    return patch;
}

/// [0, 10] x [0, 6] in the plane z = 0, u = x, v = y.
surface::Patch plate()
{
    surface::Patch patch;
    patch.degree_u = patch.degree_v = 1;
    patch.knots_u = Eigen::Vector4d(0, 0, 10, 10);
    patch.knots_v = Eigen::Vector4d(0, 0, 6, 6);
    patch.control[0] = (Eigen::Matrix2d() << 0, 0, 10, 10).finished();
    patch.control[1] = (Eigen::Matrix2d() << 0, 6, 0, 6).finished();
    patch.control[2] = Eigen::Matrix2d::Zero();
    return patch;
}

belt::SurfelSampling spaced(double spacing)
{
    belt::SurfelSampling options;
    options.spacing = spacing;
    return options;
}

/// Distance of the nearest surfel with such a normal.
double nearest(const belt::Surfels& surfels, const Eigen::Vector3d& point, const Eigen::Vector3d& normal)
{
    double min = 1e9;
    for (Eigen::Index i = 0; i < surfels.size(); ++i)
        if (surfels.normal.col(i).dot(normal) > 0.9) min = std::min(min, (surfels.position.col(i) - point).norm());
    return min;
}

// 20 x 10 x 5 mm at 1 mm: whole cells, so 700 middles; along each of the edges, on both faces, half-millimetres: 2 x 2
// x 140. A disc inside never reaches over an edge.
TEST(SurfelSampling, of_a_box_is_counted_exactly)
{
    const belt::SampledDesign sampled = belt::sample_surfels(box({0, 0, 0}, {20, 10, 5}), spaced(1));
    EXPECT_EQ(sampled.patches, 6);
    EXPECT_EQ(sampled.edges.on_edges, 560);
    EXPECT_EQ(sampled.surfels.size(), 700 + 560);
    EXPECT_EQ(sampled.edges.shrunk, 2 * (2 * 20 + 2 * 8 + 2 * 20 + 2 * 3 + 2 * 10 + 2 * 3));
    const belt::Surfels& s = sampled.surfels;
    for (Eigen::Index i = 0; i < s.size(); ++i) {
        const Eigen::Vector3d from = s.position.col(i), to = Eigen::Vector3d(20, 10, 5) - from;
        int axis;
        EXPECT_NEAR(s.normal.col(i).cwiseAbs().maxCoeff(&axis), 1, 1e-12);
        EXPECT_NEAR(s.normal(axis, i) > 0 ? to[axis] : from[axis], 0, 1e-12);
        double border = 1e9;
        for (int k = 0; k < 3; ++k)
            if (k != axis) border = std::min({border, from[k], to[k]});
        if (i < 700)
            EXPECT_LE(s.radius[i], border + 1e-12);
        else
            EXPECT_NEAR(border, 0, 1e-12);
    }
}

// Inclined faces, and sides that are no whole number of cells: no point of a face is farther than the spacing
// from one of its surfels.
TEST(SurfelSampling, covers_every_face_of_a_turned_box)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Eigen::Vector3d size(7.3, 4.1, 2.2);
    mesh::Mesh mesh = box({0, 0, 0}, size);
    mesh.vertices = (turn * mesh.vertices).eval();
    const belt::Surfels s = belt::sample_surfels(mesh, spaced(0.5)).surfels;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {0.0, 1.0})
            for (double a = 0; a <= 1; a += 0.0625)
                for (double b = 0; b <= 1; b += 0.0625) {
                    Eigen::Vector3d point, normal = Eigen::Vector3d::Zero();
                    point[axis] = side * size[axis];
                    point[(axis + 1) % 3] = a * size[(axis + 1) % 3];
                    point[(axis + 2) % 3] = b * size[(axis + 2) % 3];
                    normal[axis] = side > 0 ? 1 : -1;
                    EXPECT_LE(nearest(s, turn * point, turn * normal), 0.5);
                }
}

// One side of a plate, L = 1: floor(1 / 0.3) = 3 new ones at 0.3, 0.6, 0.9; with e = 0.25 the fourth lands on the next
// surfel and is left out.
TEST(BoundaryResampling, inserts_what_the_paper_says)
{
    for (const auto& [e, wanted] : {std::pair(0.3, std::vector{0.0, 0.3, 0.6, 0.9, 1.0, 1.3, 1.6, 1.9}),
                                    std::pair(0.25, std::vector{0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75}),
                                    std::pair(1.0, std::vector{0.0, 1.0}), std::pair(3.0, std::vector{0.0, 1.0})}) {
        belt::EdgeCurve curve;
        curve.points = (Eigen::Matrix3Xd(3, 3) << 0, 0.7, 2, 0, 0, 0, 0, 0, 0).finished();
        curve.normals = Eigen::Vector3d::UnitZ().replicate(1, 3);
        curve.uv = curve.points.topRows<2>();
        curve.patch = 4;
        curve.spacing = 1;
        std::vector<belt::Surfel> surfels;
        EXPECT_EQ(belt::resample_boundaries(surfels, {curve}, e).on_edges, static_cast<Eigen::Index>(wanted.size()));
        ASSERT_EQ(surfels.size(), wanted.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            EXPECT_NEAR(surfels[i].position.x(), wanted[i], 1e-12) << e;
            EXPECT_EQ(surfels[i].radius, e);
            EXPECT_EQ(surfels[i].patch, 4);
        }
    }
}

TEST(BoundaryResampling, shrinks_discs_that_reach_over_the_curve)
{
    belt::EdgeCurve curve;
    curve.points = (Eigen::Matrix3Xd(3, 2) << 0, 2, 0, 0, 0, 0).finished();
    curve.normals = Eigen::Vector3d::UnitZ().replicate(1, 2);
    curve.uv = curve.points.topRows<2>();
    curve.spacing = 1;
    std::vector<belt::Surfel> surfels;
    for (const double y : {0.05, 0.3, 0.8}) surfels.push_back({{1, y, 0}, Eigen::Vector3d::UnitZ(), {1, y}, 0.5, 0});
    EXPECT_EQ(belt::resample_boundaries(surfels, {curve}, 0.25).shrunk, 1);
    ASSERT_EQ(surfels.size(), 2u + 8u); // the one nearer than e / 2 was removed
    EXPECT_NEAR(surfels[0].radius, 0.3, 1e-12);
    EXPECT_EQ(surfels[1].radius, 0.5);
}

// The mesh bends off the sphere by R (1 - cos(π / 2n)) and its normals from the radii by a few times its square.
TEST(SurfelSampling, of_a_sphere_has_its_normals_and_the_offset_of_its_stock)
{
    const int rings = 60;
    const double sagitta = 10 * (1 - std::cos(kPi / 2 / rings));
    belt::SampledDesign sampled = belt::sample_surfels(sphere(10, rings), spaced(0.8));
    belt::Surfels& s = sampled.surfels;
    EXPECT_EQ(sampled.edges.on_edges, 0);
    const belt::StockRays rays = belt::cast_rays_on_stock(s, sphere(10.4, rings), 2);
    EXPECT_EQ(rays.missed, 0);
    EXPECT_EQ(rays.multiple, 0);
    EXPECT_EQ(rays.flipped_patches, 0);
    for (Eigen::Index i = 0; i < s.size(); ++i) {
        EXPECT_GT(s.position.col(i).normalized().dot(s.normal.col(i)), std::cos(0.004));
        EXPECT_NEAR(s.displacement[i], 0.4, 0.1 * sagitta);
    }
    for (int i = 0; i < 200; ++i) { // golden-section spiral
        const double z = 1 - (2 * i + 1) / 200.0, around = kPi * (3 - std::sqrt(5)) * i, r = std::sqrt(1 - z * z);
        const Eigen::Vector3d radius(r * std::cos(around), r * std::sin(around), z);
        EXPECT_LE(nearest(s, 10 * radius, radius), 0.8);
    }
}

// A design as its own stock: displacements vanish, on the edges too, where a ray grazes the stock's faces.
TEST(StockRays, of_a_stock_without_allowance_are_zero)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(2, -1, 3).normalized()).toRotationMatrix();
    mesh::Mesh mesh = box({0, 0, 0}, {7.3, 4.1, 2.2});
    mesh.vertices = (turn * mesh.vertices).eval();
    belt::Surfels s = belt::sample_surfels(mesh, spaced(0.5)).surfels;
    EXPECT_EQ(belt::cast_rays_on_stock(s, mesh, 1).missed, 0);
    EXPECT_LT(s.displacement.cwiseAbs().maxCoeff(), 1e-5);
}

// Over a plate: one block 1 mm high over x < 4, and over x < 2 a second one from 2 to 3 mm.
TEST(StockRays, counts_no_hit_and_several)
{
    mesh::Mesh stock = box({-1, -1, -3}, {4, 7, 1});
    const mesh::Mesh above = box({-1, -1, 2}, {2, 7, 3});
    stock.vertices.conservativeResize(3, 16);
    stock.vertices.rightCols(8) = above.vertices;
    stock.triangles.conservativeResize(3, 24);
    stock.triangles.rightCols(12) = above.triangles.array() + 8;
    const belt::SampledDesign sampled = belt::sample_surfels({plate()}, spaced(1));
    for (const double reach : {5.0, 2.5}) {
        belt::Surfels s = sampled.surfels;
        const belt::StockRays rays = belt::cast_rays_on_stock(s, stock, reach);
        Eigen::Index missed = 0, several = 0;
        for (Eigen::Index i = 0; i < s.size(); ++i) {
            const double x = s.position(0, i);
            if (std::abs(x - 4) < 1e-9 || std::abs(x - 2) < 1e-9) continue; // on a wall of the stock
            EXPECT_EQ(std::isnan(s.displacement[i]), x > 4);
            if (x < 4) {
                EXPECT_NEAR(s.displacement[i], 1, 1e-9);
            }
            missed += x > 4;
            several += x < 2 && reach > 3;
        }
        EXPECT_NEAR(static_cast<double>(rays.missed - missed), 0, 4);
        EXPECT_NEAR(static_cast<double>(rays.multiple - several), 0, 4);
    }
}

TEST(SurfelSampling, of_a_rational_patch_is_exactly_on_the_cylinder)
{
    belt::SampledDesign sampled = belt::sample_surfels({quarter_cylinder()}, spaced(0.5));
    belt::Surfels& s = sampled.surfels;
    EXPECT_EQ(sampled.patches, 1);
    double largest_gap = 0;
    std::map<double, double> around; // u -> angle
    for (Eigen::Index i = 0; i < s.size(); ++i) {
        const Eigen::Vector3d p = s.position.col(i);
        EXPECT_NEAR(std::hypot(p.x(), p.z()), 10, 1e-12);
        EXPECT_LT((s.normal.col(i) + Eigen::Vector3d(p.x(), 0, p.z()) / 10).norm(), 1e-12);
        if (i + sampled.edges.on_edges < s.size()) around[s.uv(0, i)] = std::atan2(p.x(), p.z());
    }
    for (auto next = std::next(around.begin()); next != around.end(); ++next)
        largest_gap = std::max(largest_gap, 10 * (next->second - std::prev(next)->second));
    EXPECT_LE(largest_gap, 0.5);
    EXPECT_GT(largest_gap, 0.45);
    // four edges: 15.708 and 20 mm, twice, at a quarter of a millimetre
    EXPECT_EQ(sampled.edges.on_edges, 2 * (2 * 32 + 2 * 40));

    // Which side is out the stock decides: its faces x = 12 and z = 12 lie before the design.
    const mesh::Mesh stock = box({-1, -1, -1}, {12, 21, 12});
    EXPECT_EQ(belt::cast_rays_on_stock(s, stock, 8).flipped_patches, 1);
    for (Eigen::Index i = 0; i < s.size(); ++i) {
        const Eigen::Vector3d n = s.normal.col(i), p = s.position.col(i);
        const Eigen::Vector3d along = n.cwiseMax(1e-9);
        EXPECT_NEAR(s.displacement[i], std::min((12 - p.x()) / along.x(), (12 - p.z()) / along.z()), 1e-9);
    }
}

/// An eighth of the sphere of radius 10 about the origin; v = 1 is its pole, a single point.
surface::Patch eighth_of_a_sphere()
{
    surface::Patch patch;
    patch.degree_u = patch.degree_v = 2;
    patch.knots_u = patch.knots_v = (Eigen::VectorXd(6) << 0, 0, 0, 1, 1, 1).finished();
    const Eigen::Vector3d x(10, 10, 0), y(0, 10, 10), across(10, 10, 0), up(0, 10, 10), w(1, std::sqrt(0.5), 1);
    patch.control[0] = x * across.transpose() / 10;
    patch.control[1] = y * across.transpose() / 10;
    patch.control[2] = Eigen::Vector3d::Ones() * up.transpose();
    patch.weights = w * w.transpose();
    return patch;
}

// At the pole all of u is one place: the tangents say nothing of the normal there.
TEST(SurfelSampling, has_a_normal_at_a_pole)
{
    const belt::Surfels s = belt::sample_surfels({eighth_of_a_sphere()}, spaced(0.5)).surfels;
    bool at_pole = false;
    for (Eigen::Index i = 0; i < s.size(); ++i) {
        EXPECT_LT((s.normal.col(i).cwiseAbs() - s.position.col(i) / 10).norm(), 1e-4);
        at_pole = at_pole || s.uv(1, i) == 1;
    }
    EXPECT_TRUE(at_pole);
}

// Neighbours 2 √(p / κ) apart: 0.02 mm on a radius of 10 mm.
TEST(SurfelSampling, follows_the_precision_where_it_is_curved)
{
    belt::SurfelSampling options = spaced(2);
    options.precision = 0.02;
    const double wanted = 2 * std::sqrt(0.02 * 10);
    EXPECT_NEAR(belt::sample_surfels({quarter_cylinder()}, options).min_spacing, wanted, 1e-3 * wanted);
    EXPECT_EQ(belt::sample_surfels({plate()}, options).min_spacing, 2);
    EXPECT_NEAR(belt::sample_surfels(sphere(10, 60), options).min_spacing, wanted, 1e-2 * wanted);
}

// A plate with a round hole, by the trimming curves alone.
TEST(SurfelSampling, keeps_inside_the_trimming_curves)
{
    surface::Patch patch = plate();
    surface::TrimCurve outer;
    outer.knots = (Eigen::VectorXd(7) << 0, 0, 1, 2, 3, 4, 4).finished();
    outer.control = (Eigen::Matrix2Xd(2, 5) << 0, 10, 10, 0, 0, 0, 0, 6, 6, 0).finished();
    surface::TrimCurve hole;
    hole.degree = 2;
    hole.knots = (Eigen::VectorXd(12) << 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4).finished();
    hole.control = (Eigen::Matrix2Xd(2, 9) << 1, 1, 0, -1, -1, -1, 0, 1, 1, 0, 1, 1, 1, 0, -1, -1, -1, 0).finished();
    hole.control.row(0).array() += 4;
    hole.control.row(1).array() += 3;
    hole.weights = Eigen::VectorXd::Ones(9);
    for (int i = 1; i < 9; i += 2) hole.weights[i] = std::sqrt(0.5);
    patch.trim = {outer, hole};
    const belt::SampledDesign sampled = belt::sample_surfels({patch}, spaced(0.25));
    const belt::Surfels& s = sampled.surfels;
    Eigen::Index on_hole = 0;
    for (Eigen::Index i = 0; i < s.size(); ++i) {
        const double from_hole = std::hypot(s.position(0, i) - 4, s.position(1, i) - 3) - 1;
        EXPECT_GT(from_hole, -1e-4);
        if (std::abs(from_hole) < 1e-4)
            ++on_hole;
        else
            EXPECT_TRUE(s.radius[i] <= from_hole + 1e-4 || s.radius[i] == 0.125);
    }
    EXPECT_EQ(on_hole, 2 * 26); // 2 π in 26 pieces of at most 0.25
    EXPECT_EQ(sampled.edges.on_edges, 2 * 26 + 2 * 128);
    EXPECT_TRUE(std::isnan(surface::height(patch, {4, 3.5})));
    EXPECT_EQ(surface::height(patch, {4, 4.5}), 0);
}

// Two halves of a plate: no edge between them.
TEST(SurfelSampling, sees_where_patches_join_without_an_edge)
{
    surface::Patch left = plate(), right = plate();
    right.control[0].array() += 10;
    const belt::SampledDesign flat = belt::sample_surfels({left, right}, spaced(1));
    EXPECT_EQ(flat.edges.on_edges, 2 * 2 * (10 + 10 + 6));
    right.control[2].row(1).setConstant(10); // now it rises by 45 degrees
    EXPECT_EQ(belt::sample_surfels({left, right}, spaced(1)).edges.on_edges, 2 * (2 * (10 + 6) + 2 * (15 + 6)));
}

double area_of(const mesh::Mesh& mesh)
{
    double area = 0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, t));
        const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, t)) - a;
        area += b.cross(Eigen::Vector3d(mesh.vertices.col(mesh.triangles(2, t)) - a)).norm() / 2;
    }
    return area;
}

// Surfels share the design out among them: a mesh to the last digits, patches by the midpoint rule.
TEST(SurfelSampling, shares_out_the_area)
{
    const mesh::Mesh whole = box({0, 0, 0}, {20, 10, 5}), odd = box({0, 0, 0}, {7.3, 4.1, 2.2}), round = sphere(10, 60);
    for (const mesh::Mesh* mesh : {&whole, &odd, &round}) {
        const belt::Surfels s = belt::sample_surfels(*mesh, spaced(1)).surfels;
        EXPECT_NEAR(s.area.sum(), area_of(*mesh), 1e-9 * area_of(*mesh));
        EXPECT_GE(s.area.minCoeff(), 0);
        EXPECT_LE(s.area.maxCoeff(), 2);
    }
    const belt::Surfels face = belt::sample_surfels(whole, spaced(1)).surfels;
    for (Eigen::Index i = 0; i < 700; ++i) EXPECT_NEAR(face.area[i], 1, 1e-9); // a millimetre's square each
    const belt::Surfels cylinder = belt::sample_surfels({quarter_cylinder()}, spaced(0.5)).surfels;
    EXPECT_NEAR(cylinder.area.sum(), 5 * kPi * 20, 1e-3 * 100 * kPi);
}

// 20 x 10 x 5 mm with 0.3 mm more on every side: 700 mm² times 0.3 mm, and 0.3 mm too little over a stock that is
// smaller.
TEST(SurfelSampling, reports_volumes)
{
    belt::Surfels s = belt::sample_surfels(box({0, 0, 0}, {20, 10, 5}), spaced(0.7)).surfels;
    belt::cast_rays_on_stock(s, box({-0.3, -0.3, -0.3}, {20.3, 10.3, 5.3}), 2);
    const geometry::Statistics over = belt::displacement_statistics(s);
    EXPECT_NEAR(over.under_cut_volume, 210, 1e-3);
    EXPECT_NEAR(over.under_cut_area, 700, 1e-3);
    EXPECT_EQ(over.over_cut_volume, 0);
    s.displacement.array() -= 0.4;
    EXPECT_NEAR(belt::displacement_statistics(s).over_cut_volume, 70, 1e-3);
    s.area.resize(0);
    EXPECT_TRUE(std::isnan(belt::displacement_statistics(s).over_cut_volume));
}

TEST(SurfelSampling, thins_a_scan)
{
    cloud::Cloud scan;
    scan.xyz.resize(3, 101 * 101);
    for (int i = 0; i < 101; ++i)
        for (int j = 0; j < 101; ++j) scan.xyz.col(101 * i + j) << 0.1 * i, 0.1 * j, 5;
    cloud::set_normals(scan, Eigen::Vector3d::UnitZ().replicate(1, scan.size()));
    const belt::SampledDesign sampled = belt::sample_surfels(scan, "scan", spaced(0.5));
    const belt::Surfels& s = sampled.surfels;
    EXPECT_EQ(sampled.patches, 1);
    for (Eigen::Index i = 0; i < s.size(); ++i)
        for (Eigen::Index j = 0; j < i; ++j) EXPECT_GE((s.position.col(i) - s.position.col(j)).norm(), 0.5 - 1e-9);
    for (Eigen::Index k = 0; k < scan.size(); k += 7)
        EXPECT_LT(nearest(s, scan.xyz.col(k), Eigen::Vector3d::UnitZ()), 0.5);
    for (Eigen::Index i = 1; i < s.size(); ++i)
        EXPECT_NEAR((s.uv.col(i) - s.uv.col(0)).norm(), (s.position.col(i) - s.position.col(0)).norm(), 1e-9);
}

TEST(Surfels, refuse_a_normal_without_direction)
{
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Matrix3Xd::Identity(3, 2);
    cloud::set_normals(cloud, Eigen::Matrix3Xd::Identity(3, 2));
    EXPECT_EQ(belt::surfels_from_cloud(cloud, "cloud").normal, Eigen::Matrix3Xd(Eigen::Matrix3Xd::Identity(3, 2)));
    cloud::set_normals(cloud, (Eigen::Matrix3Xd(3, 2) << 1, 0, 0, 0, 0, 0).finished());
    EXPECT_THROW(belt::surfels_from_cloud(cloud, "cloud"), core::InputError);
    cloud.xyz.col(1).setConstant(NAN); // undefined positions need no normal
    EXPECT_EQ(belt::surfels_from_cloud(cloud, "cloud").size(), 2);
}

TEST(Assessment, is_by_the_range)
{
    const Eigen::VectorXd d = (Eigen::VectorXd(6) << -0.3, -0.1, 0, 0.2, 0.21, NAN).finished();
    const belt::AssessmentCounts counts = belt::count_assessments(d, {-0.1, 0.2});
    EXPECT_EQ(counts.gouge, 1);
    EXPECT_EQ(counts.within, 3);
    EXPECT_EQ(counts.undercut, 1);
    EXPECT_EQ(counts.undefined, 1);
}

// On a plate the formula is exact: D = 0.2 x + 0.3 y gives the normal (-0.2, -0.3, 1). As printed, with n × P_u for its
// last product, y has the wrong sign.
TEST(DisplacedNormals, are_exact_on_a_plane)
{
    belt::Surfels s = belt::sample_surfels({plate()}, spaced(0.5)).surfels;
    s.displacement = 0.2 * s.position.row(0).transpose() + 0.3 * s.position.row(1).transpose();
    const belt::DisplacedNormals found = belt::displaced_normals(s);
    EXPECT_EQ(found.undetermined, 0);
    EXPECT_EQ(found.above_limit, 0);
    const Eigen::Vector3d P_u = Eigen::Vector3d::UnitX(), P_v = Eigen::Vector3d::UnitY(), n = P_u.cross(P_v);
    const Eigen::Vector3d printed = (P_u.cross(P_v) + 0.2 * n.cross(P_v) + 0.3 * n.cross(P_u)).normalized();
    const Eigen::Vector3d exact = Eigen::Vector3d(-0.2, -0.3, 1).normalized();
    EXPECT_GT((printed - exact).norm(), 0.5);
    for (Eigen::Index i = 0; i < s.size(); ++i) EXPECT_LT((found.normal.col(i) - exact).norm(), 1e-9);
}

/// The largest angle between the normals of the cylinder r = 10 + D and those found, D = a (1 + sin(y) / 5 + φ / 2),
/// over the surfels that are not on the boundary.
double worst_on_cylinder(double a, double spacing, bool outward)
{
    belt::SampledDesign sampled = belt::sample_surfels({quarter_cylinder()}, spaced(spacing));
    belt::Surfels& s = sampled.surfels;
    if (outward) s.normal *= -1;
    const double side = outward ? 1 : -1;
    const auto angle = [&](Eigen::Index i) { return std::atan2(s.position(0, i), s.position(2, i)); };
    for (Eigen::Index i = 0; i < s.size(); ++i)
        s.displacement[i] = a * (1 + std::sin(s.position(1, i)) / 5 + angle(i) / 2);
    const belt::DisplacedNormals found = belt::displaced_normals(s);
    double worst = 0;
    for (Eigen::Index i = 0; i < s.size() - sampled.edges.on_edges; ++i) {
        const double phi = angle(i), y = s.position(1, i), r = 10 + side * s.displacement[i];
        const Eigen::Vector3d radial(std::sin(phi), 0, std::cos(phi)), around(std::cos(phi), 0, -std::sin(phi));
        const Eigen::Vector3d gradient =
            a * (std::cos(y) / 5 * Eigen::Vector3d::UnitY() + around / (2 * r)); // of D, on the displaced cylinder
        const Eigen::Vector3d exact = (side * (radial - side * gradient)).normalized();
        worst = std::max(worst, std::acos(std::min(1.0, exact.dot(found.normal.col(i)))));
    }
    return worst;
}

// First order in |D| times curvature: the error is the slope around times |D| / R, and follows its square as it falls.
TEST(DisplacedNormals, approach_the_exact_ones_on_a_cylinder)
{
    for (const bool outward : {true, false}) {
        const double at_half = worst_on_cylinder(0.5, 0.1, outward), at_quarter = worst_on_cylinder(0.25, 0.1, outward);
        EXPECT_LT(at_half, 0.5 * 0.5 * 0.1 * 0.2); // slope a / 20 around, |D| / R < 0.1
        EXPECT_NEAR(at_half / at_quarter, 4, 0.6);
    }
}

TEST(DisplacedNormals, warn_where_displacements_are_no_longer_small)
{
    belt::Surfels s = belt::sample_surfels({quarter_cylinder()}, spaced(0.5)).surfels;
    for (const double d : {0.9, 1.1}) {
        s.displacement.setConstant(d);
        const belt::DisplacedNormals found = belt::displaced_normals(s);
        EXPECT_NEAR(found.max_displacement_curvature, d / 10, 0.02 * d / 10);
        EXPECT_EQ(found.above_limit > 0, d > 1);
    }
}

} // namespace surfel_test
} // namespace fettle
