// Parts against closed forms: volumes of anomalies (solids of revolution, frustums), surfaces that are exact, meshes
// without cracks.

#include "geometry/bounding_box.h"
#include "own_folder.h"
#include "part/anomalies.h"
#include "part/part.h"
#include "part/refine.h"
#include "part/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>

namespace fettle {
namespace part_test {

constexpr double pi = std::numbers::pi;

part::Anomaly anomaly(const std::string& text) { return part::read_anomaly(json::Reader::parse(text, "test"), 1); }

part::PartSpec plate(const std::vector<part::Anomaly>& anomalies, double step = 0.5)
{
    part::PartSpec spec;
    spec.surface = part::AnalyticSurface{[](const Eigen::Vector2d&) { return 5.0; },
                                         {Eigen::Vector2d(-20, -15), Eigen::Vector2d(20, 15)}};
    spec.step = step;
    spec.anomalies = anomalies;
    return spec;
}

mesh::Mesh mesh_of(const part::PartSpec& spec) { return std::get<mesh::Mesh>(part::make_part(spec, 1)); }

/// Between the mesh and z = 5.
double volume_above_plate(const mesh::Mesh& mesh)
{
    double sum = 0;
    for (const Eigen::Vector3i& t : mesh.triangles.colwise()) {
        const Eigen::Vector3d a = mesh.vertices.col(t[0]), b = mesh.vertices.col(t[1]), c = mesh.vertices.col(t[2]);
        const double area = (b - a).cross(c - a).z() / 2;
        EXPECT_GT(area, -1e-12) << "a triangle faces down";
        sum += area * ((a.z() + b.z() + c.z()) / 3 - 5);
    }
    return sum;
}

/// Area between an arc and its chord.
double segment_area(double chord, double rise)
{
    const double radius = (chord * chord / 4 + rise * rise) / (2 * rise);
    const double angle = 2 * std::asin(chord / (2 * radius));
    return radius * radius * (angle - std::sin(angle)) / 2;
}

double cap_volume(double foot, double rise) { return pi * rise * (3 * foot * foot + rise * rise) / 6; }

struct Solid {
    std::string text;
    double volume;
};

class Volume : public testing::TestWithParam<Solid> {};

// Chords of 0.02 mm over anomalies 2 to 4 mm high, of which some lie inside and some outside.
TEST_P(Volume, IsThatOfTheSolid)
{
    const mesh::Mesh mesh = mesh_of(plate({anomaly(GetParam().text)}));
    EXPECT_NEAR(volume_above_plate(mesh), GetParam().volume, 0.006 * GetParam().volume);
}

INSTANTIATE_TEST_SUITE_P(
    Anomalies, Volume,
    testing::Values(
        Solid{R"({"type": "dot", "centre": [1, 2], "radius": 6, "height": 4})", cap_volume(6, 4)},
        Solid{R"({"type": "ring", "centre": [0, 0], "radius": 8, "width": 5, "height": 2})",
              2 * pi * 8 * segment_area(5, 2)},
        // A straight spine and half a cap at either end.
        Solid{R"({"type": "bead", "path": [[-10, -3], [10, 4]], "width": 5, "height": 2})",
              std::hypot(20, 7) * segment_area(5, 2) + cap_volume(2.5, 2)},
        Solid{R"({"type": "hill", "centre": [0, 1], "semi_axes": [9, 5], "angle_deg": 30, "height": 4})",
              pi * 9 * 5 * 4 / 3},
        // Frustum of a pyramid: feet of 12 x 12, walls that lean by atan(1/2), top of 8 x 8.
        Solid{
            R"({"type": "stub", "outline": {"polygon": [[-6, -6], [6, -6], [6, 6], [-6, 6]]}, "height": 4, "draft_deg": 26.565051177})",
            4.0 / 3 * (144 + 64 + 96)},
        // Round foot of 7, rises over 3: plateau, and the integral of t²(3 - 2t) over the ring.
        Solid{
            R"({"type": "blob", "outline": {"ellipse": {"centre": [0, 0], "semi_axes": [7, 7]}}, "height": 3, "falloff": 3})",
            3 * pi*(16 + 2 * 3 * (7 * 0.5 - 0.35 * 3))}));

TEST(Part, SlopedHGrowsAlongItsDirection)
{
    const part::Anomaly h =
        anomaly(R"({"type": "stub", "outline": {"letter_h": {"centre": [0, 0], "size": [20, 20], "stroke": 6}},
        "height": 2, "height_end": 4, "direction_deg": 0, "draft_deg": 5})");
    EXPECT_NEAR(h.height({-7, 0}), 2 + 2 * 3.0 / 20, 1e-12);
    EXPECT_NEAR(h.height({7, 0}), 2 + 2 * 17.0 / 20, 1e-12);
    EXPECT_EQ(h.height({0, 8}), 0); // between the legs
}

TEST(Part, MoonIsTheDiscWithoutTheBite)
{
    const part::Anomaly moon = anomaly(R"({"type": "blob", "outline": {"moon": {"centre": [0, 0], "radius": 9,
        "bite": {"centre": [5, 0], "radius": 7}}}, "height": 1, "falloff": 0.01})");
    for (double x = -10; x <= 10; x += 0.7)
        for (double y = -10; y <= 10; y += 0.7) {
            const double in_disc = 9 - std::hypot(x, y), out_of_bite = std::hypot(x - 5, y) - 7;
            if (std::abs(in_disc) < 0.05 || std::abs(out_of_bite) < 0.05) continue; // at the edge
            EXPECT_NEAR(moon.height({x, y}), in_disc > 0 && out_of_bite > 0, 1e-9) << x << ' ' << y;
        }
}

