#include "core/direction.h"
#include "core/error.h"
#include "core/file.h"
#include "geometry/bounding_box.h"
#include "mesh/mesh_file.h"
#include "mesh/polygons.h"
#include "mesh/stl.h"
#include "own_folder.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

namespace fettle {
namespace mesh_test {

// tests/run names the folder of the samples; by hand the tests are run in the root.
std::string data(const std::string& name)
{
    const char* samples = std::getenv("SAMPLES");
    return (samples == nullptr ? "" : std::string(samples) + "/../") + "tests/data/" + name;
}

std::string message_of(const std::string& bytes)
{
    try {
        mesh::parse_mesh(bytes, "file");
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

void expect_refused(const std::string& bytes, const std::string& part, const std::string& because)
{
    const std::string message = message_of(bytes);
    EXPECT_EQ(message.find("file: "), 0u) << because << "\n  " << message;
    EXPECT_NE(message.find(part), std::string::npos) << because << "\n  " << message;
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

double area(const mesh::Mesh& mesh)
{
    double sum = 0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, t));
        const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, t));
        const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, t));
        sum += 0.5 * (b - a).cross(c - a).norm();
    }
    return sum;
}

mesh::Mesh tetrahedron()
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 4);
    mesh.vertices << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
    return mesh;
}

std::string binary_stl(const mesh::Mesh& mesh, units::Units::Length unit = units::Units::Length::mm)
{
    std::ostringstream out;
    mesh::write_stl(out, mesh, unit);
    return out.str();
}

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
const std::string kSolid = "solid part\n" + kFacet + "endsolid part\n";

TEST(Stl, WritingAndReadingIsTheIdentity)
{
    const mesh::Mesh mesh = tetrahedron();
    mesh::MeshRepair repair;
    const mesh::Mesh back = mesh::parse_mesh(binary_stl(mesh), "file", units::Units::Length::mm, &repair);
    EXPECT_EQ(back.vertices.cols(), 4);
    EXPECT_EQ(repair.welded_vertices, 8);
    EXPECT_EQ(repair.dropped_triangles, 0);
    for (Eigen::Index t = 0; t < 4; ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(back.vertices.col(back.triangles(k, t)), mesh.vertices.col(mesh.triangles(k, t)));
    EXPECT_EQ(binary_stl(back), binary_stl(mesh));
    const mesh::Mesh inches =
        mesh::parse_mesh(binary_stl(back, units::Units::Length::in), "file", units::Units::Length::in);
    EXPECT_LT((inches.vertices - back.vertices).cwiseAbs().maxCoeff(), 25.4 * 1e-7);
    EXPECT_NE(binary_stl(mesh, units::Units::Length::in).find("units in"), std::string::npos);
}

TEST(Stl, BinaryIsRecognisedBySizeNotByTheWordSolid)
{
    std::string bytes = binary_stl(tetrahedron());
    std::memcpy(bytes.data(), "solid facet ", 12);
    EXPECT_EQ(mesh::parse_mesh(bytes, "file").triangles.cols(), 4);
    bytes[84 + 48] = '\x7f'; // the attribute, where some writers keep a colour
    EXPECT_EQ(mesh::parse_mesh(bytes, "file").triangles.cols(), 4);
}

TEST(Stl, SizesThatDisagreeAreRefused)
{
    const std::string good = binary_stl(tetrahedron());
    expect_refused("", "empty", "nothing");
    expect_refused(good.substr(0, 83), "binary data of no known format, expected a mesh", "shorter than a header");
    expect_refused(good.substr(0, good.size() - 1), "4 triangles needs 284 bytes, there are 283", "short");
    expect_refused(good + "x", "there are 285", "long");
    std::string lying = good;
    lying[80] = 3;
    expect_refused(lying, "3 triangles needs 234 bytes, there are 284", "fewer than there are");
    std::memset(lying.data() + 80, 0xff, 4);
    expect_refused(lying, "4294967295 triangles", "as many as there can be");
    std::string big = good;
    std::swap(big[80], big[83]);
    expect_refused(big, "big-endian", "the other order");
    std::string none = good.substr(0, 84);
    none[80] = 0;
    expect_refused(none, "no triangles", "0 facets");
    // Who says that it is an STL is told why it is none.
    try {
        mesh::MeshRepair repair;
        mesh::parse_stl(good.substr(0, 83), "short.stl", repair);
        ADD_FAILURE() << "it has no whole header";
    } catch (const core::InputError& error) {
        EXPECT_EQ(std::string(error.what()), "short.stl: binary STL of 83 bytes, expected at least 84");
    }
}

TEST(Stl, UndefinedCornersAreDroppedAndCounted)
{
    mesh::Mesh mesh = tetrahedron();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double bad : {std::nan(""), infinite, -infinite}) {
        mesh.vertices(1, 3) = bad;
        mesh::MeshRepair repair;
        EXPECT_EQ(mesh::parse_mesh(binary_stl(mesh), "file", units::Units::Length::mm, &repair).triangles.cols(), 1);
        EXPECT_EQ(repair.dropped_triangles, 3);
    }
    mesh.vertices.setConstant(infinite);
    expect_refused(binary_stl(mesh), "no triangles but 4 with NaN", "nothing is left");
}

