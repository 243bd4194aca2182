// Waves about a family beside Bayes' rule in full: the family's parameters as normal with a huge variance.

#include "margin/waves.h"

#include "core/cholesky.h"
#include "fit/bspline.h"
#include "fit/correlation.h"
#include "fit/family.h"
#include "fit/fit.h"
#include "fit/process.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

namespace waves_test {

using namespace fettle;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What fit_family() makes of touches.
surface::Surface fitted(const fit::FitInput& input, const std::string& family)
{
    surface::Surface surface = fit::begin_surface(input, family, fit::kSampleRoles, 3);
    const fit::TouchSet touches = fit::make_touch_set(surface, input.job);
    fit::FitCandidate candidate = fit::fit_family(family, touches, fit::all_touches(touches)).value();
    surface.shape = std::move(candidate.shape);
    surface.covariance = std::move(candidate.covariance);
    surface.outliers = std::move(candidate.outliers);
    return surface;
}

/// Touches of a surface z(x, y), on a ring about B.
template <class Height>
fit::FitInput touches_of(const Height& z)
{
    fit::FitInput input;
    input.job.probe.accuracy = 0.127;
    input.xyz.resize(3, 14);
    input.roles = Eigen::VectorXi::Ones(14);
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, fit::touch_sigma(input.job.probe));
    for (int i = 0; i < 14; ++i) {
        const double angle = 2 * M_PI * i / 14, r = i % 2 == 0 ? 20 : 27, x = r * std::cos(angle),
                     y = r * std::sin(angle);
        input.xyz.col(i) << x, y, z(x, y) + noise(random);
    }
    return input;
}

/// A plane with waves. Some touches, beside each other, are too high.
surface::Surface touched_plane(double height_of_waves, int high_touches = 0, double too_high = 0)
{
    fit::FitInput input =
        touches_of([&](double x, double y) { return 0.1 * x - 0.05 * y + height_of_waves * std::sin(x / 6); });
    input.xyz.row(2).head(high_touches).array() += too_high;
    return fitted(input, "plane");
}

Eigen::Matrix2Xd places()
{
    Eigen::Matrix2Xd xy(2, 5);
    xy << 0, 8, -8, 3, -5, 0, 4, 6, -9, -2;
    return xy;
}

/// What Bayes' rule says of waves of one amplitude and length: ln of the evidence, mean and covariance of the heights
/// at places().
struct Direct {
    double log_evidence;
    VectorXd mean;
    MatrixXd covariance;
};

Direct direct(const surface::Surface& plane, const Eigen::Matrix3Xd& touches, double amplitude, double length)
{
    constexpr double kHuge = 1e4; // of the plane's parameters, mm²
    const Eigen::Matrix2Xd at = touches.topRows<2>(), xy = places();
    const fit::Correlation correlation{fit::Kernel::matern52, length};
    const MatrixXd F = surface::height_gradients(plane.shape, at), G = surface::height_gradients(plane.shape, xy);
    const auto prior = [&](const MatrixXd& f, const Eigen::Matrix2Xd& a, const MatrixXd& g, const Eigen::Matrix2Xd& b) {
        return MatrixXd(kHuge * f.transpose() * g +
                        std::pow(amplitude * plane.touch_sigma, 2) * fit::correlation_matrix(correlation, a, b));
    };
    MatrixXd V = prior(F, at, F, at);
    V.diagonal().array() += plane.touch_sigma * plane.touch_sigma;
    const core::Cholesky v(V);
    const VectorXd residuals = touches.row(2).transpose() - surface::heights(plane.shape, at);
    const MatrixXd cross = prior(G, xy, F, at);
    return {-v.L().diagonal().array().log().sum() - residuals.dot(v.solve(residuals)) / 2, cross * v.solve(residuals),
            prior(G, xy, G, xy) - cross * v.solve(cross.transpose())};
}

