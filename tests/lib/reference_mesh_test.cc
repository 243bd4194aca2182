#include "cube.h"

#include "compare/reference_mesh.h"
#include "compare/signed_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace fettle {
namespace reference_mesh_test {

mesh::Mesh joined(const mesh::Mesh& one, const mesh::Mesh& other)
{
    mesh::Mesh both;
    both.vertices.resize(3, one.vertices.cols() + other.vertices.cols());
    both.vertices << one.vertices, other.vertices;
    both.triangles.resize(3, one.triangles.cols() + other.triangles.cols());
    both.triangles << one.triangles, other.triangles.array() + static_cast<int>(one.vertices.cols());
    return both;
}

void turn(mesh::Mesh& mesh, int triangle) { std::swap(mesh.triangles(0, triangle), mesh.triangles(1, triangle)); }

mesh::Mesh inside_out(mesh::Mesh mesh)
{
    for (int t = 0; t < mesh.triangles.cols(); ++t) turn(mesh, t);
    return mesh;
}

double error_at(const mesh::Mesh& mesh, const Eigen::Vector3d& point, const compare::DistanceOptions& options = {})
{
    return compare::signed_distance(point, mesh, options).error[0];
}

TEST(ReferenceMesh, WhatIsSoundStays)
{
    const compare::ReferenceMesh reference = compare::reference_mesh(cube(1));
    EXPECT_EQ(reference.repair.welded_vertices, 0);
    EXPECT_EQ(reference.repair.repeated_facets, 0);
    EXPECT_EQ(reference.repair.flipped_facets, 0);
    EXPECT_EQ(reference.facets(), cube(1).triangles);
}

// Any minority of facets of a cube with the opposite winding is flipped back, and only they.
TEST(ReferenceMesh, MinorityOfWindingsIsTurned)
{
    std::mt19937 random(1);
    for (int trial = 0; trial < 50; ++trial) {
        mesh::Mesh mesh = cube(1);
        std::vector<int> facets(12);
        std::iota(facets.begin(), facets.end(), 0);
        std::shuffle(facets.begin(), facets.end(), random);
        const int wrong = 1 + trial % 5;
        for (int k = 0; k < wrong; ++k) turn(mesh, facets[static_cast<std::size_t>(k)]);
        EXPECT_EQ(compare::reference_mesh(mesh).repair.flipped_facets, wrong);
        EXPECT_NEAR(error_at(mesh, {0.9, 0.2, 0.1}), -0.1, 1e-14);
        EXPECT_NEAR(error_at(mesh, {1.1, 0.2, 0.1}), 0.1, 1e-14);
        EXPECT_EQ(compare::reference_mesh(mesh, compare::Winding::keep).repair.flipped_facets, 0);
    }
}

// An open plate has no inside; its larger part determines the orientation.
TEST(ReferenceMesh, OpenPiecesKeepTheirSide)
{
    mesh::Mesh plate;
    plate.vertices.resize(3, 5);
    plate.vertices << 0, 10, 10, 0, 12, 0, 0, 10, 10, 5, 0, 0, 0, 0, 0;
    plate.triangles.resize(3, 3);
    plate.triangles.transpose() << 0, 2, 1, 0, 3, 2, 1, 4, 2; // the large ones face down, the small one up
    EXPECT_EQ(compare::reference_mesh(plate).repair.flipped_facets, 1);
    for (const double x : {5, 11}) {
        EXPECT_EQ(error_at(plate, {x, 5, 0.5}), -0.5);
        EXPECT_EQ(error_at(plate, {x, 5, -0.5}), 0.5);
    }
}

TEST(ReferenceMesh, ClosedPiecesAreTurnedOutsideOut)
{
    const mesh::Mesh mesh = joined(cube(1), inside_out(cube(1, {5, 0, 0})));
    EXPECT_EQ(compare::reference_mesh(mesh).repair.flipped_facets, 12);
    EXPECT_EQ(error_at(mesh, {5, 0, 0.25}), -0.75);
    EXPECT_EQ(error_at(mesh, {0, 0, 0.25}), -0.75);
    compare::DistanceOptions keep;
    keep.winding = compare::Winding::keep;
    EXPECT_EQ(error_at(mesh, {5, 0, 0.25}, keep), 0.75);
}

// That an open mesh is inside out cannot be detected without knowledge of the part.
TEST(ReferenceMesh, OpenMeshesAreTurnedOnRequest)
{
    mesh::Mesh mesh = inside_out(cube(1));
    mesh.triangles.conservativeResize(3, 10);
    turn(mesh, 4);
    compare::DistanceOptions options;
    EXPECT_NEAR(error_at(mesh, {-0.9, 0.1, 0.2}, options), 0.1, 1e-14);
    options.winding = compare::Winding::flip;
    EXPECT_NEAR(error_at(mesh, {-0.9, 0.1, 0.2}, options), -0.1, 1e-14);
    EXPECT_EQ(compare::reference_mesh(mesh, compare::Winding::flip).repair.flipped_facets, 9);
}

// A cavity is wound inside out by right: its surface faces the hollow.
TEST(ReferenceMesh, CavitiesStay)
{
    const mesh::Mesh mesh = joined(cube(3), inside_out(cube(1)));
    EXPECT_EQ(compare::reference_mesh(mesh).repair.flipped_facets, 0);
    EXPECT_EQ(error_at(mesh, {0, 0, 0.25}), 0.75);
    EXPECT_EQ(error_at(mesh, {0, 0, 1.25}), -0.25);
}

TEST(ReferenceMesh, ClosedPiecesThatTouchAreNotWelded)
{
    mesh::Mesh mesh = joined(cube(1), cube(1));
    mesh.vertices.rightCols(8) *= 1 + 2e-7;
    EXPECT_EQ(compare::reference_mesh(mesh).repair.welded_vertices, 0);
}

// A cube of separate facets whose corners differ in their last bits: 36 vertices become 8.
TEST(ReferenceMesh, CracksAreWelded)
{
    const mesh::Mesh mesh = cube(1);
    mesh::Mesh soup;
    soup.vertices.resize(3, 36);
    for (int i = 0; i < 36; ++i)
        soup.vertices.col(i) = mesh.vertices.col(mesh.triangles(i % 3, i / 3)) * (1 + (i % 3 - 1) * 6e-8);
    soup.triangles = Eigen::VectorXi::LinSpaced(36, 0, 35).reshaped(3, 12);
    EXPECT_EQ(compare::reference_mesh(soup).repair.welded_vertices, 36 - 8);
    // Beside a sound piece, whose vertices come first and are no candidates.
    const mesh::Mesh both = joined(cube(1, {9, 0, 0}), soup);
    EXPECT_EQ(compare::reference_mesh(both).repair.welded_vertices, 36 - 8);
    EXPECT_NEAR(error_at(both, {0.5, 0.25, 1.5}), 0.5, 1e-6);
    EXPECT_NEAR(error_at(both, {1.5, 0.25, 1.5}), std::sqrt(0.5), 1e-6);
    turn(soup, 5);
    EXPECT_EQ(compare::reference_mesh(soup).repair.flipped_facets, 1);
}

// A mesh drawn from both sides has one outer side: that of a closed piece is out, an open one's that of the first
// facets.
TEST(ReferenceMesh, TheSecondSideIsDropped)
{
    const auto backs = [](const mesh::Mesh& mesh) { return mesh::Mesh{mesh.vertices, inside_out(mesh).triangles}; };
    for (const mesh::Mesh& first : {cube(1), inside_out(cube(1))}) {
        mesh::Mesh both = first;
        both.triangles.resize(3, 24);
        both.triangles << first.triangles, backs(first).triangles;
        EXPECT_EQ(compare::reference_mesh(both).repair.opposite_facets, 12);
        EXPECT_EQ(error_at(both, {0.75, 0.1, 0.2}), -0.25);
        EXPECT_EQ(error_at(both, {1.25, 0.1, 0.2}), 0.25);
    }
    mesh::Mesh plate;
    plate.vertices.resize(3, 4);
    plate.vertices << 0, 10, 10, 0, 0, 0, 10, 10, 0, 0, 0, 0;
    plate.triangles.resize(3, 4);
    plate.triangles.transpose() << 0, 1, 2, 2, 1, 0, 0, 2, 3, 3, 2, 0;
    EXPECT_EQ(compare::reference_mesh(plate).repair.opposite_facets, 2);
    EXPECT_EQ(error_at(plate, {7, 3, 0.5}), 0.5);
    EXPECT_EQ(error_at(plate, {7, 3, -0.5}), -0.5);
    EXPECT_EQ(compare::signed_distance(Eigen::Vector3d(3, 7, 1), plate).facet[0], 2);
}

// Duplicate facets are removed; the others keep their numbers in the given mesh.
TEST(ReferenceMesh, RepeatedFacetsKeepTheFirstNumber)
{
    const mesh::Mesh once = cube(1);
    mesh::Mesh mesh = once;
    mesh.triangles.resize(3, 14);
    mesh.triangles << once.triangles.col(3), once.triangles(Eigen::Vector3i(1, 2, 0), 7), once.triangles;
    EXPECT_EQ(compare::reference_mesh(mesh).repair.repeated_facets, 2);
    EXPECT_EQ(compare::reference_mesh(mesh).repair.flipped_facets, 0);
    EXPECT_EQ(compare::signed_distance(Eigen::Vector3d(-0.5, 0.25, 2), mesh).facet[0], 0);
    EXPECT_EQ(compare::signed_distance(Eigen::Vector3d(2, 0.5, -0.25), mesh).facet[0], 2 + 10);
}

} // namespace reference_mesh_test
} // namespace fettle
