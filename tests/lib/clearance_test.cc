#include "robot/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace fettle {
namespace clearance_test {

using Eigen::Isometry3d, Eigen::Vector3d;

const Isometry3d kHere = Isometry3d::Identity();

robot::solid::Box box(double x, double y, double z, const Vector3d& at = Vector3d::Zero())
{
    return {Isometry3d(Eigen::Translation3d(at)), Vector3d(x, y, z) / 2};
}

mesh::Triangle triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
    mesh::Triangle t;
    t << a, b, c;
    return t;
}

double between(const robot::Solid& a, const robot::Solid& b)
{
    return robot::clearance(robot::PlacedSolid(a, kHere), robot::PlacedSolid(b, kHere)).distance;
}
double between(const robot::Solid& a, const mesh::Triangle& b)
{
    return robot::clearance(robot::PlacedSolid(a, kHere), robot::PlacedSolid(b)).distance;
}

constexpr double kTightTolerance = 2e-9;

TEST(Clearance, Spheres)
{
    const robot::solid::Sphere one = {{0, 0, 0}, 2};
    EXPECT_NEAR(between(one, robot::solid::Sphere{{3, 4, 0}, 1}), 2, kTightTolerance);
    EXPECT_NEAR(between(one, robot::solid::Sphere{{0, 0, 3}, 1}), 0, kTightTolerance);
    EXPECT_NEAR(between(one, robot::solid::Sphere{{0, 2, 0}, 1}), -1, kTightTolerance);
    EXPECT_NEAR(between(one, robot::solid::Sphere{{0, 0, 0}, 1}), -3, kTightTolerance); // enclosed, about one centre
    // face, edge, corner of a box, and with the centre inside it
    EXPECT_NEAR(between(one, box(2, 2, 2, {0, 0, 5})), 2, kTightTolerance);
    EXPECT_NEAR(between(one, box(2, 2, 2, {0, 4, 5})), 5 - 2, kTightTolerance);
    EXPECT_NEAR(between(one, box(2, 2, 2, {3, 3, 2})), 3 - 2, kTightTolerance);
    EXPECT_NEAR(between(one, box(20, 30, 6, {1, 2, 1})), -(2 + 2), kTightTolerance);
}

TEST(Clearance, Capsules)
{
    const robot::solid::Capsule one = {{0, 0, 0}, {0, 0, 10}, 1};
    EXPECT_NEAR(between(one, robot::solid::Capsule{{5, 0, 2}, {5, 0, 20}, 1}), 3, kTightTolerance);  // parallel
    EXPECT_NEAR(between(one, robot::solid::Capsule{{0, 0, 13}, {0, 0, 20}, 1}), 1, kTightTolerance); // in line
    EXPECT_NEAR(between(one, robot::solid::Capsule{{-5, 4, 5}, {5, 4, 5}, 1}), 2, kTightTolerance);  // across
    EXPECT_NEAR(between(one, robot::solid::Capsule{{-5, 0, 5}, {5, 0, 5}, 1}), -2, kTightTolerance); // axes cross
    EXPECT_NEAR(between(one, robot::solid::Capsule{{3, 0, -4}, {3, 0, -4}, 1}), 3, kTightTolerance); // one end alone
    EXPECT_NEAR(between(one, robot::solid::Capsule{{0, 0, 3}, {0, 0, 5}, 0.5}), -1.5,
                kTightTolerance); // enclosed, one axis
}