// A tenth of the facets are no part any more.
TEST(Stl, RemainsAreRefused)
{
    mesh::Mesh mesh;
    mesh.vertices = Eigen::Matrix3Xd::Identity(3, 4);
    mesh.vertices(0, 3) = std::nan("");
    mesh.triangles = Eigen::Matrix3Xi::Constant(3, 11, 3);
    mesh.triangles.topRows(2).setZero();
    mesh.triangles.col(0) << 0, 1, 2;
    expect_refused(binary_stl(mesh), "10 of 11 triangles have NaN or infinite corners", "one is left");
    mesh.triangles.conservativeResize(3, 10);
    EXPECT_EQ(message_of(binary_stl(mesh)), "accepted");
}

// Facets whose corners are drawn from few places, so that equal ones are near each other in the file and far apart. The
// reference: corner by corner, a map from places to numbers.
TEST(Stl, VerticesAreNumberedAsTheyFirstAppear)
{
    constexpr Eigen::Index kFacets = 30000;
    std::mt19937 random(1);
    mesh::Mesh soup;
    soup.vertices = Eigen::Matrix3Xd::Zero(3, 3 * kFacets);
    soup.triangles.resize(3, kFacets);
    for (Eigen::Index c = 0; c < 3 * kFacets; ++c) {
        const auto spread = static_cast<std::uint32_t>(c % 5 == 0 ? 20000 : 40);
        soup.vertices.col(c) << static_cast<float>(random() % spread), static_cast<float>(c / 3000), 0;
        if (random() % 1000 == 0) soup.vertices(2, c) = std::nan("");
        soup.triangles(c % 3, c / 3) = static_cast<int>(c);
    }
    std::map<std::array<double, 3>, int> numbers;
    std::vector<int> expected;
    for (Eigen::Index t = 0; t < kFacets; ++t) {
        if (!soup.vertices.middleCols(3 * t, 3).allFinite()) continue;
        for (const auto& corner : soup.vertices.middleCols(3 * t, 3).colwise())
            expected.push_back(
                numbers.emplace(std::array{corner.x(), corner.y(), corner.z()}, numbers.size()).first->second);
    }
    mesh::MeshRepair repair;
    const mesh::Mesh mesh = mesh::parse_mesh(binary_stl(soup), "file", units::Units::Length::mm, &repair);
    ASSERT_EQ(mesh.triangles.size(), static_cast<Eigen::Index>(expected.size()));
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), mesh.triangles.data()));
    ASSERT_EQ(mesh.vertices.cols(), static_cast<Eigen::Index>(numbers.size()));
    for (const auto& [place, number] : numbers)
        EXPECT_EQ(mesh.vertices.col(number), Eigen::Vector3d::Map(place.data()));
    EXPECT_EQ(repair.dropped_triangles, kFacets - mesh.triangles.cols());
    EXPECT_EQ(repair.welded_vertices, mesh.triangles.size() - mesh.vertices.cols());

    const OwnFolder folder;
    std::ofstream("soup.stl", std::ios::binary) << binary_stl(soup);
    const mesh::Mesh streamed = mesh::read_mesh("soup.stl");
    EXPECT_EQ(streamed.vertices, mesh.vertices);
    EXPECT_EQ(streamed.triangles, mesh.triangles);
}

TEST(Stl, NegativeZeroIsZero)
{
    std::string text = replaced(kSolid, "endsolid part\n", kFacet) + "endsolid\n";
    text = replaced(text, "vertex 0 0 0", "vertex -0 0.0 -0e5");
    EXPECT_EQ(mesh::parse_mesh(text, "file").vertices.cols(), 3);
}

