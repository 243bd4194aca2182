// Estimated points: exact wherever the surface is a cubic along the lines.
#include "core/error.h"
#include "sampling/estimate.h"
#include "sampling/probe.h"
#include "sampling/touch_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace fettle {
namespace estimate_test {

using Eigen::Vector2d;

job::Job job_at(double theta)
{
    job::Job job;
    job.theta = theta;
    job.anomaly = Eigen::Matrix3Xd::Zero(3, 4);
    job.sampling = Eigen::Matrix3Xd::Zero(3, 4);
    job.anomaly.topRows<2>() << 30, 70, 70, 30, 30, 30, 60, 60;
    job.sampling.topRows<2>() << 5, 95, 95, 5, 5, 5, 85, 85;
    const Eigen::Matrix2d turn = job::rotation_working_machine(-theta);
    for (Eigen::Matrix3Xd* points : {&job.anomaly, &job.sampling})
        points->topRows<2>() = (turn * points->topRows<2>()).eval();
    return job;
}

// bicubic in W, with every term up to x³y³
double bicubic(const Vector2d& w)
{
    const double x = w.x() / 50 - 1, y = w.y() / 45 - 1;
    return 10 * (1 + x - 0.5 * x * x + 0.3 * x * x * x) * (2 - 0.7 * y + 0.4 * y * y - 0.6 * y * y * y) +
           3 * x * x * x * y * y * y;
}

struct Touched {
    sampling::TouchPlan plan;
    Eigen::Matrix3Xd xyz;
};

Touched touched(const job::Job& job, const std::function<double(Vector2d)>& surface_in_w)
{
    Touched result{sampling::plan_touches(job), {}};
    result.xyz.resize(3, result.plan.size());
    for (Eigen::Index i = 0; i < result.plan.size(); ++i) {
        const Vector2d xy = result.plan.xy.col(i);
        result.xyz.col(i) << xy, surface_in_w(job::rotation_working_machine(job.theta) * xy);
    }
    return result;
}

cloud::Cloud samples_of(const Touched& touches)
{
    cloud::Cloud samples;
    samples.xyz = touches.xyz;
    cloud::set_field(samples, "curve", touches.plan.curve.cast<double>());
    cloud::set_field(samples, "role", touches.plan.role.cast<double>());
    return samples;
}

TEST(Estimate, BicubicSurfaceIsReproducedAtEveryCrossing)
{
    for (const double theta : {0.0, 0.3, std::numbers::pi / 2, 3.0}) {
        const job::Job job = job_at(theta);
        const Touched touches = touched(job, bicubic);
        const Eigen::Matrix3Xd points =
            sampling::estimated_points(job, touches.xyz, touches.plan.curve, touches.plan.role);
        ASSERT_EQ(points.cols(), 4);
        const Eigen::Matrix2Xd working = job::rotation_working_machine(theta) * points.topRows<2>();
        for (int i = 0; i < 4; ++i) {
            EXPECT_NEAR(working(0, i), 30 + 40 * (1 + i / 2) / 3.0, 1e-11);
            EXPECT_NEAR(working(1, i), 30 + 30 * (1 + i % 2) / 3.0, 1e-11);
            EXPECT_NEAR(points(2, i), bicubic(working.col(i)), 1e-11);
        }
    }
}

TEST(Estimate, IsTheMeanOfTheTwoCurves)
{
    // lifting all touches of the lines along Y_w by 1 lifts the crossings by a half
    const job::Job job = job_at(0);
    Touched touches = touched(job, bicubic);
    const Eigen::Matrix3Xd before = sampling::estimated_points(job, touches.xyz, touches.plan.curve, touches.plan.role);
    for (Eigen::Index i = 0; i < touches.plan.size(); ++i)
        if (touches.plan.curve[i] < 2) touches.xyz(2, i) += 1;
    const Eigen::Matrix3Xd after = sampling::estimated_points(job, touches.xyz, touches.plan.curve, touches.plan.role);
    EXPECT_LT((after.row(2) - before.row(2)).array().abs().maxCoeff() - 0.5, 1e-12);
    EXPECT_GT((after.row(2) - before.row(2)).array().abs().minCoeff() - 0.5, -1e-12);
}

TEST(Estimate, DoesNotDependOnTheOrderOfTheTouches)
{
    const job::Job job = job_at(0.3);
    const Touched touches = touched(job, bicubic);
    const Eigen::Matrix3Xd forward =
        sampling::estimated_points(job, touches.xyz, touches.plan.curve, touches.plan.role);
    const Eigen::Matrix3Xd backward = sampling::estimated_points(
        job, touches.xyz.rowwise().reverse(), touches.plan.curve.reverse(), touches.plan.role.reverse());
    EXPECT_LT((forward - backward).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(Estimate, TouchesOfABallBesideTheLineAreCarriedOntoIt)
{
    // a sphere of 200 mm, a tip of 3 mm: contacts lie up to 0.4 mm beside the lines and are scattered across them
    const job::Job job = job_at(0);
    const auto ball = [](double radius) {
        return
            [radius](const Vector2d& xy) { return std::sqrt(radius * radius - (xy - Vector2d(50, 45)).squaredNorm()); };
    };
    // how far the estimated points, wherever they come to lie, are off the sphere
    const auto errors = [&](const Touched& touches, const Eigen::Matrix3Xd& xyz) {
        Eigen::Matrix3Xd points = sampling::estimated_points(job, xyz, touches.plan.curve, touches.plan.role);
        for (Eigen::Index i = 0; i < points.cols(); ++i) points(2, i) -= ball(200)(points.col(i).head<2>());
        return Eigen::VectorXd(points.row(2));
    };
    const Touched by_point = touched(job, ball(200)), by_ball = touched(job, ball(203));
    const Eigen::VectorXd difference =
        errors(by_point, by_point.xyz) - errors(by_ball, sampling::contact_points(job, by_ball.xyz, 3));
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 0.01);
}

TEST(Estimate, AppendsRole3AndKeepsEveryField)
{
    const job::Job job = job_at(0);
    cloud::Cloud samples = samples_of(touched(job, bicubic));
    cloud::set_field(samples, "sigma", Eigen::VectorXd::LinSpaced(16, 0, 1));
    const cloud::Cloud points = sampling::with_estimated_points(job, samples);
    ASSERT_EQ(points.size(), 20);
    EXPECT_EQ(points.xyz.leftCols(16), samples.xyz);
    EXPECT_EQ(cloud::field(points, "role").tail(4), Eigen::VectorXd::Constant(4, 3));
    EXPECT_TRUE(cloud::field(points, "curve").tail(4).array().isNaN().all());
    EXPECT_EQ(cloud::field(points, "sigma").head(16), cloud::field(samples, "sigma"));
    EXPECT_TRUE(cloud::field(points, "sigma").tail(4).array().isNaN().all());
    EXPECT_THROW(sampling::with_estimated_points(job, points), core::InputError);
}

TEST(Estimate, OtherSurfacesPassUnchanged)
{
    job::Job job = job_at(0);
    job.surface = job::SurfaceType::swept;
    const cloud::Cloud samples = samples_of(touched(job, bicubic));
    EXPECT_EQ(sampling::with_estimated_points(job, samples).size(), 7);
}

TEST(Estimate, RefusesLinesItCannotUse)
{
    const job::Job job = job_at(0);
    const auto problem = [&](const cloud::Cloud& samples) -> std::string {
        try {
            sampling::with_estimated_points(job, samples);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    cloud::Cloud samples = samples_of(touched(job, bicubic));
    samples.xyz(2, 5) = NAN; // a touch that failed
    EXPECT_EQ(problem(samples), "curve 1: 3 touches near the boundaries, 4 are needed");
    samples = samples_of(touched(job, bicubic));
    samples.xyz.col(5) = samples.xyz.col(6);
    EXPECT_EQ(problem(samples), "curve 1: two touches at the same place");
    cloud::set_field(samples, "role", Eigen::VectorXd::Zero(16));
    EXPECT_EQ(problem(samples), "no touches of role 1 and 2, which a free-form job has");
    samples.fields.clear();
    EXPECT_EQ(problem(samples), "the points have no field 'curve'");
}

} // namespace estimate_test
} // namespace fettle
