// Polygons of a job, and the stretches of a line inside them. References: drawn by hand; brute force by sampling.
#include "job/boundary.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace fettle {
namespace boundary_test {

using Intervals = std::vector<job::Interval>;

job::Polygon polygon(std::initializer_list<Eigen::Vector2d> corners)
{
    job::Polygon result(2, static_cast<Eigen::Index>(corners.size()));
    Eigen::Index i = 0;
    for (const Eigen::Vector2d& corner : corners) result.col(i++) = corner;
    return result;
}

const job::Polygon kSquare = polygon({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
// a U, open above
const job::Polygon kMoon = polygon({{0, 0}, {6, 0}, {6, 4}, {4, 4}, {4, 2}, {2, 2}, {2, 4}, {0, 4}});

job::Job job_of(const job::Polygon& anomaly, const job::Polygon& sampling,
                job::SurfaceType surface = job::SurfaceType::freeform)
{
    job::Job job;
    job.source = "job.json";
    job.surface = surface;
    job.anomaly = Eigen::Matrix3Xd::Zero(3, anomaly.cols());
    job.anomaly.topRows<2>() = anomaly;
    job.sampling = Eigen::Matrix3Xd::Zero(3, sampling.cols());
    job.sampling.topRows<2>() = sampling;
    return job;
}

std::string problem(const job::Job& job)
{
    try {
        job::working_boundaries(job);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Inside, ConvexPolygon)
{
    EXPECT_EQ(job::intervals_inside(kSquare, {-1, 1}, {1, 0}), (Intervals{{1, 5}}));
    EXPECT_EQ(job::intervals_inside(kSquare, {5, 1}, {-1, 0}), (Intervals{{1, 5}}));
    EXPECT_EQ(job::intervals_inside(kSquare, {0, 5}, {1, 0}), Intervals{});
}

TEST(Inside, NonConvexPolygonHasSeveralStretches)
{
    EXPECT_EQ(job::intervals_inside(kMoon, {0, 3}, {1, 0}), (Intervals{{0, 2}, {4, 6}}));
    EXPECT_EQ(job::intervals_inside(kMoon, {1, 0}, {0, 1}), (Intervals{{0, 4}}));
    EXPECT_EQ(job::intervals_inside(kMoon, {3, 0}, {0, 1}), (Intervals{{0, 2}}));
}

TEST(Inside, EdgeAlongTheLineBelongsToIt)
{
    EXPECT_EQ(job::intervals_inside(kSquare, {0, 4}, {1, 0}), (Intervals{{0, 4}}));
    EXPECT_EQ(job::intervals_inside(kSquare, {0, 0}, {1, 0}), (Intervals{{0, 4}}));
    EXPECT_EQ(job::intervals_inside(kMoon, {0, 2}, {1, 0}), (Intervals{{0, 6}}));         // floor of the bay
    EXPECT_EQ(job::intervals_inside(kMoon, {0, 4}, {1, 0}), (Intervals{{0, 2}, {4, 6}})); // tips of the horns
}

TEST(Inside, TouchedCornerGivesNothing)
{
    const job::Polygon diamond = polygon({{0, -1}, {1, 0}, {0, 1}, {-1, 0}});
    EXPECT_EQ(job::intervals_inside(diamond, {-5, 1}, {1, 0}), Intervals{});
    EXPECT_EQ(job::intervals_inside(diamond, {-5, 0}, {1, 0}), (Intervals{{4, 6}})); // through two corners
    // a reflex corner on the line does not cut the stretch in two
    const job::Polygon notched = polygon({{0, 0}, {4, 0}, {4, 4}, {2, 2}, {0, 4}});
    EXPECT_EQ(job::intervals_inside(notched, {0, 2}, {1, 0}), (Intervals{{0, 4}}));
}

TEST(Inside, SmallRotationsDoNotLoseAnEdge)
{
    for (int degrees = 1; degrees < 360; degrees += 7) {
        const Eigen::Matrix2d turn = job::rotation_working_machine(degrees * std::numbers::pi / 180);
        const job::Polygon turned = turn * (kMoon.colwise() + Eigen::Vector2d(100, 50));
        const Intervals found =
            job::intervals_inside(turned, turn * Eigen::Vector2d(100, 54), turn * Eigen::Vector2d(1, 0));
        ASSERT_EQ(found.size(), 2u) << degrees;
        EXPECT_NEAR(found[0].second, 2, 1e-12);
        EXPECT_NEAR(found[1].second, 6, 1e-12);
    }
}

TEST(Inside, AgreesWithPointInPolygonOnRandomStars)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int trial = 0; trial < 200; ++trial) {
        job::Polygon star(2, 9);
        for (int i = 0; i < 9; ++i) {
            const double angle = 2 * std::numbers::pi * i / 9, r = 1 + 3 * uniform(random);
            star.col(i) << r * std::cos(angle), r * std::sin(angle);
        }
        const double angle = 6.3 * uniform(random);
        const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
        const Eigen::Vector2d origin(uniform(random), uniform(random));
        const Intervals found = job::intervals_inside(star, origin, direction);
        for (int k = 0; k < 100; ++k) {
            const double t = 10 * uniform(random) - 5;
            bool in = false;
            for (const job::Interval& stretch : found) in |= stretch.first <= t && t <= stretch.second;
            EXPECT_EQ(in, job::contains(star, origin + t * direction)) << trial << ' ' << t;
        }
    }
}

TEST(Intervals, SubtractAndIntersect)
{
    const Intervals a = {{0, 4}, {6, 10}}, b = {{1, 2}, {3, 7}};
    EXPECT_EQ(job::subtract(a, b), (Intervals{{0, 1}, {2, 3}, {7, 10}}));
    EXPECT_EQ(job::intersect(a, b), (Intervals{{1, 2}, {3, 4}, {6, 7}}));
    EXPECT_EQ(job::subtract(a, b, 2), (Intervals{{7, 10}}));
    EXPECT_EQ(job::intersect(a, b, 1.5), Intervals{});
    EXPECT_EQ(job::subtract(a, {}), a);
    EXPECT_EQ(job::subtract(a, {{-1, 20}}), Intervals{});
    EXPECT_EQ(job::intersect({{0, 1}}, {{1, 2}}), Intervals{}); // touching is not overlapping
}

TEST(Polygon, ContainsItsEdge)
{
    EXPECT_TRUE(job::contains(kMoon, {1, 3}));
    EXPECT_FALSE(job::contains(kMoon, {3, 3}));
    EXPECT_TRUE(job::contains(kMoon, {3, 2}));
    EXPECT_TRUE(job::contains(kMoon, {6, 4}));
    EXPECT_FALSE(job::contains(kMoon, {6.0001, 4}));
}

TEST(Polygon, AreaHullDistance)
{
    EXPECT_DOUBLE_EQ(job::area(kMoon), 20);
    EXPECT_DOUBLE_EQ(job::area(job::Polygon(kMoon.colwise() + Eigen::Vector2d(1e5, 1e5))), 20);
    EXPECT_DOUBLE_EQ(job::area(job::convex_hull(kMoon)), 24);
    EXPECT_EQ(job::convex_hull(kMoon).cols(), 4);
    EXPECT_DOUBLE_EQ(job::distance_to_edge(kMoon, {3, 3}), 1);
    EXPECT_DOUBLE_EQ(job::distance_to_edge(kMoon, {9, 8}), 5);
}

TEST(Boundaries, ClockwiseIsTurnedAndClosingPointDropped)
{
    const job::Polygon clockwise = polygon({{1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}});
    const job::Boundaries found = job::working_boundaries(job_of(clockwise, kSquare));
    ASSERT_EQ(found.anomaly.cols(), 4);
    const Eigen::Vector2d first = found.anomaly.col(1) - found.anomaly.col(0);
    const Eigen::Vector2d second = found.anomaly.col(2) - found.anomaly.col(1);
    EXPECT_GT(first.x() * second.y() - first.y() * second.x(), 0);
}

TEST(Boundaries, AreInTheWorkingFrame)
{
    job::Job job = job_of(polygon({{1, 1}, {2, 1}, {2, 2}, {1, 2}}), kSquare);
    job.theta = std::numbers::pi / 2;
    EXPECT_TRUE(job::working_boundaries(job).sampling.isApprox(polygon({{0, 0}, {0, -4}, {4, -4}, {4, 0}}), 1e-15));
}

TEST(Boundaries, RefusesBadPolygons)
{
    const job::Polygon small = polygon({{1, 1}, {2, 1}, {2, 2}, {1, 2}});
    EXPECT_EQ(problem(job_of(small, kSquare)), "accepted");
    EXPECT_EQ(problem(job_of(polygon({{1, 1}, {2, 1}}), kSquare)),
              "job.json: anomaly: 2 boundary points, at least 3 are needed");
    EXPECT_EQ(problem(job_of(polygon({{1, 1}, {2, 1}, {1, 1}, {1, 1}}), kSquare)),
              "job.json: anomaly: only 2 different boundary points, at least 3 are needed");
    EXPECT_EQ(problem(job_of(polygon({{1, 1}, {2, 2}, {2, 1}, {1, 2}}), kSquare)),
              "job.json: anomaly: the boundary crosses itself at (1.5, 1.5) mm");
    EXPECT_EQ(problem(job_of(small, polygon({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 0}, {2, 4}, {0, 4}}))),
              "job.json: sampling: the boundary crosses itself at (3, 0) mm");
    // there and back on the same line
    EXPECT_EQ(problem(job_of(polygon({{1, 1}, {2, 1}, {3, 1}, {2, 1}, {2, 2}}), kSquare)),
              "job.json: anomaly: the boundary crosses itself at (2, 1) mm");
    EXPECT_EQ(problem(job_of(polygon({{1, 1}, {2, 2}, {3, 3}}), kSquare)),
              "job.json: anomaly: the boundary encloses no area, near (1, 1) mm");
    EXPECT_EQ(problem(job_of(polygon({{1, 1}, {9, 1}, {2, 2}}), kSquare)),
              "job.json: anomaly: not inside the sampling boundary's convex hull, at (9, 1) mm");
    EXPECT_EQ(problem(job_of(kSquare, small)),
              "job.json: anomaly: not inside the sampling boundary's convex hull, at (4, 4) mm");
    EXPECT_EQ(problem(job_of(kSquare, kSquare)),
              "job.json: sampling: no room between anomaly and sampling boundary, near (0, 0) mm");
    job::Job unknown = job_of(small, kSquare);
    unknown.sampling(1, 2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(problem(unknown), "job.json: sampling: a boundary point without x and y");
}

TEST(Boundaries, ReportsPlacesInTheJobsUnits)
{
    job::Job job = job_of(25.4 * polygon({{1, 1}, {2, 2}, {2, 1}, {1, 2}}), 25.4 * kSquare);
    job.units.length = units::Units::Length::in;
    EXPECT_EQ(problem(job), "job.json: anomaly: the boundary crosses itself at (1.5, 1.5) in");
}

TEST(Boundaries, FreeformNeedsTheHullOnly)
{
    const job::Polygon in_the_bay = polygon({{2.5, 2.5}, {3.5, 2.5}, {3, 3.5}});
    EXPECT_EQ(problem(job_of(in_the_bay, kMoon)), "accepted");
    EXPECT_EQ(problem(job_of(in_the_bay, kMoon, job::SurfaceType::swept)),
              "job.json: anomaly: not inside the sampling boundary, at (3, 3.5) mm");
}

TEST(Boundaries, AnomalyMayTouchTheSamplingBoundaryAtAnyAngle)
{
    for (int degrees = 0; degrees < 360; degrees += 13) {
        const Eigen::Matrix2d turn = job::rotation_working_machine(degrees * std::numbers::pi / 180);
        const job::Polygon anomaly = turn * polygon({{0, 1}, {2, 1}, {2, 2}, {0, 2}});
        EXPECT_EQ(problem(job_of(anomaly, turn * kSquare, job::SurfaceType::swept)), "accepted") << degrees;
    }
}

TEST(Boundaries, PlaneNeedsNoSamplingBoundary)
{
    EXPECT_EQ(job::working_boundaries(job_of(kSquare, job::Polygon(2, 0), job::SurfaceType::plane)).sampling.cols(), 0);
}

} // namespace boundary_test
} // namespace fettle