TEST(Clearance, Cylinders)
{
    const robot::solid::Cylinder one = {{0, 0, 0}, {0, 0, 10}, 2};
    EXPECT_NEAR(between(one, robot::solid::Cylinder{{6, 0, 4}, {6, 0, 14}, 1}), 3, kTightTolerance); // side by side
    EXPECT_NEAR(between(one, robot::solid::Cylinder{{0.5, 0, 13}, {0.5, 0, 20}, 1}), 3, kTightTolerance); // end to end
    EXPECT_NEAR(between(one, robot::solid::Cylinder{{6, 0, 13}, {6, 0, 14}, 1}), std::hypot(3, 3),
                kTightTolerance);                                                                      // rim to rim
    EXPECT_NEAR(between(one, robot::solid::Cylinder{{-20, 7, 5}, {20, 7, 5}, 1}), 4, kTightTolerance); // across
    EXPECT_NEAR(between(one, robot::solid::Cylinder{{2.5, 0, 0}, {2.5, 0, 10}, 1}), -0.5, 1e-6);       // sides overlap
    EXPECT_NEAR(between(one, robot::solid::Cylinder{{0.1, 0, 9.75}, {0.1, 0, 20}, 2}), -0.25, 1e-6);   // ends overlap
    EXPECT_NEAR(between(one, robot::solid::Cylinder{{0, 0, 4}, {0, 0, 5}, 1}), -3, 1e-6); // enclosed: out by the side
    // leaning by 45 degrees over a table: the lowest point is on the rim of an end
    const double c = std::sqrt(0.5);
    const robot::solid::Cylinder leaning = {{0, 0, 20}, {10 * c, 0, 20 + 10 * c}, 2};
    EXPECT_NEAR(between(leaning, box(100, 100, 10, {0, 0, -5})), 20 - 2 * c, kTightTolerance);
    EXPECT_NEAR(between(leaning, box(100, 100, 10, {0, 0, 15})), -2 * c, 1e-6);
    // a frustum, apex down, and lying on its side
    EXPECT_NEAR(between(robot::solid::Cone{{0, 0, 3}, {0, 0, 10}, 0, 5}, box(50, 50, 2, {0, 0, -1})), 3,
                kTightTolerance);
    EXPECT_NEAR(between(robot::solid::Cone{{-5, 0, 7}, {5, 0, 7}, 2, 4}, box(50, 50, 2, {0, 0, -1})), 3,
                kTightTolerance);
}

TEST(Clearance, Boxes)
{
    const robot::solid::Box one = box(4, 6, 8);
    EXPECT_NEAR(between(one, box(2, 2, 2, {6, 0, 0})), 3, kTightTolerance);
    EXPECT_NEAR(between(one, box(2, 2, 2, {6, 8, 0})), 5, kTightTolerance);
    EXPECT_NEAR(between(one, box(2, 2, 2, {3, 0, 0})), 0, kTightTolerance);
    EXPECT_NEAR(between(one, box(2, 2, 2, {2.5, 0, 0})), -0.5, kTightTolerance * 100);
    EXPECT_NEAR(between(one, box(2, 2, 2, {0, 0, 0})), -3,
                kTightTolerance * 100); // enclosed: out by the shortest translation
    // two edges that cross each other at right angles, 1 apart
    robot::solid::Box diamond = box(2, 2, 20);
    diamond.T_body_box =
        Eigen::Translation3d(2 + 1 + std::sqrt(2.0), 3, 0) * Eigen::AngleAxisd(std::numbers::pi / 4, Vector3d::UnitZ());
    EXPECT_NEAR(between(one, diamond), 1, kTightTolerance);
}

// The paper's eq. 18 takes the distance to the plane of a triangle for that to the triangle: |M| < R far beside it.
TEST(Clearance, TriangleIsNotItsPlane)
{
    const mesh::Triangle t = triangle({0, 0, 0}, {10, 0, 0}, {0, 10, 0});
    EXPECT_NEAR(between(robot::solid::Sphere{{100, 0, 1}, 6}, t), std::hypot(90, 1) - 6, kTightTolerance);
    EXPECT_NEAR(between(robot::solid::Sphere{{2, 2, 7}, 6}, t), 1, kTightTolerance);
    EXPECT_NEAR(between(robot::solid::Sphere{{2, 2, 5.99}, 6}, t), -0.01, kTightTolerance);
    EXPECT_NEAR(between(robot::solid::Sphere{{10, 10, 0}, 6}, t), std::hypot(5, 5) - 6,
                kTightTolerance); // beside the long edge
}

// Eq. 5 has no end caps: a triangle under the middle of an end is a radius away from the mantle, but touches the end.
TEST(Clearance, CylinderHasEnds)
{
    const robot::solid::Cylinder one = {{0, 0, 1}, {0, 0, 10}, 45};
    EXPECT_NEAR(between(one, triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})), 1, kTightTolerance);
    EXPECT_LT(between(one, triangle({-1, -1, 2}, {1, -1, 2}, {0, 1, 2})), -0.9); // inside, no edge crosses the mantle
}

// Eq. 16 requires the sphere's centre on a face; correct is a point of the sphere.
TEST(Clearance, SpherePiercesAFaceBesideItsCentre)
{
    EXPECT_NEAR(between(robot::solid::Sphere{{0, 0, 5}, 3}, box(10, 10, 6)), -1, kTightTolerance);
}

