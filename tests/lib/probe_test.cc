// Probing: errors of the touches, and the step from the ball's centre back to the surface.
#include "core/error.h"
#include "sampling/noise.h"
#include "sampling/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace fettle {
namespace probe_test {

using Eigen::Vector2d;

job::Job freeform_job()
{
    job::Job job;
    job.anomaly = Eigen::Matrix3Xd::Zero(3, 4);
    job.sampling = Eigen::Matrix3Xd::Zero(3, 4);
    job.anomaly.topRows<2>() << 30, 60, 60, 30, 30, 30, 60, 60;
    job.sampling.topRows<2>() << 5, 85, 85, 5, 5, 5, 85, 85;
    return job;
}

TEST(Noise, IsReadInTheJobsUnit)
{
    const sampling::TouchNoise noise = sampling::parse_noise("normal:0.005", 25.4);
    EXPECT_EQ(noise.kind, sampling::TouchNoise::Kind::normal);
    EXPECT_DOUBLE_EQ(noise.amplitude, 0.127);
    EXPECT_EQ(sampling::parse_noise("", 1).kind, sampling::TouchNoise::Kind::none);
    for (const char* wrong :
         {"normal", "gauss:1", "uniform:", "uniform:-1", "uniform:1,5", "normal:nan", ":1", "normal:inf"})
        EXPECT_THROW(sampling::parse_noise(wrong, 1), core::InputError) << wrong;
}

TEST(Noise, UniformFillsItsInterval)
{
    const int n = 100000;
    const Eigen::VectorXd errors = sampling::draw_noise({sampling::TouchNoise::Kind::uniform, 2}, n, 7);
    EXPECT_LE(errors.cwiseAbs().maxCoeff(), 2);
    // mean and variance of a uniform distribution, A²/3; four standard errors
    EXPECT_NEAR(errors.mean(), 0, 4 * 2 / std::sqrt(3.0 * n));
    EXPECT_NEAR(errors.squaredNorm() / n, 4.0 / 3, 4 * 4 * std::sqrt(4.0 / 45 / n));
}

TEST(Noise, NormalHas99PercentInside)
{
    const int n = 100000;
    const Eigen::VectorXd errors = sampling::draw_noise({sampling::TouchNoise::Kind::normal, 2}, n, 7);
    const double sigma = 2 / 2.5758;
    EXPECT_NEAR((errors.array().abs() <= 2).cast<double>().mean(), 0.99, 4 * std::sqrt(0.99 * 0.01 / n));
    EXPECT_NEAR((errors.array().abs() <= sigma).cast<double>().mean(), 0.6827, 4 * std::sqrt(0.68 * 0.32 / n));
    EXPECT_NEAR(errors.mean(), 0, 4 * sigma / std::sqrt(n));
}

TEST(Noise, OfATouchDependsOnItsNumberAlone)
{
    for (const auto kind : {sampling::TouchNoise::Kind::uniform, sampling::TouchNoise::Kind::normal}) {
        EXPECT_EQ(sampling::draw_noise({kind, 1}, 5, 3), sampling::draw_noise({kind, 1}, 50, 3).head(5));
        EXPECT_NE(sampling::draw_noise({kind, 1}, 5, 3), sampling::draw_noise({kind, 1}, 5, 4));
    }
    // std::mt19937_64 is the same on every platform: its first two numbers for seed 1, scaled
    const double u = (static_cast<double>(2469588189546311528ULL >> 11) + 0.5) / 9007199254740992.0;
    EXPECT_DOUBLE_EQ(sampling::draw_noise({sampling::TouchNoise::Kind::uniform, 1}, 1, 1)[0], 2 * u - 1);
}

// Mean and largest distance off the surface along z of the touches of a ball.
double largest_error(const job::Job& job, const std::function<double(Vector2d)>& surface,
                     const std::function<double(Vector2d)>& centre_over, double radius)
{
    const sampling::TouchPlan plan = sampling::plan_touches(job);
    Eigen::Matrix3Xd centres(3, plan.size());
    for (Eigen::Index i = 0; i < plan.size(); ++i) centres.col(i) << plan.xy.col(i), centre_over(plan.xy.col(i));
    const Eigen::Matrix3Xd contacts = sampling::contact_points(job, centres, radius);
    double largest = 0;
    for (Eigen::Index i = 0; i < plan.size(); ++i)
        largest = std::max(largest, std::abs(contacts(2, i) - surface(contacts.col(i).head<2>())));
    return largest;
}

TEST(Tip, ContactOnAPlaneIsExact)
{
    job::Job job = freeform_job();
    const auto plane = [](const Vector2d& xy) { return 4 + 0.4 * xy.x() - 0.3 * xy.y(); };
    const auto centre = [&](const Vector2d& xy) { return plane(xy) + 3 * std::sqrt(1.25); };
    for (const job::SurfaceType surface :
         {job::SurfaceType::plane, job::SurfaceType::swept, job::SurfaceType::freeform}) {
        job.surface = surface;
        EXPECT_LT(largest_error(job, plane, centre, 3), 1e-11);
    }
}

TEST(Tip, ContactOnASphereIsOffByTheSquareOfTheSlopesError)
{
    // R = 4 in as Wang's part 3, a tip of 3 mm: the centres lie on a sphere of radius R + 3
    const job::Job job = freeform_job();
    const double R = 101.6, tip = 3;
    const auto ball = [](double radius) {
        return
            [radius](const Vector2d& xy) { return std::sqrt(radius * radius - (xy - Vector2d(45, 45)).squaredNorm()); };
    };
    const double uncorrected = tip * (1 / std::cos(std::asin(42.0 / R)) - 1); // what "centre minus R" would be off
    EXPECT_GT(uncorrected, 0.28);
    EXPECT_LT(largest_error(job, ball(R), ball(R + tip), tip), 0.002);
}

TEST(Tip, SweptSectionIsFollowed)
{
    job::Job job = freeform_job();
    job.surface = job::SurfaceType::swept; // a concave cylinder along x
    const double R = 101.6, tip = 3;
    const auto trough = [](double radius) {
        return [radius](const Vector2d& xy) { return 200 - std::sqrt(radius * radius - std::pow(xy.y() - 45, 2)); };
    };
    EXPECT_LT(largest_error(job, trough(R), trough(R - tip), tip), 0.002);
}

TEST(Probe, TouchesAPlateWithPointAndBall)
{
    mesh::Mesh plate;
    plate.vertices.resize(3, 4);
    plate.vertices << 0, 90, 90, 0, 0, 0, 90, 90, 1, 19, 19, 1; // z = 1 + x/5
    plate.triangles.resize(3, 2);
    plate.triangles << 0, 0, 1, 2, 2, 3;
    const sampling::Scan scan(plate);
    job::Job job = freeform_job();
    const sampling::TouchPlan plan = sampling::plan_touches(job);
    for (const double tip : {0.0, 2.0}) {
        job.probe.tip_radius = tip;
        const Eigen::Matrix3Xd touches = sampling::probe(scan, job, plan, {}, 1);
        EXPECT_LT((touches.row(2).array() - 1 - touches.row(0).array() / 5).abs().maxCoeff(), 1e-12);
        // the contact lies beside the planned place by R sin of the slope
        EXPECT_NEAR(touches(0, 0) - plan.xy(0, 0), tip * 0.2 / std::sqrt(1.04), 1e-12);
    }
    const Eigen::VectorXd errors = sampling::draw_noise({sampling::TouchNoise::Kind::uniform, 0.1}, plan.size(), 9);
    job.probe.tip_radius = 0;
    const Eigen::Matrix3Xd noisy = sampling::probe(scan, job, plan, {sampling::TouchNoise::Kind::uniform, 0.1}, 9);
    EXPECT_LT((noisy.row(2).array() - 1 - noisy.row(0).array() / 5 - errors.transpose().array()).abs().maxCoeff(),
              1e-12);
}

TEST(Probe, NoSurfaceIsNaN)
{
    mesh::Mesh half;
    half.vertices.resize(3, 3);
    half.vertices << 0, 90, 0, 0, 0, 90, 0, 0, 0;
    half.triangles.resize(3, 1);
    half.triangles << 0, 1, 2;
    const job::Job job = freeform_job();
    const sampling::TouchPlan plan = sampling::plan_touches(job);
    const Eigen::Matrix3Xd touches = sampling::probe(sampling::Scan(half), job, plan, {}, 1);
    for (Eigen::Index i = 0; i < plan.size(); ++i) EXPECT_EQ(std::isnan(touches(2, i)), plan.xy.col(i).sum() > 90) << i;
}

} // namespace probe_test
} // namespace fettle
