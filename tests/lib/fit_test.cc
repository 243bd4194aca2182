#include "core/error.h"
#include "fit/bspline.h"
#include "fit/plane.h"
#include "fit/swept.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace fettle {
namespace {

constexpr double kInch = 25.4;

Job job_with(double accuracy, double theta = 0)
{
    Job job;
    job.theta = theta;
    job.probe.accuracy = accuracy;
    job.anomaly.resize(3, 4); // 2 x 2 in about the origin
    job.anomaly << -kInch, kInch, kInch, -kInch, -kInch, -kInch, kInch, kInch, 0, 0, 0, 0;
    return job;
}

/// Wang's layout for a 2 x 2 in anomaly in a 5 x 4 in patch: two lines each way, four touches on each (2007, 4.4.4).
Eigen::Matrix2Xd wang_layout()
{
    Eigen::Matrix2Xd xy(2, 16);
    int i = 0;
    for (const double line : {-1.0 / 3, 1.0 / 3})
        for (const double along : {-1.0, -0.5, 0.5, 1.0}) {
            xy.col(i++) << line * kInch, along * 2 * kInch;
            xy.col(i++) << (std::abs(along) < 1 ? along * 2 : along * 2.5) * kInch, line * kInch;
        }
    return xy;
}

template <typename Height>
FitInput touched(const Eigen::Matrix2Xd& xy, const Height& height, const Job& job)
{
    FitInput input;
    input.job = job;
    input.xyz.resize(3, xy.cols());
    for (Eigen::Index i = 0; i < xy.cols(); ++i) input.xyz.col(i) << xy.col(i), height(xy(0, i), xy(1, i));
    input.roles = Eigen::VectorXi::Ones(xy.cols());
    return input;
}

template <typename Height>
double largest_error(const Surface& surface, const Height& truth, double half)
{
    double largest = 0;
    for (double x = -half; x <= half; x += half / 5)
        for (double y = -half; y <= half; y += half / 5)
            largest = std::max(largest, std::abs(height(surface, {x, y}) - truth(x, y)));
    return largest;
}

double quadratic(double x, double y) { return 3 + 0.2 * x - 0.1 * y + 0.005 * x * x + 0.002 * x * y - 0.004 * y * y; }

TEST(Bspline, ReproducesQuadraticsExactly)
{
    const Fit fit = fit_bspline(touched(wang_layout(), quadratic, job_with(1e-4)));
    EXPECT_TRUE(fit.converged);
    EXPECT_LT(largest_error(fit.surface, quadratic, kInch), 1e-9);
}

TEST(Bspline, Speed)
{
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.05);
    FitInput input = touched(wang_layout(), quadratic, job_with(0.127));
    for (int k = 0; k < 5; ++k) {
        for (Eigen::Index i = 0; i < 16; ++i) input.xyz(2, i) += noise(random);
        const auto start = std::chrono::steady_clock::now();
        const Fit fit = fit_bspline(input);
        std::printf("%g ms, %d iterations, err %g sigma %g rms %g good %g N %d\n",
                    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(),
                    fit.iterations, largest_error(fit.surface, quadratic, kInch), sigma(fit.surface, {0, 0}),
                    fit.surface.rms, fit.surface.goodness, int(fit.surface.covariance.rows()));
    }
}

} // namespace
} // namespace fettle
