// Waves that a scan shows, beside Bayes' rule in full and beside the waves that were drawn.

#include "margin/scan_waves.h"

#include "core/cholesky.h"
#include "core/error.h"
#include "fit/correlation.h"
#include "sampling/scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace scan_waves_test {

using namespace fettle;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const std::vector<double> kLengths = {5, 10, 20}; // mm

/// Places of a ring about B.
Eigen::Matrix2Xd ring(int count)
{
    Eigen::Matrix2Xd xy(2, count);
    for (int i = 0; i < count; ++i) {
        const double angle = 2.399963 * i, r = 12 + 8.0 * i / count; // the golden angle, mm
        xy.col(i) << r * std::cos(angle), r * std::sin(angle);
    }
    return xy;
}

/// A plane's trend: 1, x, y.
MatrixXd trend(const Eigen::Matrix2Xd& xy)
{
    MatrixXd F(xy.cols(), 3);
    F << VectorXd::Ones(xy.cols()), xy.transpose();
    return F;
}

Eigen::Matrix3Xd heights(const Eigen::Matrix2Xd& xy, const VectorXd& z)
{
    Eigen::Matrix3Xd all(3, xy.cols());
    all << xy, z.transpose();
    return all;
}

/// A plane with waves of that amplitude and length, and noise.
VectorXd draw(const Eigen::Matrix2Xd& xy, double amplitude, double length, double noise, unsigned seed)
{
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    VectorXd g(xy.cols()), e(xy.cols());
    for (double& one : g) one = normal(random);
    for (double& one : e) one = normal(random);
    MatrixXd K = fit::correlation_matrix({fit::Kernel::matern52, length}, xy, xy);
    K.diagonal().array() += 1e-9;
    return amplitude * (core::Cholesky(K).L() * g) + noise * e + 0.3 * xy.row(0).transpose() -
           0.1 * xy.row(1).transpose() + VectorXd::Constant(xy.cols(), 7);
}

/// Probabilities by the evidence of each size and noise, with the plane's parameters as normal with a huge variance.
std::map<std::pair<double, double>, double> direct(const Eigen::Matrix2Xd& xy, const VectorXd& z, double rms,
                                                   double share)
{
    constexpr double kHuge = 1e5;
    const MatrixXd F = trend(xy);
    std::map<std::pair<double, double>, double> logs;
    double max = -INFINITY, sum = 0;
    const auto evidence = [&](double amplitude, double length, double noise) {
        MatrixXd V = kHuge * F * F.transpose() +
                     amplitude * amplitude * fit::correlation_matrix({fit::Kernel::matern52, length}, xy, xy);
        V.diagonal().array() += noise * noise;
        const core::Cholesky v(V);
        return -v.L().diagonal().array().log().sum() - z.dot(v.solve(z)) / 2;
    };
    std::vector<std::pair<std::pair<double, double>, double>> all;
    for (double noise = rms / 32; noise < 1.5 * rms; noise *= 2) {
        for (const double length : kLengths)
            for (double amplitude = rms / 8; amplitude < 9 * rms; amplitude *= 2)
                all.push_back({{amplitude, length}, evidence(amplitude, length, noise) + std::log(share / 21)});
        all.push_back({{0, 0}, evidence(0, 1, noise) + std::log(1 - share)});
    }
    for (const auto& [size, log] : all) max = std::max(max, log);
    for (const auto& [size, log] : all) sum += std::exp(log - max);
    for (const auto& [size, log] : all) logs[size] += std::exp(log - max) / sum;
    return logs;
}

