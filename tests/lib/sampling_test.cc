// Touch points: layouts computed by hand from Wang 2007, 4.4.4, and what must not change them.
#include "core/error.h"
#include "sampling/freeform.h"
#include "sampling/order.h"
#include "sampling/swept.h"
#include "sampling/touch_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

namespace fettle {
namespace sampling_test {

constexpr double kInch = 25.4;

Eigen::Matrix3Xd corners(std::initializer_list<Eigen::Vector2d> list, double unit)
{
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Constant(3, static_cast<Eigen::Index>(list.size()), NAN);
    Eigen::Index i = 0;
    for (const Eigen::Vector2d& corner : list) points.col(i++).head<2>() = unit * corner;
    return points;
}

Eigen::Matrix3Xd rectangle(double x0, double y0, double x1, double y1)
{
    return corners({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, kInch);
}

job::Job job_of(job::SurfaceType surface, const Eigen::Matrix3Xd& anomaly, const Eigen::Matrix3Xd& sampling)
{
    job::Job job;
    job.source = "job.json";
    job.units = {units::Units::Length::in, units::Units::Force::lbf};
    job.surface = surface;
    job.anomaly = anomaly;
    job.sampling = sampling;
    return job;
}

// The job on a table that is turned by `angle` and moved.
job::Job moved(job::Job job, double angle, const Eigen::Vector2d& by)
{
    const Eigen::Matrix2d turn = job::rotation_working_machine(-angle);
    for (Eigen::Matrix3Xd* points : {&job.anomaly, &job.sampling})
        if (points->cols() > 0) points->topRows<2>() = (turn * points->topRows<2>()).colwise() + by;
    job.theta += angle;
    return job;
}

std::string problem(const job::Job& job)
{
    try {
        sampling::plan_touches(job);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

void expect_inches(const sampling::TouchPlan& plan, std::initializer_list<Eigen::Vector2d> expected)
{
    ASSERT_EQ(plan.size(), static_cast<Eigen::Index>(expected.size()));
    Eigen::Index i = 0;
    for (const Eigen::Vector2d& xy : expected) {
        EXPECT_NEAR(plan.xy(0, i) / kInch, xy.x(), 1e-12) << "touch " << i;
        EXPECT_NEAR(plan.xy(1, i) / kInch, xy.y(), 1e-12) << "touch " << i;
        ++i;
    }
}

void expect_roles(const sampling::TouchPlan& plan, std::initializer_list<int> expected)
{
    EXPECT_EQ(std::vector<int>(plan.role.begin(), plan.role.end()), std::vector<int>(expected));
}

// --- planes ---

TEST(Plane, BoundaryPointsAreTheTouches)
{
    job::Job job = job_of(job::SurfaceType::plane, rectangle(1, 1, 2, 3), Eigen::Matrix3Xd(3, 0));
    job.anomaly(2, 1) = 7;
    const sampling::TouchPlan plan = sampling::plan_touches(job);
    expect_inches(plan, {{1, 1}, {2, 1}, {2, 3}, {1, 3}});
    expect_roles(plan, {0, 0, 0, 0});
    EXPECT_EQ(plan.z[1], 7);
    EXPECT_TRUE(std::isnan(plan.z[0]));
}

TEST(Plane, ThreePointsAreTooFew)
{
    EXPECT_EQ(
        problem(job_of(job::SurfaceType::plane, corners({{0, 0}, {1, 0}, {0, 1}}, kInch), Eigen::Matrix3Xd(3, 0))),
        "job.json: anomaly: 3 boundary points, a plane needs at least 4: touch 1 more around the anomaly");
}

// --- points of the sampling boundary ---

TEST(SamplingBoundary, IsAppendedAsTouchesOnNoLine)
{
    job::Job job = job_of(job::SurfaceType::freeform, rectangle(1, 1, 2, 2), rectangle(0, 0, 3, 3));
    job.sampling(2, 1) = 7;
    sampling::TouchPlan plan = sampling::plan_touches(job);
    const Eigen::Index on_lines = plan.size();
    sampling::append_sampling_boundary(plan, job);
    ASSERT_EQ(plan.size(), on_lines + 4);
    EXPECT_LT((plan.xy.rightCols(4) - job.sampling.topRows<2>()).norm(), 1e-12);
    EXPECT_TRUE((plan.role.tail(4).array() == 2).all());
    EXPECT_TRUE((plan.curve.tail(4).array() == sampling::kNoLine).all());
    EXPECT_EQ(plan.z[on_lines + 1], 7);
    EXPECT_TRUE(std::isnan(plan.z[on_lines]));
}

// A list that is closed by its first point, and a touch at a corner already.
TEST(SamplingBoundary, IsTouchedOnceAtEachPlace)
{
    job::Job job = job_of(job::SurfaceType::freeform, rectangle(1, 1, 2, 2),
                          corners({{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}}, kInch));
    const Eigen::Vector2d beside(3 * kInch + 0.9 * job.probe.accuracy, 3 * kInch);
    EXPECT_EQ(sampling::untouched_sampling_points(job, beside), (std::vector<Eigen::Index>{0, 1, 3}));
    EXPECT_EQ(sampling::untouched_sampling_points(job, Eigen::Matrix2Xd(2, 0)),
              (std::vector<Eigen::Index>{0, 1, 2, 3}));
}

TEST(SamplingBoundary, IsNeeded)
{
    const job::Job job = job_of(job::SurfaceType::plane, rectangle(1, 1, 2, 2), Eigen::Matrix3Xd(3, 0));
    sampling::TouchPlan plan = sampling::plan_touches(job);
    EXPECT_THROW(sampling::append_sampling_boundary(plan, job), core::InputError);
}

// --- free-form ---

TEST(LineCount, FollowsEquation45)
{
    const auto count = [](double a, double b) {
        const sampling::LineCount lines = sampling::line_count(a * kInch, b * kInch);
        return std::pair(lines.across_a, lines.across_b);
    };
    EXPECT_EQ(count(1, 1), std::pair(2, 2));       // sqrt(.22 + 1) = 1.10
    EXPECT_EQ(count(2, 2), std::pair(2, 2));       // sqrt(.88 + 1) = 1.37
    EXPECT_EQ(count(10, 10), std::pair(5, 5));     // sqrt(22 + 1) = 4.80
    EXPECT_EQ(count(10, 1), std::pair(6, 1));      // sqrt(22 + 10) = 5.66
    EXPECT_EQ(count(1, 10), std::pair(1, 10));     // sqrt(.22 + .1) = .57
    EXPECT_EQ(count(2, 1), std::pair(2, 1));       // n_b = 2 · 1/2, exactly 1
    EXPECT_EQ(count(3.25, 7.75), std::pair(2, 5)); // sqrt(2.32 + .42) = 1.66; 2 · 2.38 = 4.77
}

TEST(LineCount, IsTheSameFromInchesAndFromMillimetres)
{
    for (int a = 1; a <= 80; ++a)
        for (int b = 1; b <= 80; ++b) {
            // eq. 4-5 in units of 1/8 in, with whole numbers: n_a^2 >= .22 a^2 + a/b, times 6400 b
            const long long needed = 22LL * a * a * b + 6400LL * a;
            long long n_a = 1;
            while (n_a * n_a * 6400 * b < needed) ++n_a;
            const long long n_b = (n_a * b + a - 1) / a;
            const sampling::LineCount lines = sampling::line_count(a / 8.0 * kInch, b / 8.0 * kInch);
            EXPECT_EQ(lines.across_a, n_a) << a << ' ' << b;
            EXPECT_EQ(lines.across_b, n_b) << a << ' ' << b;
        }
}

TEST(Freeform, OneInchAnomalyGivesSixteenTouches)
{
    const sampling::TouchPlan plan =
        sampling::plan_touches(job_of(job::SurfaceType::freeform, rectangle(1, 1, 2, 2), rectangle(0, 0, 3, 3)));
    const double p = 4.0 / 3, q = 5.0 / 3;
    expect_inches(plan, {{p, 0},
                         {p, 1},
                         {p, 2},
                         {p, 3},
                         {q, 0},
                         {q, 1},
                         {q, 2},
                         {q, 3},
                         {0, p},
                         {1, p},
                         {2, p},
                         {3, p},
                         {0, q},
                         {1, q},
                         {2, q},
                         {3, q}});
    expect_roles(plan, {2, 1, 1, 2, 2, 1, 1, 2, 2, 1, 1, 2, 2, 1, 1, 2});
    EXPECT_EQ(plan.curve, (Eigen::VectorXi(16) << 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3).finished());
    EXPECT_TRUE(plan.z.array().isNaN().all());
}

TEST(Freeform, WangsTestPatch)
{
    // 5 x 4 in patch, 2 x 2 in anomaly (table 4-5): lines at the thirds of the anomaly's sides
    const sampling::TouchPlan plan =
        sampling::plan_touches(job_of(job::SurfaceType::freeform, rectangle(1.5, 1, 3.5, 3), rectangle(0, 0, 5, 4)));
    const double x1 = 1.5 + 2.0 / 3, x2 = 1.5 + 4.0 / 3, y1 = 1 + 2.0 / 3, y2 = 1 + 4.0 / 3;
    expect_inches(plan, {{x1, 0},
                         {x1, 1},
                         {x1, 3},
                         {x1, 4},
                         {x2, 0},
                         {x2, 1},
                         {x2, 3},
                         {x2, 4},
                         {0, y1},
                         {1.5, y1},
                         {3.5, y1},
                         {5, y1},
                         {0, y2},
                         {1.5, y2},
                         {3.5, y2},
                         {5, y2}});
}

TEST(Freeform, ObliqueBoundaries)
{
    // B and S are diamonds: |x| + |y| = 1 and 2; rectangle 2 x 2, lines at ±1/3, crossings at 2/3 and 5/3
    const auto diamond = [](double r) { return corners({{r, 0}, {0, r}, {-r, 0}, {0, -r}}, kInch); };
    const sampling::TouchPlan plan = sampling::plan_touches(job_of(job::SurfaceType::freeform, diamond(1), diamond(2)));
    const double t = 1.0 / 3, b = 2.0 / 3, s = 5.0 / 3;
    expect_inches(plan, {{-t, -s},
                         {-t, -b},
                         {-t, b},
                         {-t, s},
                         {t, -s},
                         {t, -b},
                         {t, b},
                         {t, s},
                         {-s, -t},
                         {-b, -t},
                         {b, -t},
                         {s, -t},
                         {-s, t},
                         {-b, t},
                         {b, t},
                         {s, t}});
}

TEST(Freeform, NonConvexPolygonsGiveTheOutermostCrossings)
{
    // B is a U in [1, 2]^2, open above between x = 1.2 and 1.8 down to y = 1.2; S has a notch from x = 3 to x = 2.6 at
    // 1.2 < y < 1.5. Lines at 4/3 and 5/3: the row y = 4/3 crosses B four times and S three times on the right.
    const Eigen::Matrix3Xd moon =
        corners({{1, 1}, {2, 1}, {2, 2}, {1.8, 2}, {1.8, 1.2}, {1.2, 1.2}, {1.2, 2}, {1, 2}}, kInch);
    const Eigen::Matrix3Xd notched =
        corners({{0, 0}, {3, 0}, {3, 1.2}, {2.6, 1.2}, {2.6, 1.5}, {3, 1.5}, {3, 3}, {0, 3}}, kInch);
    const sampling::TouchPlan plan = sampling::plan_touches(job_of(job::SurfaceType::freeform, moon, notched));
    const double p = 4.0 / 3, q = 5.0 / 3;
    expect_inches(plan, {{p, 0},
                         {p, 1},
                         {p, 1.2},
                         {p, 3},
                         {q, 0},
                         {q, 1},
                         {q, 1.2},
                         {q, 3},
                         {0, p},
                         {1, p},
                         {2, p},
                         {2.6, p},
                         {0, q},
                         {1, q},
                         {2, q},
                         {3, q}});
}

TEST(Freeform, SamplingBoundaryCrossedSeveralTimes)
{
    // a slot x in (2.4, 2.6) cut into S from above down to y = 1.5: the row y = 5/3 leaves S at 2.4, is back from 2.6
    // to 3; the outermost crossing is 3, the one next to the anomaly is B's
    const Eigen::Matrix3Xd slotted =
        corners({{0, 0}, {3, 0}, {3, 3}, {2.6, 3}, {2.6, 1.5}, {2.4, 1.5}, {2.4, 3}, {0, 3}}, kInch);
    const sampling::TouchPlan plan =
        sampling::plan_touches(job_of(job::SurfaceType::freeform, rectangle(1, 1, 2, 2), slotted));
    EXPECT_NEAR(plan.xy(0, 14) / kInch, 2, 1e-12);
    EXPECT_NEAR(plan.xy(0, 15) / kInch, 3, 1e-12);
}

TEST(Freeform, NoRoomOnOneSideIsRefusedWithThePlace)
{
    EXPECT_EQ(problem(job_of(job::SurfaceType::freeform, rectangle(0, 1, 1, 2), rectangle(0, 0, 3, 3))),
              "job.json: sampling: no room to touch on both sides of the anomaly, on the line through "
              "(0, 1.33333) in: widen the sampling boundary there");
    // less room than the probe is exact is no room
    EXPECT_NE(problem(job_of(job::SurfaceType::freeform, rectangle(0.004, 1, 1, 2), rectangle(0, 0, 3, 3))),
              "accepted");
    EXPECT_EQ(problem(job_of(job::SurfaceType::freeform, rectangle(0.006, 1, 1, 2), rectangle(0, 0, 3, 3))),
              "accepted");
}

TEST(Freeform, NeedleIsRefused)
{
    EXPECT_EQ(
        problem(job_of(job::SurfaceType::freeform, rectangle(1, 1, 1.01, 3), rectangle(0, 0, 4, 4))),
        "job.json: anomaly: its rectangle in the working frame, 0.01 x 2 in, needs 200 lines across a side, at most "
        "100 are probed: choose a smaller or a wider region");
}

// --- swept; the rulings run along X_w unless noted otherwise ---

TEST(Swept, WholeWidthFree)
{
    // Case (a). S = [0,4] x [0,3], B = [1,2] x [1,2]. Ruling: 4 in long for any y in [0,1) and (2,3]; tried are shares
    // of the gaps, nearest to the middle y = 1.5: 0.9 and 2.1, the smaller first. Section: free over [1,2] for x < 1
    // and x > 2; nearest to x = 1.5: 0.9.
    const sampling::TouchPlan plan =
        sampling::plan_touches(job_of(job::SurfaceType::swept, rectangle(1, 1, 2, 2), rectangle(0, 0, 4, 3)));
    expect_inches(plan, {{0, 0.9}, {2, 0.9}, {4, 0.9}, {0.9, 1}, {0.9, 4.0 / 3}, {0.9, 5.0 / 3}, {0.9, 2}});
    expect_roles(plan, {4, 4, 4, 5, 5, 5, 5});
    EXPECT_EQ(plan.curve, (Eigen::VectorXi(7) << 0, 0, 0, 1, 1, 1, 1).finished());
}

TEST(Swept, PartOfTheWidthFree)
{
    // Case (b). B is an H lying in S = [0,3] x [0,3] from edge to edge: [0,3] x ... no line x = const is free over all
    // of y in [1,2] since B's bars reach S on both sides, but between the bars (1 < x < 2) B is only [1.4,1.6] high.
    const Eigen::Matrix3Xd bars = corners(
        {{0, 1}, {1, 1}, {1, 1.4}, {2, 1.4}, {2, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 1.6}, {1, 1.6}, {1, 2}, {0, 2}},
        kInch);
    const sampling::TouchPlan plan =
        sampling::plan_touches(job_of(job::SurfaceType::swept, bars, rectangle(0, 0, 3, 3)));
    // the line nearest to the middle, x = 1.5: free from 1 to 1.4 and from 1.6 to 2
    ASSERT_EQ(plan.size(), 7);
    for (int i = 3; i < 7; ++i) EXPECT_NEAR(plan.xy(0, i) / kInch, 1.5, 1e-12);
    const double v[] = {1, 1.4, 1.6, 2};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(plan.xy(1, 3 + i) / kInch, v[i], 1e-12);
}

TEST(Swept, PartOfTheWidthFreeOnTwoLines)
{
    // B is a Z: [0,2] x [1,1.5] and [1,3] x [1.5,2], S = [0,3]^2. Left of x = 1 the upper half of the width is free,
    // right of x = 2 the lower half: together the whole width, on two lines.
    const Eigen::Matrix3Xd z = corners({{0, 1}, {2, 1}, {2, 1.5}, {3, 1.5}, {3, 2}, {1, 2}, {1, 1.5}, {0, 1.5}}, kInch);
    const sampling::TouchPlan plan = sampling::plan_touches(job_of(job::SurfaceType::swept, z, rectangle(0, 0, 3, 3)));
    ASSERT_EQ(plan.size(), 7);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(plan.xy(1, 3 + i) / kInch, 1 + i / 3.0, 1e-12);
    EXPECT_GT(plan.xy(0, 3), 2 * kInch); // the lower two on the right
    EXPECT_GT(plan.xy(0, 4), 2 * kInch);
    EXPECT_LT(plan.xy(0, 5), 1 * kInch);
    EXPECT_LT(plan.xy(0, 6), 1 * kInch);
}

// Case (b) where only one stretch within the width is free, [p, q]: its ends, and what is free beyond the width. By
// hand.
TEST(Swept, OneStretchOfTheWidthFree)
{
    const auto across = [](std::initializer_list<Eigen::Vector2d> anomaly, const Eigen::Matrix3Xd& sampling) {
        const sampling::TouchPlan plan =
            sampling::plan_touches(job_of(job::SurfaceType::swept, corners(anomaly, kInch), sampling));
        EXPECT_EQ(plan.size(), 7);
        return Eigen::Vector4d(plan.xy.row(1).tail<4>().transpose() / kInch);
    };
    const Eigen::Matrix3Xd square = rectangle(0, 0, 3, 3), low = rectangle(0, 1, 3, 2);
    const auto expect = [](const Eigen::Vector4d& found, const Eigen::Vector4d& v) {
        EXPECT_LT((found - v).cwiseAbs().maxCoeff(), 1e-12) << found.transpose();
    };
    // B is [0,3] x [1,2] with a notch [1.4,1.6] wide from above, from below, and from the left.
    expect(across({{0, 1}, {3, 1}, {3, 2}, {1.6, 2}, {1.6, 1.5}, {1.4, 1.5}, {1.4, 2}, {0, 2}}, square),
           {1, 1.5, 1.75, 2});
    expect(across({{0, 1}, {1.4, 1}, {1.4, 1.5}, {1.6, 1.5}, {1.6, 1}, {3, 1}, {3, 2}, {0, 2}}, square),
           {1, 1.25, 1.5, 2});
    expect(across({{0, 1}, {3, 1}, {3, 2}, {0, 2}, {0, 1.6}, {0.5, 1.6}, {0.5, 1.4}, {0, 1.4}}, square),
           {1, 1.4, 1.6, 2});
    // S is no wider: nothing is free beyond.
    expect(across({{0, 1}, {3, 1}, {3, 2}, {0, 2}, {0, 1.6}, {0.5, 1.6}, {0.5, 1.4}, {0, 1.4}}, low),
           Eigen::Vector4d::LinSpaced(1.4, 1.6));
}

// A boundary traced by a scanner, of more corners than are tried: case (a) beside a circle.
TEST(Swept, BoundariesOfManyCorners)
{
    Eigen::Matrix3Xd circle(3, 300);
    for (int k = 0; k < 300; ++k) {
        const double angle = 2 * std::numbers::pi * k / 300;
        circle.col(k) << kInch * (1.5 + 0.5 * std::cos(angle)), kInch * (1.5 + 0.5 * std::sin(angle)), 0;
    }
    const sampling::TouchPlan plan =
        sampling::plan_touches(job_of(job::SurfaceType::swept, circle, rectangle(0, 0, 3, 3)));
    ASSERT_EQ(plan.size(), 7);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(plan.xy(0, i) / kInch, 1.5 * i, 1e-12);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(plan.xy(1, 3 + i) / kInch, 1 + i / 3.0, 1e-3);
        EXPECT_NEAR(std::abs(plan.xy(0, 3 + i) / kInch - 1.5), 0.6, 0.11); // a tenth into the gap, or at the circle
    }
}

TEST(Swept, NothingOfTheWidthFree)
{
    // Case (c). B spans S along the rulings; S is widest, 4 in, at x = 1.
    const Eigen::Matrix3Xd hexagon = corners({{0, 0}, {1, -0.5}, {3, 0}, {3, 3}, {1, 3.5}, {0, 3}}, kInch);
    const sampling::TouchPlan plan =
        sampling::plan_touches(job_of(job::SurfaceType::swept, rectangle(0, 1, 3, 2), hexagon));
    ASSERT_EQ(plan.size(), 7);
    const double v[] = {-0.5, 1, 2, 3.5};
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(plan.xy(0, 3 + i) / kInch, 1, 1e-12);
        EXPECT_NEAR(plan.xy(1, 3 + i) / kInch, v[i], 1e-12);
    }
}

TEST(Swept, DirectionTurnsTheLayout)
{
    // rulings along Y_w: the layout of WholeWidthFree with the axes exchanged
    job::Job job = job_of(job::SurfaceType::swept, rectangle(1, 1, 2, 2), rectangle(0, 0, 3, 4));
    job.ruling_direction = std::numbers::pi / 2;
    const sampling::TouchPlan plan = sampling::plan_touches(job);
    ASSERT_EQ(plan.size(), 7);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(plan.xy(1, i) / kInch, 2 * i, 1e-12);
    for (int i = 3; i < 7; ++i) EXPECT_NEAR(plan.xy(1, i) / kInch, 0.9, 1e-12);
    EXPECT_NEAR((plan.xy.row(0).segment(3, 4).maxCoeff() - plan.xy.row(0).segment(3, 4).minCoeff()) / kInch, 1, 1e-12);
}

TEST(Swept, NoUsableLineAsksForAnotherBoundary)
{
    // B reaches S on three sides: no line across has metal on both sides, none is free over a part of the width
    EXPECT_EQ(problem(job_of(job::SurfaceType::swept, rectangle(0, 0, 3, 2), rectangle(0, 0, 3, 3))),
              "job.json: sampling: no line across the rulings can be touched on both sides of the anomaly: "
              "widen the sampling boundary near (1.5, 1) in");
}

TEST(Swept, NoFreeRulingAsksForAnotherBoundary)
{
    // Beside B there is less room than the probe's accuracy.
    EXPECT_EQ(problem(job_of(job::SurfaceType::swept, rectangle(0.001, 0, 2.999, 3), rectangle(0, 0, 3, 3))),
              "job.json: sampling: no line along the rulings is free of the anomaly: widen the sampling boundary");
}

TEST(Swept, TouchesLieInTheFreeAreaAndCoverTheAnomaly)
{
    // any convex S around any star-shaped B, any direction: no touch inside B, none outside S
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int trial = 0; trial < 100; ++trial) {
        Eigen::Matrix3Xd star = Eigen::Matrix3Xd::Constant(3, 9, NAN), ring = star;
        for (int i = 0; i < 9; ++i) {
            const double angle = 2 * std::numbers::pi * i / 9, r = 5 + 10 * uniform(random);
            star.col(i).head<2>() << r * std::cos(angle), r * std::sin(angle);
            ring.col(i).head<2>() << 20 * std::cos(angle), 20 * std::sin(angle);
        }
        job::Job job = job_of(job::SurfaceType::swept, star, ring);
        job.ruling_direction = 3 * uniform(random);
        const sampling::TouchPlan plan = sampling::plan_touches(job);
        const job::Boundaries both = job::working_boundaries(job);
        for (Eigen::Index i = 0; i < plan.size(); ++i) {
            const Eigen::Vector2d xy = plan.xy.col(i);
            EXPECT_TRUE(job::contains(both.sampling, xy)) << trial;
            EXPECT_TRUE(!job::contains(both.anomaly, xy) || job::distance_to_edge(both.anomaly, xy) < 1e-9) << trial;
        }
    }
}

// --- what must not change a layout ---

TEST(Layout, MovesWithTheTable)
{
    const Eigen::Matrix3Xd star =
        corners({{1, 1.2}, {1.4, 1}, {2.1, 1.1}, {1.8, 1.5}, {2, 2}, {1.5, 1.8}, {0.9, 2.1}}, kInch);
    for (const job::SurfaceType surface :
         {job::SurfaceType::plane, job::SurfaceType::swept, job::SurfaceType::freeform}) {
        job::Job job = job_of(surface, star, rectangle(0, 0, 3, 3));
        job.ruling_direction = 0.3;
        const sampling::TouchPlan here = sampling::plan_touches(job);
        for (const double angle : {0.0, 0.4, std::numbers::pi / 2, 2.5, -1.0}) {
            const Eigen::Vector2d by(1234.5, -321.0);
            const sampling::TouchPlan there = sampling::plan_touches(moved(job, angle, by));
            ASSERT_EQ(there.size(), here.size());
            const Eigen::Matrix2Xd expected = (job::rotation_working_machine(-angle) * here.xy).colwise() + by;
            EXPECT_LT((there.xy - expected).cwiseAbs().maxCoeff(), 1e-9) << job::to_string(surface) << ' ' << angle;
            EXPECT_EQ(there.role, here.role);
            EXPECT_EQ(there.curve, here.curve);
        }
    }
}

TEST(Layout, SymmetricBoundariesTooAreChosenAlikeAtEveryAngle)
{
    // many equally good lines: rounding must not pick another
    const job::Job job = job_of(job::SurfaceType::swept, rectangle(1, 1, 2, 2), rectangle(0, 0, 3, 3));
    const sampling::TouchPlan here = sampling::plan_touches(job);
    for (int degrees = 3; degrees < 360; degrees += 11) {
        const double angle = degrees * std::numbers::pi / 180;
        const sampling::TouchPlan there = sampling::plan_touches(moved(job, angle, {0, 0}));
        EXPECT_LT((there.xy - job::rotation_working_machine(-angle) * here.xy).cwiseAbs().maxCoeff(), 1e-9) << degrees;
    }
}

// --- order and time ---

TEST(Order, VisitsEveryTouchOnce)
{
    const Eigen::Matrix2Xd xy = Eigen::Matrix2Xd::Random(2, 60);
    const std::vector<Eigen::Index> order = sampling::short_probing_path(xy);
    EXPECT_EQ(std::set<Eigen::Index>(order.begin(), order.end()).size(), 60u);
}

TEST(Order, SmallLayoutsNearlyShortest)
{
    // against all 7! orders
    std::srand(3);
    for (int trial = 0; trial < 20; ++trial) {
        const Eigen::Matrix2Xd xy = Eigen::Matrix2Xd::Random(2, 7);
        std::vector<Eigen::Index> permutation = {0, 1, 2, 3, 4, 5, 6};
        double shortest = 1e9;
        do shortest = std::min(shortest, sampling::probing_path_length(xy, permutation));
        while (std::next_permutation(permutation.begin(), permutation.end()));
        EXPECT_LE(sampling::probing_path_length(xy, sampling::short_probing_path(xy)), 1.1 * shortest) << trial;
    }
}

TEST(Order, AlongALineIsExact)
{
    Eigen::Matrix2Xd xy(2, 6);
    xy << 3, 0, 5, 1, 4, 2, 0, 0, 0, 0, 0, 0;
    EXPECT_DOUBLE_EQ(sampling::probing_path_length(xy, sampling::short_probing_path(xy)), 5);
}

TEST(ProbingTime, OfTwoTouchesByHand)
{
    sampling::ProbingMachine machine;
    machine.travel_speed = 50;
    machine.approach_speed = 5;
    machine.approach_clearance = 10;
    machine.dwell = 0.5;
    Eigen::Matrix3Xd touches(3, 2);
    touches << 0, 100, 0, 0, 20, 15;
    // across 100/50; approach from z = 30: 10/5 + 15/5; travelled: down 70 - 30 and up 50, down 40 and up 55
    const double expected = 2 + 2 + 3 + (40 + 50 + 40 + 55) / 50.0 + 2 * 0.5;
    EXPECT_DOUBLE_EQ(sampling::probing_time(touches, {0, 1}, 70, machine), expected);
}

} // namespace sampling_test
} // namespace fettle
