// Cutters that come down on a mesh: closed forms, and the greatest height over points of facets, edges and vertices.

#include "machining/drop_cutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

using namespace fettle;

namespace drop_cutter_test {

const std::vector<std::string> kCutters = {"ball:3",     "flat:3",         "bull:3,0.5",
                                           "bull:3,1.4", "taper:3,20,0.4", "taper:3,50,0"};

/// Some triangles of all sizes and slopes, over each other.
mesh::Mesh soup(unsigned seed, int count)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 3 * count);
    mesh.triangles.resize(3, count);
    for (int t = 0; t < count; ++t) {
        const Eigen::Vector3d middle(5 * unit(random), 5 * unit(random), 2 * unit(random));
        const double size = std::pow(10, unit(random));
        for (int k = 0; k < 3; ++k) {
            mesh.vertices.col(3 * t + k) = middle + size * Eigen::Vector3d(unit(random), unit(random), unit(random));
            mesh.triangles(k, t) = 3 * t + k;
        }
    }
    return mesh;
}

/// The greatest z − rise over a segment, by narrowing it down: a concave function where the cutter reaches.
double over_segment(const machining::Cutter& cutter, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                    const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d step = (b - a).head<2>(), off = xy - a.head<2>();
    double first = 0, last = 1;
    if (step.squaredNorm() > 0) {
        const double middle = off.dot(step) / step.squaredNorm(), beside = (off - middle * step).squaredNorm();
        if (beside > cutter.radius * cutter.radius) return -std::numeric_limits<double>::infinity();
        const double half = std::sqrt((cutter.radius * cutter.radius - beside) / step.squaredNorm());
        first = std::max(first, middle - half);
        last = std::min(last, middle + half);
        if (first > last) return -std::numeric_limits<double>::infinity();
    }
    const auto height = [&](double share) {
        const Eigen::Vector3d p = a + share * (b - a);
        return p.z() - machining::rise(cutter, std::min((p.head<2>() - xy).norm(), cutter.radius));
    };
    double max = std::max(height(first), height(last));
    for (int i = 0; i < 120; ++i) {
        const double p = first + (last - first) / 3, q = last - (last - first) / 3;
        const double at_p = height(p), at_q = height(q);
        max = std::max({max, at_p, at_q});
        if (at_p >= at_q) last = q;
        if (at_p <= at_q) first = p;
    }
    return max;
}

/// Height of the cutter over a triangle: the maximum over the segments from a corner to the points of the other side,
/// which is a concave function, too, where the cutter reaches all of them.
double over_triangle(const machining::Cutter& cutter, const Eigen::Matrix3d& t, const Eigen::Vector2d& xy)
{
    double max = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) max = std::max(max, over_segment(cutter, t.col(k), t.col((k + 1) % 3), xy));
    // First a scan, since not all positions are reached, then a search around the best.
    constexpr int kPlaces = 400;
    const auto height = [&](double share) {
        return over_segment(cutter, t.col(0), t.col(1) + share * (t.col(2) - t.col(1)), xy);
    };
    int best = 0;
    double found = -std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kPlaces; ++i)
        if (const double z = height(static_cast<double>(i) / kPlaces); z > found) {
            found = z;
            best = i;
        }
    double first = std::max(0, best - 1) / static_cast<double>(kPlaces),
           last = std::min(kPlaces, best + 1) / static_cast<double>(kPlaces);
    for (int i = 0; i < 80; ++i) {
        const double p = first + (last - first) / 3, q = last - (last - first) / 3;
        const double at_p = height(p), at_q = height(q);
        found = std::max({found, at_p, at_q});
        if (at_p >= at_q) last = q;
        if (at_p <= at_q) first = p;
    }
    return std::max(max, found);
}

TEST(DropCutter, AgainstBruteForce)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-5, 5);
    for (const std::string& name : kCutters) {
        const machining::Cutter cutter = machining::parse_cutter(name);
        const mesh::Mesh mesh = soup(3, 12);
        const machining::DropCutter drop(mesh, cutter);
        int met = 0;
        for (int i = 0; i < 40; ++i) {
            const Eigen::Vector2d xy(unit(random), unit(random));
            double max = -std::numeric_limits<double>::infinity();
            for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
                max = std::max(max, over_triangle(cutter, mesh.vertices.middleCols<3>(3 * t), xy));
            const auto touch = drop(xy);
            ASSERT_EQ(touch.has_value(), std::isfinite(max)) << name << " at " << xy.transpose();
            if (!touch) continue;
            EXPECT_NEAR(touch->z, max, 1e-9) << name << " at " << xy.transpose();
            ++met;
        }
        EXPECT_GT(met, 20) << name;
    }
}