/// Waves beside Bayes' rule. @param expected  with prior odds of each to no waves as 1 to 9   @param without  ln of the
/// evidence of no waves
void expect_bayes_rule(const surface::Surface& plane, const std::vector<Direct>& expected, double without)
{
    const std::vector<margin::Waves> waves = margin::waves_about({1, plane.shape, plane.covariance}, plane, places());
    double sum = 0.75;
    std::vector<Direct> that_matter;
    for (const Direct& one : expected) sum += 0.25 / 3 * std::exp(one.log_evidence - without);
    for (const Direct& one : expected)
        if (0.25 / 3 * std::exp(one.log_evidence - without) / sum > 1e-3) that_matter.push_back(one);
    ASSERT_EQ(waves.size(), that_matter.size());
    for (std::size_t k = 0; k < waves.size(); ++k) {
        const double probability = 0.25 / 3 * std::exp(that_matter[k].log_evidence - without) / sum;
        EXPECT_NEAR(waves[k].probability, probability, 1e-4 * probability);
        const double sigma = std::sqrt(that_matter[k].covariance.diagonal().maxCoeff());
        EXPECT_LT((waves[k].offset - that_matter[k].mean).cwiseAbs().maxCoeff(), 1e-4 * sigma);
        EXPECT_LT((waves[k].root * waves[k].root.transpose() - that_matter[k].covariance).cwiseAbs().maxCoeff(),
                  1e-4 * sigma * sigma);
    }
}

double radius_of(const Eigen::Matrix3Xd& touches)
{
    const Eigen::Matrix2Xd xy = touches.topRows<2>();
    return (xy.colwise() - xy.rowwise().mean().eval()).colwise().norm().maxCoeff();
}

TEST(Waves, are_those_of_bayes_rule)
{
    const surface::Surface plane = touched_plane(0.05);
    const double radius = radius_of(plane.touches);
    std::vector<Direct> expected;
    for (const double length : {0.25, 0.5, 1.0}) expected.push_back(direct(plane, plane.touches, 4, length * radius));
    expect_bayes_rule(plane, expected, direct(plane, plane.touches, 0, radius).log_evidence);
}

TEST(Waves, explain_touches_that_the_fit_left_out)
{
    const surface::Surface plane = touched_plane(0, 2, 0.35);
    ASSERT_EQ(plane.outliers, (std::vector<Eigen::Index>{0, 1}));
    const Eigen::Matrix3Xd kept = plane.touches.rightCols(12);
    const double radius = radius_of(kept);
    // One touch in twenty is a gross error, uniformly distributed over an inch. The evidence leaves out √2π a touch.
    const double gross = 2 * std::log(0.05 / 0.95 * std::sqrt(2 * M_PI) / 25.4);
    std::vector<Direct> expected;
    for (const double length : {0.25, 0.5, 1.0}) {
        expected.push_back(direct(plane, kept, 4, length * radius));
        expected.back().log_evidence += gross;
    }
    for (const double amplitude : {4.0, 8.0, 16.0, 32.0})
        for (const double length : {0.25, 0.5, 1.0})
            expected.push_back(direct(plane, plane.touches, amplitude, length * radius));
    expect_bayes_rule(plane, expected, direct(plane, kept, 0, radius).log_evidence + gross);
}

double probability(const surface::Surface& plane)
{
    double sum = 0;
    for (const margin::Waves& one : margin::waves_about({1, plane.shape, plane.covariance}, plane, places()))
        sum += one.probability;
    return sum;
}

TEST(Waves, are_believed_where_the_touches_show_them)
{
    EXPECT_LT(probability(touched_plane(0)), 0.02);
    EXPECT_GT(probability(touched_plane(0.2)), 0.9);
}

TEST(Waves, of_a_chip_are_not_believed)
{
    EXPECT_LT(probability(touched_plane(0, 1, 1)), 0.05);
    EXPECT_GT(probability(touched_plane(0, 3, 0.35)), 0.9);
}

TEST(Waves, of_touches_alone_where_the_family_ends_within_the_scan)
{
    constexpr double kRadius = 30; // mm; the touches reach 27, the scan 32
    const surface::Surface sphere =
        fitted(touches_of([](double x, double y) { return std::sqrt(kRadius * kRadius - x * x - y * y); }), "sphere");
    Eigen::Matrix3Xd heights(3, 100);
    for (int i = 0; i < 100; ++i) {
        const double angle = 2.399963 * i, r = 20 + 12.0 * i / 100; // the golden angle
        heights.col(i) << r * std::cos(angle), r * std::sin(angle), std::sqrt(std::max(0.0, kRadius * kRadius - r * r));
    }
    const margin::ScanWaves scan(heights, margin::wave_lengths(sphere));
    const surface::WeightedShape member{1, sphere.shape, sphere.covariance};
    ASSERT_FALSE(surface::heights(member.shape, scan.places()).allFinite());
    const std::vector<margin::Waves> alone = margin::waves_about(member, sphere, places()),
                                     with_scan = margin::waves_about(member, sphere, places(), &scan);
    ASSERT_FALSE(alone.empty());
    ASSERT_EQ(with_scan.size(), alone.size());
    for (std::size_t k = 0; k < alone.size(); ++k) {
        EXPECT_EQ(with_scan[k].probability, alone[k].probability);
        EXPECT_EQ(with_scan[k].root, alone[k].root);
    }
}