TEST(Stl, AsciiInManyHands)
{
    EXPECT_EQ(mesh::parse_mesh(kSolid, "file").triangles.cols(), 1);
    std::string upper = kSolid;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(mesh::parse_mesh(upper, "file").triangles.cols(), 1);
    std::string dos, mac;
    for (const char c : kSolid) {
        dos += c == '\n' ? "\r\n" : std::string(1, c);
        mac += c == '\n' ? '\r' : c;
    }
    EXPECT_EQ(mesh::parse_mesh(dos, "file").triangles.cols(), 1);
    EXPECT_EQ(mesh::parse_mesh(mac, "file").triangles.cols(), 1);
    EXPECT_EQ(mesh::parse_mesh(replaced(kSolid, "normal 0 0 1", "normal nan nan nan"), "file").triangles.cols(), 1);
    EXPECT_EQ(mesh::parse_mesh(kSolid + "solid\nendsolid\n" + kSolid, "file").triangles.cols(), 2);
    mesh::MeshRepair repair;
    EXPECT_EQ(
        mesh::parse_mesh(replaced(kSolid, "endsolid", kFacet + "endsolid"), "file", units::Units::Length::mm, &repair)
            .triangles.cols(),
        2)
        << "the same face twice is the user's";
    EXPECT_EQ(repair.welded_vertices, 3);
}

TEST(Stl, MalformedAsciiIsRefusedWithItsLine)
{
    expect_refused(replaced(kSolid, "endfacet\n", ""), "line 8: expected endfacet, got 'endsolid'", "missing endfacet");
    expect_refused(replaced(kSolid, "endloop", "vertex 1 1 0\nendloop"), "line 7: expected endloop, got 'vertex'",
                   "four corners");
    expect_refused(replaced(kSolid, "vertex 1 0 0\n", ""), "line 6: expected vertex, got 'endloop'", "two corners");
    expect_refused(replaced(kSolid, "1 0 0", "1,0 0 0"), "line 5: expected a number, got '1,0'", "decimal comma");
    expect_refused(replaced(kSolid, "1 0 0", "1 0"), "line 6: expected a number, got 'vertex'", "a number missing");
    expect_refused(replaced(kSolid, "1 0 0", "1e400 0 0"), "'1e400'", "beyond double");
    expect_refused(kSolid.substr(0, kSolid.size() - 14), "the end of the file", "no endsolid");
    expect_refused(kSolid + std::string(100, '\1'), "expected solid, got '?????", "a binary tail");
    expect_refused("solid a\nendsolid a\n", "no triangles", "an empty solid");
    expect_refused("hello", "neither STL, PLY, OBJ, OFF nor 3MF", "no mesh");
    expect_refused("1 2 3\n4 5 6\n", "points, expected a mesh", "a cloud");
    expect_refused("%PDF-1.4\n", "a PDF document, expected a mesh", "a document");
}

TEST(Stl, FilesOfOthers)
{
    const mesh::Mesh boxes = mesh::read_mesh(data("two_objects_mixed_case_names.stl"));
    EXPECT_EQ(boxes.vertices.cols(), 16); // two closed boxes: 8 corners and 12 triangles each
    EXPECT_EQ(boxes.triangles.cols(), 24);
    EXPECT_EQ(mesh::read_mesh(data("soup.stl")).vertices.cols(), 300);
    EXPECT_EQ(mesh::read_mesh(data("triangle_with_empty_solid.stl")).triangles.cols(), 1);
    EXPECT_EQ(mesh::read_mesh(data("nancolor.obj")).triangles.cols(), 12);
    EXPECT_THROW(mesh::read_mesh(data("malformed.obj")), core::InputError);
    EXPECT_THROW(mesh::read_mesh(data("ply_empty_bin.ply")), core::InputError);
}

const std::string kObj = "# box\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\n";

TEST(Obj, Faces)
{
    EXPECT_DOUBLE_EQ(area(mesh::parse_mesh(kObj + "f 1 2 3 4\n", "file")), 1);
    EXPECT_DOUBLE_EQ(area(mesh::parse_mesh(kObj + "f 1/1 2/1 3/1\n", "file")), 0.5);
    EXPECT_DOUBLE_EQ(area(mesh::parse_mesh(kObj + "f 1//1 2//1 3//1\nf -4/1/1 -2/1/1 -1/1/1", "file")), 1);
    EXPECT_EQ(mesh::parse_mesh("f 1 2 3\n" + kObj, "file").triangles.cols(), 1) << "vertices may follow";
    mesh::MeshRepair repair;
    const mesh::Mesh dropped =
        mesh::parse_mesh(kObj + "v nan 0 0\nf 1 2 3\nf 1 2 5\n", "file", units::Units::Length::mm, &repair);
    EXPECT_EQ(dropped.vertices.cols(), 3);
    EXPECT_EQ(repair.dropped_triangles, 1);
    EXPECT_EQ(repair.unused_vertices, 1);
}

