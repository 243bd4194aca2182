#include "align/rigid.h"
#include "cloud/cloud.h"
#include "core/constants.h"
#include "core/error.h"
#include "place/place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace fettle {
namespace place_test {

const Eigen::Isometry3d kAway =
    Eigen::Translation3d(300, -50, 7.5) * Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized());

/// A slab's upper side with normals, 60 x 40 mm with noise of 0.02 mm, and a rib of half a cylinder on it, radius 6 mm,
/// axis along x; the slab has two thirds of the points. Moved away.
mesh::CloudMesh slab(const Eigen::Isometry3d& away)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(-1, 1);
    std::normal_distribution<double> noise(0, 0.02);
    Eigen::Matrix3Xd xyz(3, 6000), normals(3, 6000);
    for (int i = 0; i < 6000; ++i) {
        const double x = 30 * share(random);
        const double angle = std::numbers::pi / 2 * (1 + share(random));
        const double y = i % 3 == 0 ? 6 * std::cos(angle) : (share(random) < 0 ? -1 : 1) * (13 + 7 * share(random));
        normals.col(i) = i % 3 == 0 ? Eigen::Vector3d(0, std::cos(angle), std::sin(angle)) : Eigen::Vector3d(0, 0, 1);
        xyz.col(i) = Eigen::Vector3d(x, y, i % 3 == 0 ? 6 * std::sin(angle) : 0) + noise(random) * normals.col(i);
    }
    mesh::CloudMesh part;
    part.points.xyz = away * xyz.colwise().homogeneous();
    cloud::set_normals(part.points, away.linear() * normals);
    return part;
}

Eigen::Matrix3d rotation(const place::PlacedPart& placed) { return placed.transform.topLeftCorner<3, 3>(); }

TEST(Place, TheLargestPlaneFacesUp)
{
    place::PlaceRequest request;
    request.up = place::RegionShape::plane;
    request.is_centred = true;
    const place::PlacedPart placed = place::place_part(slab(kAway), request, 1);
    EXPECT_NEAR(placed.region->share, 2.0 / 3, 0.02);
    const Eigen::Vector3d up = rotation(placed) * kAway.linear().col(2);
    EXPECT_LT(std::acos(std::min(1.0, up.z())),
              0.02 / 12 / std::sqrt(4000.0) * 10); // noise over the slab's scatter, 10 sigmas
    EXPECT_NEAR((placed.transform * kAway.matrix())(2, 3), 0, 0.01);
    const Eigen::Matrix3Xd turned = cloud::normals(placed.part.points);
    EXPECT_GT(turned.row(2).minCoeff(), -1e-3); // nothing faces down
    EXPECT_TRUE(turned.colwise().norm().isOnes(1e-6));
}

TEST(Place, TheCylindersMiddleFacesUp)
{
    place::PlaceRequest request;
    request.up = place::RegionShape::cylinder;
    request.threshold = 0.08;
    const place::PlacedPart placed = place::place_part(slab(kAway), request, 1);
    EXPECT_NEAR(placed.region->radius, 6, 0.05);
    EXPECT_GT((rotation(placed) * kAway.linear().col(2)).z(),
              std::cos(0.05)); // its points fill the half circle by chance
}

TEST(Place, ACylinderSeenAllAroundHasNoUpperSide)
{
    Eigen::Matrix3Xd xyz(3, 2000), normals(3, 2000);
    for (int i = 0; i < 2000; ++i) {
        normals.col(i) << 0, std::cos(0.7 * i), std::sin(0.7 * i);
        xyz.col(i) = 5 * normals.col(i) + Eigen::Vector3d(0.02 * i, 0, 0);
    }
    mesh::CloudMesh bar;
    bar.points.xyz = xyz;
    cloud::set_normals(bar.points, normals);
    place::PlaceRequest request;
    request.up = place::RegionShape::cylinder;
    EXPECT_THROW(place::place_part(bar, request, 1), core::InputError);
}

TEST(Place, PickedPointsFaceWhereThePartDoes)
{
    const Eigen::Matrix3Xd corners = (Eigen::Matrix3Xd(3, 3) << -20, 20, 0, -15, -15, 15, 0, 0, 0).finished();
    for (const bool reversed : {false, true}) { // their order does not matter
        place::PlaceRequest request;
        Eigen::Matrix3Xd picked = corners;
        if (reversed) picked.rowwise().reverseInPlace();
        request.picked = kAway * picked.colwise().homogeneous();
        const place::PlacedPart placed = place::place_part(slab(kAway), request, 1);
        EXPECT_TRUE((rotation(placed) * kAway.linear().col(2)).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
    }
    place::PlaceRequest line;
    line.picked = (Eigen::Matrix3Xd(3, 3) << 0, 1, 2, 0, 1, 2, 0, 1, 2).finished();
    EXPECT_THROW(place::place_part(slab(kAway), line, 1), core::InputError);
}

TEST(Place, TurnsFollowTheMatrixAndTheInverseLeadsBack)
{
    place::PlaceRequest request;
    request.matrix = kAway.matrix();
    request.turns = {{0, 90 * core::kRadPerDegree}, {2, -30 * core::kRadPerDegree}};
    const mesh::CloudMesh part = slab(Eigen::Isometry3d::Identity());
    const place::PlacedPart placed = place::place_part(part, request, 25.4); // lengths of the matrix in inches
    Eigen::Isometry3d inches = kAway;
    inches.translation() *= 25.4;
    const Eigen::Isometry3d turns(Eigen::AngleAxisd(-std::numbers::pi / 6, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
    const Eigen::Matrix3Xd expected = (turns * inches) * part.points.xyz.colwise().homogeneous();
    EXPECT_LT((placed.part.points.xyz - expected).cwiseAbs().maxCoeff(), 1e-9);
    const cloud::Cloud back = cloud::transformed(placed.part.points, place::inverse_of(placed.transform), 25.4);
    EXPECT_LT((back.xyz - part.points.xyz).cwiseAbs().maxCoeff(), 1e-9);
}

} // namespace place_test
} // namespace fettle
