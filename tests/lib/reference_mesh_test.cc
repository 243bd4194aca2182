#include "cube.h"

#include "compare/reference_mesh.h"
#include "compare/signed_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace fettle {
namespace {

Mesh joined(const Mesh& one, const Mesh& other)
{
    Mesh both;
    both.vertices.resize(3, one.vertices.cols() + other.vertices.cols());
    both.vertices << one.vertices, other.vertices;
    both.triangles.resize(3, one.triangles.cols() + other.triangles.cols());
    both.triangles << one.triangles, other.triangles.array() + static_cast<int>(one.vertices.cols());
    return both;
}

void turn(Mesh& mesh, int triangle) { std::swap(mesh.triangles(0, triangle), mesh.triangles(1, triangle)); }

Mesh inside_out(Mesh mesh)
{
    for (int t = 0; t < mesh.triangles.cols(); ++t) turn(mesh, t);
    return mesh;
}

double error_at(const Mesh& mesh, const Eigen::Vector3d& point, const DistanceOptions& options = {})
{
    return signed_distance(point, mesh, options).error[0];
}

TEST(ReferenceMesh, WhatIsSoundStays)
{
    const ReferenceMesh reference = reference_mesh(cube(1));
    EXPECT_EQ(reference.repair.welded_vertices, 0);
    EXPECT_EQ(reference.repair.repeated_facets, 0);
    EXPECT_EQ(reference.repair.flipped_facets, 0);
    EXPECT_EQ(reference.facets(), cube(1).triangles);
}

// Whichever few facets of a cube are wound the other way, they are turned back, and only they.
TEST(ReferenceMesh, MinorityOfWindingsIsTurned)
{
    std::mt19937 random(1);
    for (int trial = 0; trial < 50; ++trial) {
        Mesh mesh = cube(1);
        std::vector<int> facets(12);
        std::iota(facets.begin(), facets.end(), 0);
        std::shuffle(facets.begin(), facets.end(), random);
        const int wrong = 1 + trial % 5;
        for (int k = 0; k < wrong; ++k) turn(mesh, facets[static_cast<std::size_t>(k)]);
        EXPECT_EQ(reference_mesh(mesh).repair.flipped_facets, wrong);
        EXPECT_NEAR(error_at(mesh, {0.9, 0.2, 0.1}), -0.1, 1e-14);
        EXPECT_NEAR(error_at(mesh, {1.1, 0.2, 0.1}), 0.1, 1e-14);
        EXPECT_EQ(reference_mesh(mesh, Winding::keep).repair.flipped_facets, 0);
    }
}

// An open plate has no inside; the larger part of it says which way is up.
TEST(ReferenceMesh, OpenPiecesKeepTheirSide)
{
    Mesh plate;
    plate.vertices.resize(3, 5);
    plate.vertices << 0, 10, 10, 0, 12, 0, 0, 10, 10, 5, 0, 0, 0, 0, 0;
    plate.triangles.resize(3, 3);
    plate.triangles.transpose() << 0, 2, 1, 0, 3, 2, 1, 4, 2; // the large ones face down, the small one up
    EXPECT_EQ(reference_mesh(plate).repair.flipped_facets, 1);
    for (const double x : {5, 11}) {
        EXPECT_EQ(error_at(plate, {x, 5, 0.5}), -0.5);
        EXPECT_EQ(error_at(plate, {x, 5, -0.5}), 0.5);
    }
}

TEST(ReferenceMesh, ClosedPiecesAreTurnedOutsideOut)
{
    const Mesh mesh = joined(cube(1), inside_out(cube(1, {5, 0, 0})));
    EXPECT_EQ(reference_mesh(mesh).repair.flipped_facets, 12);
    EXPECT_EQ(error_at(mesh, {5, 0, 0.25}), -0.75);
    EXPECT_EQ(error_at(mesh, {0, 0, 0.25}), -0.75);
    DistanceOptions keep;
    keep.winding = Winding::keep;
    EXPECT_EQ(error_at(mesh, {5, 0, 0.25}, keep), 0.75);
}

// Nobody can tell that an open mesh is inside out but who knows the part.
TEST(ReferenceMesh, OpenMeshesAreTurnedOnRequest)
{
    Mesh mesh = inside_out(cube(1));
    mesh.triangles.conservativeResize(3, 10);
    turn(mesh, 4);
    DistanceOptions options;
    EXPECT_NEAR(error_at(mesh, {-0.9, 0.1, 0.2}, options), 0.1, 1e-14);
    options.winding = Winding::turn;
    EXPECT_NEAR(error_at(mesh, {-0.9, 0.1, 0.2}, options), -0.1, 1e-14);
    EXPECT_EQ(reference_mesh(mesh, Winding::turn).repair.flipped_facets, 9);
}

// A cavity is wound inside out by right: its surface faces the hollow.
TEST(ReferenceMesh, CavitiesStay)
{
    const Mesh mesh = joined(cube(3), inside_out(cube(1)));
    EXPECT_EQ(reference_mesh(mesh).repair.flipped_facets, 0);
    EXPECT_EQ(error_at(mesh, {0, 0, 0.25}), 0.75);
    EXPECT_EQ(error_at(mesh, {0, 0, 1.25}), -0.25);
}

TEST(ReferenceMesh, ClosedPiecesThatTouchAreNotWelded)
{
    Mesh mesh = joined(cube(1), cube(1));
    mesh.vertices.rightCols(8) *= 1 + 2e-7;
    EXPECT_EQ(reference_mesh(mesh).repair.welded_vertices, 0);
}

// A cube of separate facets whose corners differ in their last bits: 36 vertices become 8.
TEST(ReferenceMesh, CracksAreWelded)
{
    const Mesh mesh = cube(1);
    Mesh soup;
    soup.vertices.resize(3, 36);
    for (int i = 0; i < 36; ++i)
        soup.vertices.col(i) = mesh.vertices.col(mesh.triangles(i % 3, i / 3)) * (1 + (i % 3 - 1) * 6e-8);
    soup.triangles = Eigen::VectorXi::LinSpaced(36, 0, 35).reshaped(3, 12);
    EXPECT_EQ(reference_mesh(soup).repair.welded_vertices, 36 - 8);
    // Beside a sound piece, whose vertices come first and are no candidates.
    const Mesh both = joined(cube(1, {9, 0, 0}), soup);
    EXPECT_EQ(reference_mesh(both).repair.welded_vertices, 36 - 8);
    EXPECT_NEAR(error_at(both, {0.5, 0.25, 1.5}), 0.5, 1e-6);
    EXPECT_NEAR(error_at(both, {1.5, 0.25, 1.5}), std::sqrt(0.5), 1e-6);
    turn(soup, 5);
    EXPECT_EQ(reference_mesh(soup).repair.flipped_facets, 1);
}

// Facets that stand twice stand once; they are numbered as in the mesh that was given.
TEST(ReferenceMesh, RepeatedFacetsKeepTheFirstNumber)
{
    const Mesh once = cube(1);
    Mesh mesh = once;
    mesh.triangles.resize(3, 14);
    mesh.triangles << once.triangles.col(3), once.triangles(Eigen::Vector3i(1, 2, 0), 7), once.triangles;
    EXPECT_EQ(reference_mesh(mesh).repair.repeated_facets, 2);
    EXPECT_EQ(reference_mesh(mesh).repair.flipped_facets, 0);
    EXPECT_EQ(signed_distance(Eigen::Vector3d(-0.5, 0.25, 2), mesh).facet[0], 0);
    EXPECT_EQ(signed_distance(Eigen::Vector3d(2, 0.5, -0.25), mesh).facet[0], 2 + 10);
}

} // namespace
} // namespace fettle