TEST(Clearance, DegenerateTriangles)
{
    const robot::solid::Cylinder one = {{0, 0, 0}, {0, 0, 10}, 2};
    EXPECT_NEAR(between(one, triangle({5, 0, 5}, {5, 0, 5}, {5, 0, 5})), 3, kTightTolerance);
    EXPECT_NEAR(between(one, triangle({5, -5, 5}, {5, 5, 5}, {5, 0, 5})), 3, kTightTolerance);
    EXPECT_NEAR(between(robot::solid::Sphere{{0, 0, 0}, 1}, triangle({-3, 0, 0}, {3, 0, 0}, {1, 0, 0})), -1,
                kTightTolerance);
    EXPECT_NEAR(between(box(2, 2, 2), triangle({3, -1e6, 0}, {3, 1e6, 0}, {3 + 1e-9, 0, 0})), 2, 1e-6);
}

// --- random pairs ----------------------------------------------------------------------------------------------------

class Draw {
  public:
    explicit Draw(unsigned seed) : random_(seed) {}
    double number(double min, double max) { return std::uniform_real_distribution<double>(min, max)(random_); }
    Vector3d point(double size)
    {
        return Vector3d::NullaryExpr([&] { return number(-size, size); });
    }
    Isometry3d placement(double size)
    {
        std::normal_distribution<double> normal;
        const Eigen::Vector4d q = Eigen::Vector4d::NullaryExpr([&] { return normal(random_); }).normalized();
        return Eigen::Translation3d(point(size)) * Eigen::Quaterniond(q);
    }
    robot::Solid solid()
    {
        switch (random_() % 6) {
        case 0:
            return robot::solid::Sphere{point(5), number(1, 10)};
        case 1:
            return robot::solid::Capsule{point(20), point(20), number(1, 8)};
        case 2:
            return robot::solid::Cylinder{point(20), point(20), number(1, 12)};
        case 3:
            return robot::solid::Cone{point(20), point(20), number(0, 12), number(1, 12)};
        case 4:
            return robot::solid::Box{placement(5), Vector3d(number(1, 15), number(1, 15), number(1, 15))};
        default:
            return hull();
        }
    }
    robot::solid::Hull hull()
    {
        robot::solid::Hull hull{Eigen::Matrix3Xd(3, 12)};
        for (auto p : hull.points.colwise()) p = point(12);
        return hull;
    }

  private:
    std::mt19937 random_;
};

// How far a point is outside a solid, by its own formula; hulls are left out.
double outside(const robot::Solid& solid, const Vector3d& p)
{
    const auto frustum = [&p](const Vector3d& from, const Vector3d& to, double r0, double r1) {
        const Vector3d axis = (to - from).normalized();
        const double length = (to - from).norm(), z = (p - from).dot(axis), r = (p - from - z * axis).norm();
        return std::max({-z, z - length, r - (r0 + (r1 - r0) * std::clamp(z / length, 0.0, 1.0))});
    };
    if (const auto* s = std::get_if<robot::solid::Sphere>(&solid)) return (p - s->centre).norm() - s->radius;
    if (const auto* s = std::get_if<robot::solid::Capsule>(&solid)) {
        const Vector3d d = s->to - s->from;
        const double t = std::clamp((p - s->from).dot(d) / d.squaredNorm(), 0.0, 1.0);
        return (p - s->from - t * d).norm() - s->radius;
    }
    if (const auto* s = std::get_if<robot::solid::Cylinder>(&solid))
        return frustum(s->from, s->to, s->radius, s->radius);
    if (const auto* s = std::get_if<robot::solid::Cone>(&solid))
        return frustum(s->from, s->to, s->radius_from, s->radius_to);
    if (const auto* s = std::get_if<robot::solid::Box>(&solid))
        return ((s->T_body_box.inverse() * p).cwiseAbs() - s->half).maxCoeff();
    return 0;
}

double reach(const robot::PlacedSolid& s, const Vector3d& unit) { return s.support(unit).dot(unit) + s.radius(); }

// How far the planes across a direction part the two; the shortest shift along it if they overlap.
double parted(const robot::PlacedSolid& a, const robot::PlacedSolid& b, const Vector3d& unit)
{
    return -reach(b, -unit) - reach(a, unit);
}

