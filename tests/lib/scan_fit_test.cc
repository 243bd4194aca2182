#include "fit/scan_fit.h"

#include "core/error.h"
#include "draws.h"
#include "fit/representatives.h"
#include "margin/anomaly_grid.h"
#include "margin/shift.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

namespace fettle {
namespace scan_fit_test {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kHalfB = 17.5, kHalfS = 50, kRadius = 200; // mm

job::Job square_job()
{
    job::Job job;
    job.surface = job::SurfaceType::freeform;
    job.probe.accuracy = 0.127;
    const auto square = [](double half) {
        Eigen::Matrix3Xd corners(3, 4);
        corners << -half, half, half, -half, -half, -half, half, half, 0, 0, 0, 0;
        return corners;
    };
    job.anomaly = square(kHalfB);
    job.sampling = square(kHalfS);
    job.sampling.row(2).setConstant(std::numeric_limits<double>::quiet_NaN()); // not measured: no touches of griddata
    return job;
}

double sphere(double x, double y) { return std::sqrt(kRadius * kRadius - x * x - y * y) - kRadius; }

/// A scanner's error that is the same for neighbouring points: a sum of cosines with a Gaussian spectrum.
class ScannerWaves {
  public:
    ScannerWaves(double rms, double length, unsigned seed)
    {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
        for (Index k = 0; k < waves_.cols(); ++k)
            waves_.col(k) << normal(random) / length, normal(random) / length, phase(random);
        amplitude_ = rms * std::sqrt(2.0 / static_cast<double>(waves_.cols()));
    }
    double at(double x, double y) const
    {
        return amplitude_ * (waves_.transpose() * Eigen::Vector3d(x, y, 1)).array().cos().sum();
    }