TEST(Obj, MalformedIsRefusedWithItsLine)
{
    expect_refused(kObj + "f 0 1 2\n", "line 9: vertex 0", "index 0");
    expect_refused(kObj + "f 1 2 5\n", "line 9: vertex 5 of 4", "past the end");
    expect_refused(kObj + "f -5 1 2\n", "line 9: vertex -5 is before the first", "before the beginning");
    expect_refused(kObj + "f 1// 2 3\n", "line 9: '1//'", "nothing after the slashes");
    expect_refused(kObj + "f 1 2\n", "line 9: a face of 2 corners", "two corners");
    expect_refused(kObj + "f 1 2 3.5\n", "'3.5'", "no whole number");
    expect_refused(kObj + "f 99999999999999999999 1 2\n", "'99999999999999999999'", "beyond 64 bits");
    expect_refused(kObj + "v 1 2\nf 1 2 3\n", "line 9: a vertex of 2 numbers", "two coordinates");
    expect_refused(kObj + "f 1 2 3\nhello\n", "line 10: unknown statement 'hello'", "no statement");
    expect_refused(kObj, "no triangles", "no faces");
}

const std::string kOff = "OFF # a square\n4 1 0\n0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n";

TEST(Off, ReadAndRefused)
{
    EXPECT_DOUBLE_EQ(area(mesh::parse_mesh(kOff, "file")), 1);
    EXPECT_DOUBLE_EQ(area(mesh::parse_mesh(replaced(kOff, "OFF # a square\n", "OFF "), "file")), 1);
    expect_refused(replaced(kOff, "4 0 1 2 3", "4 0 1 2 4"), "vertex of a face: expected a number from 0 to 3",
                   "index");
    expect_refused(replaced(kOff, "4 0 1 2 3", "4 0 1 2 -1"), "'-1'", "negative");
    expect_refused(replaced(kOff, "4 0 1 2 3 255 0 0", "2 0 1"), "a face of 2 corners", "two");
    expect_refused(replaced(kOff, "4 1 0", "99999 1 0"), "bytes left", "more than there is");
    expect_refused(replaced(kOff, "4 1 0", "4 2 0"), "the file ends", "a face missing");
    expect_refused(kOff + "3 0 1 2\n", "text after the last face", "a face more");
    expect_refused("OFF\n0 1 0\n3 4 5 9\n", "faces without a vertex", "no vertices");
    expect_refused(replaced(kOff, "OFF", "4OFF"), "'4OFF'", "another variant");
    expect_refused(replaced(kOff, "1 1 0\n0", "1 x 0\n0"), "'x' is not a number", "no number");
    expect_refused(replaced(kOff, "1 1 0\n0", "1 1 0 5\n0"), "a vertex of more than 3 numbers: '5'", "four numbers");
}

std::string ply(const std::string& count, const std::string& faces)
{
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement "
           "face " +
           count + "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + faces;
}

TEST(Ply, Faces)
{
    EXPECT_DOUBLE_EQ(area(mesh::parse_mesh(ply("1", "4 0 1 2 3\n"), "file")), 1);
    const std::string coloured = replaced(
        replaced(ply("2", "9 3 0 1 2 0.5\n8 3 0 2 3 1\n"), "property list", "property uchar red\nproperty list"),
        "end_header", "property float quality\nend_header");
    EXPECT_DOUBLE_EQ(area(mesh::parse_mesh(coloured, "file")), 1);
    std::string wheel = std::to_string(mesh::kMaxPolygonCorners + 1);
    for (std::size_t k = 0; k <= mesh::kMaxPolygonCorners; ++k) wheel += " " + std::to_string(k % 4);
    expect_refused(replaced(ply("2", "3 0 1 2\n" + wheel + "\n"), "uchar", "int"), "face 1: 4097 corners, at most 4096",
                   "too many corners");
    expect_refused(ply("1", "3 0 1 4\n"), "line 14: vertex 4 of 4", "index");
    expect_refused(ply("1", "3 0 1 -1\n"), "vertex -1 of 4", "negative");
    expect_refused(ply("1", "0\n"), "a face of 0 corners", "no corner");
    expect_refused(ply("1", "255 0 1 2\n"), "a list of 255", "longer than the line");
    expect_refused(ply("2", "3 0 1 2\n"), "element face", "a face missing");
    expect_refused(ply("0", ""), "no triangles", "no face");
    expect_refused(ply("99999999999", ""), "99999999999", "too many");
    expect_refused(replaced(ply("1", "3 0 1 2\n"), "vertex_indices", "corners"), "without the list", "no indices");
    expect_refused(replaced(ply("1", "3 0 1 2\n"), "uchar int", "uchar float"), "not integers", "float indices");
    EXPECT_TRUE(mesh::looks_like_cloud(ply("0", "")));
    EXPECT_FALSE(mesh::looks_like_cloud(ply("1", "")));
    EXPECT_FALSE(mesh::looks_like_cloud(kSolid));
    EXPECT_FALSE(mesh::looks_like_cloud(kObj));
    EXPECT_FALSE(mesh::looks_like_cloud(kOff));
    EXPECT_FALSE(mesh::looks_like_cloud(binary_stl(tetrahedron())));
    EXPECT_TRUE(mesh::looks_like_cloud("FIELDS x y z\n"));
    EXPECT_TRUE(mesh::looks_like_cloud("1 2 3\n"));
}