TEST(Part, RoughnessKeepsTheFootAndStaysWithinItsSize)
{
    const std::string smooth = R"({"type": "dot", "centre": [0, 0], "radius": 6, "height": 4)";
    const part::Anomaly plain = anomaly(smooth + "}");
    const part::Anomaly rough = anomaly(smooth + R"(, "roughness": {"size": 0.2, "grain": 1, "seed": 3}})");
    double min = 1, max = 1;
    for (double x = -7; x <= 7; x += 0.1)
        for (double y = -7; y <= 7; y += 0.1) {
            const double h = plain.height({x, y});
            if (h == 0) {
                EXPECT_EQ(rough.height({x, y}), 0);
                continue;
            }
            min = std::min(min, rough.height({x, y}) / h);
            max = std::max(max, rough.height({x, y}) / h);
        }
    EXPECT_GT(min, 0.8 - 1e-12);
    EXPECT_LT(max, 1.2 + 1e-12);
    EXPECT_LT(min, 0.9); // and it is rough
    EXPECT_GT(max, 1.1);
}

// No T-junction: every edge belongs to two triangles, or lies on the rim of the plate.
TEST(Part, MeshHasNoCracks)
{
    const mesh::Mesh mesh =
        mesh_of(plate({anomaly(R"({"type": "stub", "outline": {"letter_h": {"centre": [0, 0], "size": [20, 18],
        "stroke": 6, "angle_deg": 10}}, "height": 2, "draft_deg": 5})"),
                       anomaly(R"({"type": "dot", "centre": [2, 2], "radius": 5, "height": 3})")}));
    std::map<std::pair<int, int>, int> edges;
    for (const Eigen::Vector3i& t : mesh.triangles.colwise())
        for (int k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
    const auto on_rim = [&](int v) {
        const Eigen::Array2d p = mesh.vertices.col(v).head<2>().array().abs();
        return p.x() == 20 || p.y() == 15;
    };
    for (const auto& [edge, count] : edges)
        if (count != 2) {
            ASSERT_EQ(count, 1);
            ASSERT_TRUE(on_rim(edge.first) && on_rim(edge.second));
        }
}