TEST(DropCutter, OfManyTrianglesIsTheHighestOfEach)
{
    // Walls, level steps and bumps far from the origin, some of the triangles needles; each triangle alone is the
    // reference, so that what the search leaves out must be lower.
    constexpr int kCells = 30;
    mesh::Mesh mesh;
    mesh.vertices.resize(3, (kCells + 1) * (kCells + 1));
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i) {
            const double x = i % 7 == 0 ? i - 0.999 : i, z = j < 10 ? 2 * (i / 5 % 2) : std::sin(i) * std::cos(j / 2.0);
            mesh.vertices.col(j * (kCells + 1) + i) << 700 + x, 900 + j, 300 + z;
        }
    std::vector<Eigen::Vector3i> triangles;
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
            const int a = j * (kCells + 1) + i;
            triangles.emplace_back(a, a + 1, a + kCells + 2);
            triangles.emplace_back(a, a + kCells + 2, a + kCells + 1);
        }
    mesh.vertices.col(5) << 700 + 5, 900 - 3.84e8, 300 - 1e7; // of a damaged file
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t t = 0; t < triangles.size(); ++t) mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const std::string& name : kCutters) {
        const machining::Cutter cutter = machining::parse_cutter(name);
        const machining::DropCutter drop(mesh, cutter);
        std::vector<Eigen::Vector2d> places;
        for (int i = 0; i < 60; ++i) places.emplace_back(699 + 32 * unit(random), 899 + 32 * unit(random));
        for (int i = 0; i < 20; ++i) places.emplace_back(700 + i, 900 + i); // over vertices and sides
        std::vector<double> max(places.size(), -std::numeric_limits<double>::infinity());
        for (const Eigen::Vector3i& triangle : triangles) {
            const mesh::Mesh alone{mesh.vertices(Eigen::all, triangle), Eigen::Vector3i(0, 1, 2)};
            const machining::DropCutter on(alone, cutter);
            for (std::size_t i = 0; i < places.size(); ++i)
                if (const auto touch = on(places[i])) max[i] = std::max(max[i], touch->z);
        }
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto touch = drop(places[i]);
            ASSERT_EQ(touch.has_value(), std::isfinite(max[i]));
            if (!touch) continue;
            EXPECT_NEAR(touch->z, max[i], 1e-9) << name << " at " << places[i].transpose();
            // the cutter's lower side goes through its contact
            const double beside = std::min((touch->contact.head<2>() - places[i]).norm(), cutter.radius);
            EXPECT_NEAR(touch->contact.z(), touch->z + machining::rise(cutter, beside), 1e-6) << name;
        }
    }
}

TEST(DropCutter, OnASlopeTouchesWhereItsContactIs)
{
    mesh::Mesh plane;
    plane.vertices.resize(3, 3);
    plane.vertices << -100, 100, 0, -100, -100, 200, -75, 75, 0; // z = 3/4 x
    plane.triangles = Eigen::Vector3i(0, 1, 2);
    const Eigen::Vector3d normal(-0.6, 0, 0.8), contact(1, 2, 0.75);
    for (const char* name : {"ball:6", "flat:6", "bull:6,1", "taper:6,30,1"}) {
        const machining::Cutter cutter = machining::parse_cutter(name);
        const Eigen::Vector3d tip = machining::tip_at_contact(cutter, contact, normal);
        const auto touch = machining::DropCutter(plane, cutter)(tip.head<2>());
        EXPECT_NEAR(touch->z, tip.z(), 1e-12) << name;
        EXPECT_LT((touch->contact - contact).norm(), 1e-12) << name;
    }
    EXPECT_FALSE(machining::DropCutter(plane, machining::parse_cutter("ball:6"))({300, 0}).has_value());
}

TEST(DropCutter, OnCornersAndEdges)
{
    // A roof with its ridge along y at z = 0, slopes of 45 degrees: over the ridge the tip rests on it.
    mesh::Mesh roof;
    roof.vertices.resize(3, 6);
    roof.vertices << 0, 0, 5, 5, -5, -5, -9, 9, -9, 9, -9, 9, 0, 0, -5, -5, -5, -5;
    roof.triangles.resize(3, 4);
    roof.triangles << 0, 2, 0, 1, 2, 3, 1, 5, 1, 1, 4, 4;
    for (const std::string& name : kCutters)
        EXPECT_NEAR(machining::DropCutter(roof, machining::parse_cutter(name))({0, 0})->z, 0, 1e-12) << name;
    // A flat cutter beside the ridge still rests on it, to its rim.
    EXPECT_NEAR(machining::DropCutter(roof, machining::parse_cutter("flat:3"))({1.4, 0})->z, 0, 1e-12);
    EXPECT_NEAR(machining::DropCutter(roof, machining::parse_cutter("flat:3"))({2, 0})->z, -0.5, 1e-12);
}

} // namespace drop_cutter_test