TEST(ScanWaves, sizes_are_those_of_bayes_rule)
{
    const Eigen::Matrix2Xd xy = ring(60);
    const VectorXd z = draw(xy, 0.03, 10, 0.02, 1);
    const MatrixXd F = trend(xy);
    const VectorXd about = z - F * core::least_squares_by_qr(F, z).x;
    const double rms = std::sqrt(about.squaredNorm() / (60 - 3));
    const std::map<std::pair<double, double>, double> expected = direct(xy, z, rms, 0.25);
    const std::vector<margin::WaveSize> sizes = margin::ScanWaves(heights(xy, z), kLengths).sizes(F, z, 0.25);
    ASSERT_EQ(sizes.size(), 22u);
    double sum = 0;
    for (const margin::WaveSize& size : sizes) {
        sum += size.probability;
        double nearest = INFINITY, probability = -1;
        for (const auto& [key, value] : expected) {
            const double off = size.amplitude == 0
                                   ? key.first
                                   : std::abs(key.first - size.amplitude) / rms + std::abs(key.second - size.length);
            if (off < nearest) {
                nearest = off;
                probability = value;
            }
        }
        EXPECT_NEAR(size.probability, probability, 1e-4) << size.amplitude << " " << size.length;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
}

/// Root of the mean variance of the waves.
double expected_amplitude(const std::vector<margin::WaveSize>& sizes)
{
    double sum = 0;
    for (const margin::WaveSize& size : sizes) sum += size.probability * size.amplitude * size.amplitude;
    return std::sqrt(sum);
}

TEST(ScanWaves, finds_the_waves_that_were_drawn)
{
    const Eigen::Matrix2Xd xy = ring(300);
    const MatrixXd F = trend(xy);
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const VectorXd z = draw(xy, 0.05, 5, 0.02, seed);
        const double found = expected_amplitude(margin::ScanWaves(heights(xy, z), kLengths).sizes(F, z, 0.25));
        // Forty independent patches of 5 mm know an amplitude to a tenth, and the grid's steps are factors of two.
        EXPECT_GT(found, 0.05 / 1.6) << seed;
        EXPECT_LT(found, 0.05 * 1.6) << seed;
    }
}

TEST(ScanWaves, finds_none_in_noise)
{
    const Eigen::Matrix2Xd xy = ring(300);
    const MatrixXd F = trend(xy);
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const VectorXd z = draw(xy, 0, 5, 0.02, seed);
        EXPECT_LT(expected_amplitude(margin::ScanWaves(heights(xy, z), kLengths).sizes(F, z, 0.25)), 0.02 / 4) << seed;
    }
}

job::Job square_job()
{
    job::Job job;
    job.anomaly.resize(3, 4);
    job.anomaly << -5, 5, 5, -5, -5, -5, 5, 5, 0, 0, 0, 0;
    job.sampling = 3 * job.anomaly;
    return job;
}

/// A level scan at z = 2 over a square, with a bump over B and a spike beside it.
cloud::Cloud scan_with_bump(double half)
{
    cloud::Cloud cloud;
    const int n = static_cast<int>(2 * half / 0.25) + 1;
    cloud.xyz.resize(3, n * n);
    for (int j = 0, k = 0; j < n; ++j)
        for (int i = 0; i < n; ++i, ++k) {
            const double x = 0.25 * i - half, y = 0.25 * j - half;
            const bool is_bump = std::max(std::abs(x), std::abs(y)) < 4, is_spike = std::hypot(x - 9, y - 9) < 1.5;
            cloud.xyz.col(k) << x, y, 2 + 1e-3 * std::sin(7 * x) * std::sin(5 * y) + (is_bump ? 3 : is_spike ? 1 : 0);
        }
    return cloud;
}

TEST(ScanWaves, heights_are_of_the_metal_around_the_anomaly)
{
    const Eigen::Matrix3Xd around =
        margin::heights_around_anomaly(sampling::Scan(scan_with_bump(20)), square_job(), "scan");
    EXPECT_GT(around.cols(), 270);
    EXPECT_LT(around.cols(), 310);
    for (const auto& point : around.colwise()) {
        EXPECT_GT(std::max(std::abs(point.x()), std::abs(point.y())), 5);
        EXPECT_LT(std::max(std::abs(point.x()), std::abs(point.y())), 15);
        EXPECT_NEAR(point.z(), 2, 0.01) << "at " << point.x() << ", " << point.y();
    }
}

TEST(ScanWaves, scan_that_ends_at_the_anomaly_is_refused)
{
    EXPECT_THROW(margin::heights_around_anomaly(sampling::Scan(scan_with_bump(6)), square_job(), "scan"),
                 core::InputError);
}

} // namespace scan_waves_test