TEST(Part, BesideTheAnomalyNothingChanges)
{
    part::PartSpec spec = plate({anomaly(R"({"type": "dot", "centre": [1, 2], "radius": 6, "height": 4})")});
    const mesh::Mesh mesh = mesh_of(spec);
    for (const Eigen::Vector3d& v : mesh.vertices.colwise()) {
        if (std::hypot(v.x() - 1, v.y() - 2) >= 6)
            EXPECT_EQ(v.z(), 5);
        else
            EXPECT_GE(v.z(), 5);
    }
}

TEST(Part, NoiseHasItsSize)
{
    part::PartSpec spec = plate({});
    spec.noise = {sampling::TouchNoise::Kind::uniform, 0.1};
    const mesh::Mesh mesh = mesh_of(spec);
    const Eigen::ArrayXd z = mesh.vertices.row(2).array() - 5;
    EXPECT_LE(z.abs().maxCoeff(), 0.1);
    // 4941 draws: standard error of the deviation 0.4 %.
    EXPECT_NEAR(std::sqrt(z.square().mean()), 0.1 / std::sqrt(3.0), 0.02 * 0.1);
}

TEST(Surface, RoundOnesHaveTheirRadius)
{
    const auto read = [](const std::string& text) {
        return part::read_part_surface(json::Reader::parse(text, "test"), 1, ".");
    };
    const part::ScalarField2d sphere = read(R"({"type": "sphere", "centre": [1, 2, 3], "radius": 10})");
    const part::ScalarField2d hollow =
        read(R"({"type": "cylinder", "point": [1, 2, 30], "direction_deg": 30, "radius": 25, "concave": true})");
    const Eigen::Vector3d axis(std::cos(pi / 6), std::sin(pi / 6), 0);
    for (double x = -4; x <= 6; ++x)
        for (double y = -3; y <= 7; ++y) {
            EXPECT_NEAR((Eigen::Vector3d(x, y, sphere({x, y})) - Eigen::Vector3d(1, 2, 3)).norm(), 10, 1e-12);
            const Eigen::Vector3d from_axis = Eigen::Vector3d(x, y, hollow({x, y})) - Eigen::Vector3d(1, 2, 30);
            EXPECT_NEAR(from_axis.cross(axis).norm(), 25, 1e-12);
            EXPECT_LT(hollow({x, y}), 30);
        }
    EXPECT_TRUE(std::isnan(sphere({12, 2})));
}

// The spline space contains every cubic, so its interpolant is the cubic.
TEST(Surface, SweptReproducesACubicSection)
{
    const auto cubic = [](double s) { return 1 + 0.3 * s - 0.05 * s * s + 0.01 * s * s * s; };
    std::string section;
    for (const double s : {-6.0, -4.0, -1.0, 0.5, 2.0, 5.0, 6.0})
        section += (section.empty() ? "" : ", ") + ("[" + std::to_string(s) + ", " + std::to_string(cubic(s)) + "]");
    const part::ScalarField2d z = part::read_part_surface(
        json::Reader::parse(R"({"type": "swept", "point": [2, 1, 7], "direction_deg": 90, "slope": 0.1, "section": [)" +
                                section + "]}",
                            "test"),
        1, ".");
    for (double s = -5.5; s < 6; s += 0.5)                             // rulings along y: s runs against x
        EXPECT_NEAR(z({2 - s, 4}), 7 + cubic(s) + 0.1 * 3, 2e-6) << s; // to_string has six decimals
    EXPECT_TRUE(std::isnan(z({10, 4})));
}