// Points of the two whose distance is that of two parallel planes that separate them: nothing can be nearer, and
// nothing need be farther. And depths: the planes give as much, and no direction of many gives less.
TEST(Clearance, RandomPairsAreCertain)
{
    Draw draw(7);
    int separate = 0, overlapping = 0, less_certain = 0;
    std::vector<Vector3d> directions;
    for (int i = 0; i < 4000; ++i) directions.push_back(draw.placement(1).linear().col(0));
    for (int k = 0; k < 6000; ++k) {
        const robot::Solid a = draw.solid(), b = draw.solid();
        const double size = k % 3 == 0 ? 30 : 8; // mostly near each other
        const Isometry3d T_a = draw.placement(size), T_b = draw.placement(size);
        const robot::PlacedSolid at_a(a, T_a), at_b(b, T_b);
        const robot::Clearance c = robot::clearance(at_a, at_b);
        EXPECT_NEAR(c.normal.norm(), 1, 1e-12);
        EXPECT_LT((c.on_b - c.on_a - c.distance * c.normal).norm(), 1e-6);
        EXPECT_LT(outside(a, T_a.inverse() * c.on_a), 1e-6);
        EXPECT_LT(outside(b, T_b.inverse() * c.on_b), 1e-6);
        const double planes = parted(at_a, at_b, c.normal);
        if (c.distance > 0) {
            ++separate;
            EXPECT_NEAR(planes, c.distance, robot::kClearanceAccuracy) << a.index() << " " << b.index();
            if (std::abs(planes - c.distance) > 1e-8) ++less_certain;
            const robot::Clearance lazy = robot::clearance(at_a, at_b, 5);
            if (c.distance > 5)
                EXPECT_TRUE(lazy.distance > 5 && lazy.distance <= c.distance + robot::kClearanceAccuracy);
            else
                EXPECT_NEAR(lazy.distance, c.distance, robot::kClearanceAccuracy);
        } else {
            ++overlapping;
            EXPECT_NEAR(planes, c.distance, robot::kClearanceAccuracy) << a.index() << " " << b.index();
            if (std::abs(planes - c.distance) > 2e-7) ++less_certain;
            if (k % 10 != 0) continue;
            for (const Vector3d& direction : directions) EXPECT_LE(parted(at_a, at_b, direction), c.distance + 2e-7);
        }
        EXPECT_NEAR(robot::clearance(at_b, at_a).distance, c.distance, 2 * robot::kClearanceAccuracy);
    }
    EXPECT_LE(less_certain, 6); // of 6000
    EXPECT_GT(separate, 1500);
    EXPECT_GT(overlapping, 1500);
}

// Depth of two polytopes by the separating axis theorem: all normals of faces and all products of edges.
TEST(Clearance, DepthsOfBoxesBySeparatingAxes)
{
    Draw draw(8);
    int overlapping = 0;
    for (int k = 0; k < 3000; ++k) {
        const robot::solid::Box a = {draw.placement(2),
                                     Vector3d(draw.number(1, 9), draw.number(1, 9), draw.number(1, 9))};
        const robot::solid::Box b = {draw.placement(2),
                                     Vector3d(draw.number(1, 9), draw.number(1, 9), draw.number(1, 9))};
        const Isometry3d T_b = draw.placement(8);
        const robot::PlacedSolid at_a(a, kHere), at_b(b, T_b);
        const double distance = robot::clearance(at_a, at_b).distance;
        const Eigen::Matrix3d A = a.T_body_box.linear(), B = T_b.linear() * b.T_body_box.linear();
        double best = -INFINITY;
        const auto try_axis = [&](const Vector3d& axis) {
            if (axis.norm() < 1e-9) return;
            for (const double sign : {1.0, -1.0}) best = std::max(best, parted(at_a, at_b, sign * axis.normalized()));
        };
        for (int i = 0; i < 3; ++i) {
            try_axis(A.col(i));
            try_axis(B.col(i));
            for (int j = 0; j < 3; ++j) try_axis(A.col(i).cross(B.col(j)));
        }
        EXPECT_EQ(distance < 0, best < 0);
        if (best >= 0) continue;
        ++overlapping;
        EXPECT_NEAR(distance, best, 2e-7);
    }
    EXPECT_GT(overlapping, 1000);
}

// Reference: the distance of a point to a triangle, for points spread over the solid's core.
TEST(Clearance, TrianglesAgainstPoints)
{
    Draw draw(9);
    for (int k = 0; k < 3000; ++k) {
        const mesh::Triangle t = triangle(draw.point(20), draw.point(20), draw.point(20));
        const Vector3d centre = draw.point(30);
        EXPECT_NEAR(between(robot::solid::Sphere{centre, 3}, t),
                    std::sqrt(mesh::closest_on_triangle(t, centre).squared_distance) - 3, kTightTolerance);
        const robot::solid::Capsule capsule = {draw.point(30), draw.point(30), 3};
        double min = INFINITY; // golden section along the axis: the distance is convex
        double from = 0, to = 1;
        const auto at = [&](double s) {
            return std::sqrt(
                mesh::closest_on_triangle(t, capsule.from + s * (capsule.to - capsule.from)).squared_distance);
        };
        for (int i = 0; i < 100; ++i) {
            const double p = from + 0.381966 * (to - from), q = to - 0.381966 * (to - from);
            (at(p) < at(q) ? to : from) = at(p) < at(q) ? q : p;
            min = std::min({min, at(p), at(q)});
        }
        if (min > 1e-6)
            EXPECT_NEAR(between(capsule, t), min - 3, 1e-6);
        else // the axis pierces the triangle
            EXPECT_LE(between(capsule, t), -3 + kTightTolerance);
    }
}