// The triangles of a simple polygon, concave or not, in any plane: they cover its area once, with the same orientation.
TEST(Polygons, ConcaveOnesAreCutWithinTheirEdges)
{
    std::vector<Eigen::Vector2d> star, comb, frame;
    for (int k = 0; k < 14; ++k)
        star.push_back((k % 2 == 0 ? 1.0 : 0.3) *
                       Eigen::Vector2d(std::cos(k * std::numbers::pi / 7), std::sin(k * std::numbers::pi / 7)));
    comb = {{0, 0}, {7, 0}, {7, 5}, {6, 5}, {6, 1}, {5, 1}, {5, 5}, {4, 5}, {4, 1}, {1, 1}, {1, 5}, {0, 5}};
    frame = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}; // a hole, cut open
    for (const auto& outline : {star, comb, frame}) {
        double expected = 0; // the shoelace formula
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const Eigen::Vector2d a = outline[k], b = outline[(k + 1) % outline.size()];
            expected += 0.5 * (a.x() * b.y() - a.y() * b.x());
        }
        for (const Eigen::Vector3d& normal : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1),
                                              Eigen::Vector3d(1, 0.1, 0), Eigen::Vector3d(-1, -2, 0.5)}) {
            const Eigen::Matrix3d turn = core::rotation_between(Eigen::Vector3d::UnitZ(), normal);
            Eigen::Matrix3Xd vertices(3, static_cast<Eigen::Index>(outline.size()));
            std::vector<std::uint32_t> corners;
            for (std::size_t k = 0; k < outline.size(); ++k) {
                vertices.col(static_cast<Eigen::Index>(k)) = turn * Eigen::Vector3d(outline[k].x(), outline[k].y(), 2);
                corners.push_back(static_cast<std::uint32_t>(k));
            }
            double sum = 0;
            for (const Eigen::Vector3i& t : mesh::triangulate_polygon(vertices, corners)) {
                const Eigen::Vector3d cross =
                    (vertices.col(t[1]) - vertices.col(t[0])).cross(vertices.col(t[2]) - vertices.col(t[0]));
                const double facing = 0.5 * cross.dot(normal.normalized());
                EXPECT_GT(facing, 0);
                sum += facing;
            }
            EXPECT_NEAR(sum, expected, 1e-12 * expected);
        }
    }
}

TEST(Polygons, WithoutEarsTriangulationEnds)
{
    const Eigen::Matrix3Xd line = Eigen::RowVectorXd::LinSpaced(6, 0, 5).replicate(3, 1);
    const std::vector<std::uint32_t> corners = {0, 3, 1, 5, 2, 4};
    EXPECT_EQ(mesh::triangulate_polygon(line, corners).size(), 4u);
}

TEST(Mesh, NormalsAndBox)
{
    mesh::Mesh mesh = tetrahedron();
    const Eigen::Matrix3Xd normals = mesh::triangle_normals(mesh);
    EXPECT_EQ(normals.col(0), Eigen::Vector3d(0, 0, -1));
    EXPECT_NEAR((normals.col(3) - Eigen::Vector3d::Constant(1 / std::sqrt(3))).norm(), 0, 1e-15);
    EXPECT_EQ(geometry::finite_bounding_box(mesh.vertices).max(), Eigen::Vector3d(1, 1, 1));
    mesh.vertices.col(3) = mesh.vertices.col(0);
    EXPECT_EQ(mesh::triangle_normals(mesh).col(1), Eigen::Vector3d(0, 0, 0));
}