  private:
    Eigen::Matrix3Xd waves_{3, 60};
    double amplitude_;
};

/// A scan of the sphere with 5 mm of anomaly inside B.
std::shared_ptr<cloud::Cloud> scanned_points(Index points, const ScannerWaves& waves, double noise, unsigned seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-kHalfS - 5, kHalfS + 5);
    std::normal_distribution<double> normal;
    auto cloud = std::make_shared<cloud::Cloud>();
    cloud->xyz.resize(3, points);
    for (Index i = 0; i < points; ++i) {
        const double x = place(random), y = place(random);
        const bool on_anomaly = std::max(std::abs(x), std::abs(y)) < kHalfB - 0.5;
        cloud->xyz.col(i) << x, y, sphere(x, y) + waves.at(x, y) + noise * normal(random) + (on_anomaly ? 5 : 0);
    }
    return cloud;
}

cloud::PointSource scan(Index points, const ScannerWaves& waves, double noise, unsigned seed = 1)
{
    return cloud::make_point_source(scanned_points(points, waves, noise, seed));
}

fit::DenseFit fit(const cloud::PointSource& points, const std::string& method = "auto")
{
    return fit::fit_scan(points, square_job(), {}, method, "scan");
}

struct Outcome {
    double shift = 0, lowest = 0; ///< predicted; of the fitted surface above the sphere, inside B
    double largest = 0;           ///< |error| there
};

Outcome judge(const surface::Surface& surface)
{
    Outcome outcome;
    outcome.shift = margin::predict_by_posterior(surface, square_job(), 0.99, 1).shift;
    const Eigen::Matrix2Xd xy = margin::anomaly_grid(square_job(), 16);
    const VectorXd z = surface::heights(surface, xy);
    for (Index i = 0; i < xy.cols(); ++i) {
        const double error = z[i] - sphere(xy(0, i), xy(1, i));
        outcome.lowest = std::min(outcome.lowest, error);
        outcome.largest = std::max(outcome.largest, std::abs(error));
    }
    return outcome;
}

// The scanner's waves do not average out: 0.05 mm rms of them leave about the same margin whatever the number of
// points, enough for the sphere beneath.
TEST(ScanFit, margin_rests_on_the_waves_not_on_the_number_of_points)
{
    for (int seed = 1; seed <= draws(3); ++seed) {
        const ScannerWaves waves(0.05, 8, static_cast<unsigned>(seed));
        double few = 0;
        for (const Index points : {1000, 10000, 100000}) {
            const Outcome outcome = judge(fit(scan(points, waves, 0.02)).fit.surface);
            EXPECT_GT(outcome.shift, -outcome.lowest) << seed << ' ' << points;
            EXPECT_GT(outcome.shift, 0.02) << seed << ' ' << points;
            EXPECT_LT(outcome.shift, 0.3) << seed << ' ' << points;
            if (points == 1000) few = outcome.shift;
            EXPECT_LT(outcome.shift, 1.25 * few) << seed << ' ' << points;
        }
    }
}

TEST(ScanFit, finds_the_family_without_waves)
{
    const fit::DenseFit result = fit(scan(20000, ScannerWaves(0, 8, 1), 0.02));
    const Outcome outcome = judge(result.fit.surface);
    EXPECT_NEAR(result.point_sigma, 0.02, 0.001);
    EXPECT_LT(outcome.shift, 0.02);
    EXPECT_GT(outcome.shift, -outcome.lowest);
    EXPECT_LT(outcome.largest, 0.003); // a micrometre of noise, and the sphere's curvature within a group
}

// A flat without any noise, as a simulated scan has it: the cone and the torus nearest to it have parameters that no
// height depends on, and no number that is none may come of them.
TEST(ScanFit, fits_a_perfect_flat)
{
    for (const double height : {0.0, 5.0}) {
        const std::shared_ptr<cloud::Cloud> flat = scanned_points(100, ScannerWaves(0, 8, 1), 0, 1);
        flat->xyz.row(2).setConstant(height);
        const surface::Surface surface = fit(cloud::make_point_source(flat)).fit.surface;
        const Eigen::Matrix2Xd xy = margin::anomaly_grid(square_job(), 16);
        for (const surface::WeightedShape& member : surface::weighted_shapes(surface)) {
            EXPECT_TRUE(member.covariance.allFinite());
            EXPECT_LT((surface::heights(member.shape, xy).array() - height).abs().maxCoeff(), 1e-4);
        }
        const double shift = margin::predict_by_posterior(surface, square_job(), 0.99, 1).shift;
        EXPECT_GE(shift, 0);
        EXPECT_LT(shift, 1e-4);
    }
}

// Every method takes the representatives, so that none hangs on the number of points.
TEST(ScanFit, no_method_sees_more_than_the_representatives)
{
    const cloud::PointSource points = scan(20000, ScannerWaves(0, 8, 1), 0.02);
    for (const std::string& method : fit::fit_methods()) {
        if (method == "torus" || method == "cone") continue; // a sphere determines neither
        const surface::Surface surface = fit(points, method).fit.surface;
        EXPECT_LE(static_cast<std::size_t>(surface.touches.cols()), fit::kMaxRepresentatives) << method;
        EXPECT_TRUE(std::isfinite(surface::height(surface, {20, 20}))) << method;
    }
}

// Reference: the noise of the mean of so many points.
TEST(Representatives, hold_the_same_share_of_the_points)
{
    const cloud::PointSource source = scan(40000, ScannerWaves(0, 8, 1), 0.05);
    const fit::DensePoints points = fit::dense_points(source, square_job(), {}, "scan");
    const fit::RobustSpline spline = fit::fit_robust_spline(points, "scan");
    const fit::Representatives all = fit::condense(points, spline);
    ASSERT_EQ(all.xyz.cols(), static_cast<Index>(fit::kMaxRepresentatives));
    const double each = 0.05 / std::sqrt(static_cast<double>(spline.counts.used) / 200);
    EXPECT_GT(all.sigma, 0.9 * each);
    EXPECT_LT(all.sigma, 1.5 * each);
    double squares = 0;
    for (const auto& p : all.xyz.colwise()) {
        EXPECT_GT(p.head<2>().cwiseAbs().maxCoeff(), kHalfB - 1);
        squares += std::pow(p.z() - sphere(p.x(), p.y()), 2);
    }
    EXPECT_NEAR(std::sqrt(squares / 200), each, 0.3 * each);
}

// The quarters of a group see waves that are shorter than it.
TEST(Representatives, are_as_uncertain_as_short_waves_make_them)
{
    const cloud::PointSource source = scan(100000, ScannerWaves(0.05, 1, 1), 0.001);
    const fit::DensePoints points = fit::dense_points(source, square_job(), {}, "scan");
    const double sigma = fit::condense(points, fit::fit_robust_spline(points, "scan")).sigma;
    EXPECT_GT(sigma, 0.005);
    EXPECT_LT(sigma, 0.05);
}

// At a corner of S the scan has nothing but an inner face, 9 mm wide and 8 mm deeper.
TEST(Representatives, leave_out_what_lies_apart)
{
    const std::shared_ptr<cloud::Cloud> cloud = scanned_points(40000, ScannerWaves(0, 8, 1), 0.02, 1);
    for (auto p : cloud->xyz.colwise())
        if (p.head<2>().minCoeff() > kHalfS - 9) p.z() -= 8;
    const fit::DensePoints points = fit::dense_points(cloud::make_point_source(cloud), square_job(), {}, "scan");
    const fit::Representatives all = fit::condense(points, fit::fit_robust_spline(points, "scan"));
    EXPECT_GE(all.dropped, 1u);
    for (const auto& p : all.xyz.colwise()) EXPECT_NEAR(p.z(), sphere(p.x(), p.y()), 0.5);
}

TEST(ScanFit, threads_do_not_matter)
{
    const cloud::PointSource points = scan(20000, ScannerWaves(0.05, 8, 1), 0.02);
    const auto text = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return surface::to_json(fit(points).fit.surface).text();
    };
    EXPECT_EQ(text(2), text(1));
}

} // namespace scan_fit_test
} // namespace fettle