/// A scan of a surface z(x, y) around B, with noise of 0.01 mm.
template <class Height>
margin::ScanWaves scan_of(const Height& z, const surface::Surface& surface)
{
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0, 0.01);
    Eigen::Matrix3Xd heights(3, 150);
    for (int i = 0; i < 150; ++i) {
        const double angle = 2.399963 * i, r = 16 + 12.0 * i / 150; // the golden angle
        const double x = r * std::cos(angle), y = r * std::sin(angle);
        heights.col(i) << x, y, z(x, y) + noise(random);
    }
    return {heights, margin::wave_lengths(surface)};
}

TEST(Waves, of_a_process_told_a_scan_are_those_about_its_trend)
{
    const auto hills = [](double x, double y) { return 0.002 * x * y + 0.4 * std::sin(x / 7) * std::cos(y / 9); };
    fit::FitInput input = touches_of(hills);
    input.job.anomaly.resize(3, 4);
    input.job.anomaly << -10, 10, 10, -10, -10, -10, 10, 10, 0, 0, 0, 0;
    const surface::Surface quadratic = fitted(input, "quadratic");
    surface::Surface process = fit::begin_surface(input, "freeform", fit::kSampleRoles, 3);
    fit::FitCandidate gp =
        fit::fit_gaussian_process(fit::make_touch_set(process, input.job), fit::spline_grid(input, process.touches))
            .value();
    process.shape = std::move(gp.shape);
    process.covariance = std::move(gp.covariance);
    ASSERT_TRUE(gp.outliers.empty() && quadratic.outliers.empty());
    const surface::WeightedShape member{1, process.shape, process.covariance};
    EXPECT_TRUE(margin::waves_about(member, process, places()).empty()); // by the touches alone it has waves of its own
    const margin::ScanWaves scan = scan_of(hills, process);
    const std::vector<margin::Waves> waves = margin::waves_about(member, process, places(), &scan);

    // The sizes that the scan shows, each weighed by the touches: Bayes' rule in full.
    const MatrixXd F = surface::height_gradients(quadratic.shape, scan.places()).transpose();
    const VectorXd residuals = scan.z() - surface::heights(quadratic.shape, scan.places());
    std::vector<std::pair<double, Direct>> expected;
    double max = -INFINITY, sum = 0;
    for (const margin::WaveSize& size : scan.sizes(F, residuals, 0.25)) {
        const double amplitude = size.amplitude / process.touch_sigma;
        expected.emplace_back(size.probability, direct(quadratic, process.touches, amplitude, size.length));
        max = std::max(max, expected.back().second.log_evidence);
    }
    for (auto& [probability, one] : expected) sum += probability *= std::exp(one.log_evidence - max);
    const VectorXd above = surface::heights(process.shape, places()) - surface::heights(quadratic.shape, places());
    std::size_t found = 0;
    double all = 0;
    for (const auto& [probability, one] : expected) {
        if (found == waves.size() || std::abs(probability / sum - waves[found].probability) > 1e-4) continue;
        const double sigma = std::sqrt(one.covariance.diagonal().maxCoeff());
        EXPECT_LT((waves[found].offset + above - one.mean).cwiseAbs().maxCoeff(), 1e-3 * sigma);
        EXPECT_LT((waves[found].root * waves[found].root.transpose() - one.covariance).cwiseAbs().maxCoeff(),
                  1e-3 * sigma * sigma);
        all += waves[found++].probability;
    }
    EXPECT_EQ(found, waves.size());
    EXPECT_GT(all, 0.99); // the scan leaves no doubt that there are waves
}

} // namespace waves_test