// A point's signed distance is that of a tiny triangle there; as a function of the point it is convex, so that it lies
// above its tangent plane at any other point.
TEST(Clearance, PointsAndTangentPlanes)
{
    Draw draw(11);
    for (int k = 0; k < 2000; ++k) {
        const robot::Solid s = draw.solid();
        const robot::PlacedSolid placed(s, draw.placement(10));
        const Vector3d p = draw.point(25), q = draw.point(25);
        const robot::PointDistance at = placed.signed_distance(p);
        const double by_search = robot::clearance(placed, robot::PlacedSolid(triangle(p, p, p))).distance;
        EXPECT_NEAR(at.value, by_search, robot::kClearanceAccuracy) << s.index();
        EXPECT_NEAR(at.gradient.norm(), 1, 1e-9);
        EXPECT_GE(placed.signed_distance(q).value, at.value + at.gradient.dot(q - p) - robot::kClearanceAccuracy)
            << s.index();
    }
}

// The found point lies on the triangle, at the reported distance from the solid, and no other one is nearer: neither
// one of many nor what steps from the best of these lead to. A third of the triangles are across the axis, along it or
// needles.
TEST(RoundSolid, NoPointOfATriangleIsNearer)
{
    Draw draw(12);
    int deep = 0;
    for (int k = 0; k < 3000; ++k) {
        robot::Solid s = draw.solid();
        while (s.index() > 3) s = draw.solid();
        const robot::PlacedSolid placed(s, kHere);
        const robot::RoundSolid round = std::get<robot::RoundSolid>(placed.primitive_shape());
        const double size = k % 2 == 0 ? 25 : 5;
        mesh::Triangle t = triangle(draw.point(size), draw.point(size), draw.point(size));
        if (k % 9 == 0)
            t = (round.T.linear().leftCols<2>() * t.topRows<2>()).colwise() + Vector3d(round.T * Vector3d(0, 0, 1));
        if (k % 9 == 1) t.col(2) = t.col(1) + round.T.linear().col(2) * draw.number(-5, 5);
        if (k % 9 == 2) t.col(2) = t.col(0) + (t.col(1) - t.col(0)) * draw.number(0, 1);
        const auto found = robot::nearest_point_of_triangle(round, t, INFINITY);
        ASSERT_TRUE(found);
        EXPECT_NEAR(placed.signed_distance(found->point).value, found->distance, 1e-9) << s.index();
        EXPECT_LT(mesh::closest_on_triangle(t, found->point).squared_distance, 1e-18);
        Vector3d best(1, 1, 1);
        const auto at = [&](const Vector3d& weight) { return placed.signed_distance(t * weight / weight.sum()).value; };
        for (int i = 0; i <= 20; ++i)
            for (int j = 0; j <= 20 - i; ++j)
                if (const Vector3d w(i, j, 20 - i - j); at(w) < at(best)) best = w;
        best /= best.sum();
        for (double step = 0.05; step > 1e-9; step /= 2)
            for (int turn = 0; turn < 6; ++turn)
                if (const Vector3d w =
                        (best + step * Vector3d::NullaryExpr([&] { return draw.number(-1, 1); })).cwiseMax(0);
                    w.sum() > 0 && at(w) < at(best))
                    best = w / w.sum();
        EXPECT_LE(found->distance, at(best) + robot::kFootAccuracy) << s.index() << " " << k;
        EXPECT_FALSE(robot::nearest_point_of_triangle(round, t, found->distance));
        if (found->distance < 0) ++deep;
    }
    EXPECT_GT(deep, 600);
    EXPECT_LT(deep, 2400);
}

TEST(Clearance, BoxesHoldTheirSolids)
{
    Draw draw(10);
    for (int k = 0; k < 200; ++k) {
        const robot::Solid s = draw.solid();
        const robot::PlacedSolid placed(s, draw.placement(30));
        const Eigen::AlignedBox3d around = placed.bounding_box();
        for (int i = 0; i < 50; ++i) {
            const Vector3d d = draw.placement(1).linear().col(0);
            EXPECT_LT(around.exteriorDistance(placed.support(d) + placed.radius() * d), 1e-9);
        }
        for (Eigen::Index axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(reach(placed, Vector3d::Unit(axis)), around.max()[axis], 1e-9);
    }
}

} // namespace clearance_test
} // namespace fettle
