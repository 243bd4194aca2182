// Waves about a family beside Bayes' rule in full: the family's parameters as normal with a huge variance.

#include "margin/waves.h"

#include "core/cholesky.h"
#include "fit/correlation.h"
#include "fit/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace waves_test {

using namespace fettle;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Touches of a plane with waves, on a ring about B.
surface::Surface touched_plane(double height_of_waves)
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
        input.xyz.col(i) << x, y, 0.1 * x - 0.05 * y + height_of_waves * std::sin(x / 6) + noise(random);
    }
    return fit::fit_surface(input, "plane").surface;
}

Eigen::Matrix2Xd places()
{
    Eigen::Matrix2Xd xy(2, 5);
    xy << 0, 8, -8, 3, -5, 0, 4, 6, -9, -2;
    return xy;
}

/// Of one amplitude and length: ln of the evidence, mean and covariance of the heights at places().
struct Direct {
    double log_evidence;
    VectorXd mean;
    MatrixXd covariance;
};

Direct direct(const surface::Surface& plane, double amplitude, double length)
{
    constexpr double kHuge = 1e3; // of the plane's parameters, mm²
    const Eigen::Matrix2Xd at = plane.touches.topRows<2>(), xy = places();
    const fit::Correlation correlation{fit::Kernel::matern52, length};
    const MatrixXd F = surface::height_gradients(plane.shape, at), G = surface::height_gradients(plane.shape, xy);
    const auto prior = [&](const MatrixXd& f, const Eigen::Matrix2Xd& a, const MatrixXd& g, const Eigen::Matrix2Xd& b) {
        return MatrixXd(kHuge * f.transpose() * g +
                        std::pow(amplitude * plane.touch_sigma, 2) * fit::correlation_matrix(correlation, a, b));
    };
    MatrixXd V = prior(F, at, F, at);
    V.diagonal().array() += plane.touch_sigma * plane.touch_sigma;
    const core::Cholesky v(V);
    const VectorXd residuals = plane.touches.row(2).transpose() - surface::heights(plane.shape, at);
    const MatrixXd cross = prior(G, xy, F, at);
    return {-v.L().diagonal().array().log().sum() - residuals.dot(v.solve(residuals)) / 2, cross * v.solve(residuals),
            prior(G, xy, G, xy) - cross * v.solve(cross.transpose())};
}

TEST(Waves, are_those_of_bayes_rule)
{
    const surface::Surface plane = touched_plane(0.05);
    const std::vector<margin::Waves> waves = margin::waves_about({1, plane.shape, plane.covariance}, plane, places());
    ASSERT_EQ(waves.size(), 9U); // all matter here
    const double radius = 27;
    const double without = direct(plane, 0, radius).log_evidence;
    double sum = 0.92;
    std::vector<Direct> expected;
    for (const double length : {0.25, 0.5, 1.0})
        for (const double amplitude : {0.5, 1.0, 2.0}) {
            expected.push_back(direct(plane, amplitude, length * radius));
            sum += 0.08 / 9 * std::exp(expected.back().log_evidence - without);
        }
    for (std::size_t k = 0; k < waves.size(); ++k) {
        const double probability = 0.08 / 9 * std::exp(expected[k].log_evidence - without) / sum;
        EXPECT_NEAR(waves[k].probability, probability, 1e-4 * probability);
        const double sigma = std::sqrt(expected[k].covariance.diagonal().maxCoeff());
        EXPECT_LT((waves[k].offset - expected[k].mean).cwiseAbs().maxCoeff(), 1e-4 * sigma);
        EXPECT_LT((waves[k].root * waves[k].root.transpose() - expected[k].covariance).cwiseAbs().maxCoeff(),
                  1e-4 * sigma * sigma);
    }
}

TEST(Waves, are_believed_where_the_touches_show_them)
{
    const auto probability = [](double height) {
        const surface::Surface plane = touched_plane(height);
        double sum = 0;
        for (const margin::Waves& one : margin::waves_about({1, plane.shape, plane.covariance}, plane, places()))
            sum += one.probability;
        return sum;
    };
    EXPECT_LT(probability(0), 0.15);
    EXPECT_GT(probability(0.2), 0.9);
}

} // namespace waves_test