// A triangle is the same begun at whichever corner; its back is another.
TEST(Mesh, DistinctTriangles)
{
    Eigen::Matrix3Xi triangles(3, 6), once(3, 3);
    triangles.transpose() << 4, 2, 3, 0, 2, 3, 2, 3, 4, 3, 2, 4, 4, 2, 3, 3, 4, 2;
    once.transpose() << 4, 2, 3, 0, 2, 3, 3, 2, 4;
    EXPECT_EQ(mesh::unique_triangles(triangles), once);
    EXPECT_EQ(mesh::unique_triangles(Eigen::Matrix3Xi(3, 0)).cols(), 0);
}

// Triangles with the corners of an earlier one in opposite order are found. The reference: all pairs.
TEST(Mesh, OppositeTriangles)
{
    std::mt19937 random(1);
    std::uniform_int_distribution<int> vertex(0, 9);
    Eigen::Matrix3Xi triangles(3, 2000);
    for (int& corner : triangles.reshaped()) corner = vertex(random);
    const auto turned = [](const Eigen::Vector3i& t, int by) {
        return Eigen::Vector3i(t[by % 3], t[(by + 1) % 3], t[(by + 2) % 3]);
    };
    std::vector<std::uint32_t> expected;
    for (int t = 0; t < triangles.cols(); ++t) {
        const Eigen::Vector3i a = triangles.col(t), back = a.reverse();
        if (a[0] == a[1] || a[1] == a[2] || a[2] == a[0]) continue;
        for (int first = 0; first < t; ++first) { // the first with these corners decides which side counts
            bool same = false, opposite = false;
            for (int by = 0; by < 3; ++by) {
                same |= turned(triangles.col(first), by) == a;
                opposite |= turned(triangles.col(first), by) == back;
            }
            if (opposite) expected.push_back(static_cast<std::uint32_t>(t));
            if (same || opposite) break;
        }
    }
    EXPECT_GT(expected.size(), 100u);
    EXPECT_EQ(mesh::opposite_triangles(triangles), expected);
    EXPECT_TRUE(mesh::opposite_triangles(Eigen::Matrix3Xi(3, 0)).empty());
}

// Vertices of no face would count as points of the part.
TEST(Mesh, VerticesOfNoTriangleAreDroppedAndCounted)
{
    mesh::MeshRepair repair;
    const mesh::Mesh mesh = mesh::parse_mesh("v 9 9 9\nv 0 0 0\nv 1 0 0\nv nan 0 0\nv 0 1 0\nv 5 5 5\nf 2 3 5\n",
                                             "file", units::Units::Length::mm, &repair);
    Eigen::Matrix3Xd corners(3, 3);
    corners.transpose() << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    EXPECT_EQ(mesh.vertices, corners);
    EXPECT_EQ(mesh.triangles.col(0), Eigen::Vector3i(0, 1, 2));
    EXPECT_EQ(repair.unused_vertices, 3);
    EXPECT_EQ(repair.dropped_triangles, 0);
    EXPECT_EQ(mesh::repair_warning(repair), "3 vertices of no facet left out");
    EXPECT_EQ(mesh::repair_warning({2, 5, 0}), "2 facets with NaN or infinite corners left out");
    EXPECT_EQ(mesh::repair_warning({1, 0, 1}),
              "1 facet with NaN or infinite corners and 1 vertex of no facet left out");
    EXPECT_EQ(mesh::repair_warning({}), "");
}

TEST(Mesh, BoxHoldsFinitePoints)
{
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kFar = std::numeric_limits<double>::infinity();
    Eigen::Matrix3Xd points(3, 4);
    points << 1, kNaN, 3, 0, //
        2, 9, 1, -kFar,      //
        3, 9, 5, 0;
    EXPECT_EQ(geometry::finite_bounding_box(points).min(), Eigen::Vector3d(1, 1, 3));
    EXPECT_EQ(geometry::finite_bounding_box(points).max(), Eigen::Vector3d(3, 2, 5));
    EXPECT_TRUE(geometry::finite_bounding_box(points.col(3)).min().array().isNaN().all());
    EXPECT_TRUE(geometry::finite_bounding_box(Eigen::Matrix3Xd(3, 0)).max().array().isNaN().all());
}

} // namespace mesh_test
} // namespace fettle