// A closed box: the anomaly is laid on its top; bottom and sides stay.
TEST(Scan, OnlyWhatIsSeenFromAboveIsLifted)
{
    const OwnFolder folder;
    std::ofstream("box.off") << "OFF\n8 6 0\n-9 -9 0\n9 -9 0\n9 9 0\n-9 9 0\n-9 -9 8\n9 -9 8\n9 9 8\n-9 9 8\n"
                                "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
    part::PartSpec spec;
    spec.surface = part::ScannedSurface{"box.off", units::Units::Length::mm, {}};
    spec.step = 0.5;
    spec.anomalies = {anomaly(R"({"type": "dot", "centre": [0, 0], "radius": 6, "height": 3})")};
    double highest = 0;
    const mesh::Mesh mesh = mesh_of(spec);
    for (const Eigen::Vector3d& v : mesh.vertices.colwise()) {
        const double r = v.head<2>().norm();
        if (v.z() < 8) {
            EXPECT_TRUE(v.z() == 0 || r > 8.9) << v.transpose();
        }
        if (r > 6 && v.z() > 8) ADD_FAILURE() << v.transpose();
        highest = std::max(highest, v.z());
    }
    EXPECT_NEAR(highest, 11, 0.02);
}

// Those of 20 x 20 squares that lie in the region are kept with their corners, and no more.
TEST(Scan, MeshIsCropped)
{
    const OwnFolder folder;
    std::ofstream file("grid.off");
    file << "OFF\n441 400 0\n";
    for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j) file << i << ' ' << j << ' ' << 0.1 * i << '\n';
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            file << "4 " << 21 * i + j << ' ' << 21 * (i + 1) + j << ' ' << 21 * (i + 1) + j + 1 << ' '
                 << 21 * i + j + 1 << '\n';
    file.close();
    part::PartSpec spec;
    spec.surface = part::ScannedSurface{"grid.off", units::Units::Length::mm,
                                        Eigen::AlignedBox2d(Eigen::Vector2d(4.5, 7), Eigen::Vector2d(10.5, 9.9))};
    spec.step = 0.5;
    const mesh::Mesh mesh = mesh_of(spec);
    EXPECT_EQ(mesh.triangles.cols(), 2 * 5 * 2);
    EXPECT_EQ(mesh.vertices.cols(), 6 * 3);
    EXPECT_EQ(geometry::finite_bounding_box(mesh.vertices).min(), Eigen::Vector3d(5, 7, 0.5));
    EXPECT_EQ(geometry::finite_bounding_box(mesh.vertices).max(), Eigen::Vector3d(10, 9, 1));
    const Eigen::Matrix3Xd normals = mesh::triangle_normals(mesh);
    for (const Eigen::Vector3d& normal : normals.colwise())
        EXPECT_LT((normal - Eigen::Vector3d(-0.1, 0, 1).normalized()).norm(), 1e-6);
}

TEST(Scan, CloudIsLiftedAndDensified)
{
    const OwnFolder folder;
    std::ofstream file("plate.xyz");
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j) file << i << ' ' << j << ' ' << 0.1 * i << '\n';
    file.close();
    part::PartSpec spec;
    spec.surface =
        part::ScannedSurface{"plate.xyz", units::Units::Length::mm,
                             Eigen::AlignedBox2d(Eigen::Vector2d(-15.5, -15.5), Eigen::Vector2d(15.5, 15.5))};
    spec.step = 0.5;
    spec.anomalies = {anomaly(R"({"type": "dot", "centre": [0, 0], "radius": 6, "height": 3})")};
    const cloud::Cloud cloud = std::get<cloud::Cloud>(part::make_part(spec, 1));
    EXPECT_GT(cloud.size(), 31 * 31 + 400); // π 6² / 0.5² = 452 points of its own, and some at the rim
    EXPECT_LT(cloud.size(), 31 * 31 + 500);
    for (const Eigen::Vector3d& p : cloud.xyz.colwise())
        EXPECT_NEAR(p.z(), 0.1 * p.x() + part::height(spec.anomalies, p.head<2>()), 1e-6) << p.transpose();
}

} // namespace part_test
} // namespace fettle
