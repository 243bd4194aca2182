// Wang's regressions on surfaces that are neither cylinders nor spheres (2007, 4.5): how far their prediction of error
// band and shift distance is from what the simple strategy gives. The paper names the number of surfaces, not their
// form.

#include "cli/tool.h"
#include "fit/family.h"
#include "fit/griddata.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/regression.h"
#include "sampling/estimate.h"
#include "sampling/touch_plan.h"
#include "tables.h"

#include <array>
#include <cmath>
#include <ostream>
#include <vector>

using namespace fettle;
using namespace fettle::study;

namespace {

/// Heights and places in inches.
using Formula = double (*)(double x, double y);

double ellipsoid(double x, double y) { return 35 * std::sqrt(1 - x * x / 2500 - y * y / 1600); }
double paraboloid(double x, double y) { return -x * x / 70 - y * y / 140; }
double torus(double x, double y) { return std::sqrt(std::pow(60 + std::sqrt(1600 - y * y), 2) - x * x) - 100; }
double bell(double x, double y) { return 6 * std::exp(-x * x / 500 - y * y / 400); }
double quartic(double x, double y) { return -(x * x + y * y) / 90 - (x * x * x * x + y * y * y * y) / 60000; }

double parabola(double x, double) { return x * x / 80; }
double ellipse(double x, double) { return 30 * std::sqrt(1 - x * x / 2000); }
double cosine(double x, double) { return 8 * std::cos(x / 18); }
double catenary(double x, double) { return 40 * std::cosh(x / 40); }
double s_shape(double x, double) { return x * x / 150 + x * x * x / 4000; }

double hyperbolic(double x, double y) { return x * x / 70 - y * y / 120; }
double pass(double x, double y) { return 10 * std::cos(y / 25) - 10 * std::cos(x / 25); }
double ring_inside(double x, double y) { return std::sqrt(std::pow(80 - std::sqrt(1600 - y * y), 2) - x * x); }
double skew(double x, double y) { return x * x / 100 - y * y / 90 + x * y / 300; }
double saddle_of_4(double x, double y) { return x * x / 90 - y * y / 80 + (x * x * x * x - y * y * y * y) / 80000; }

constexpr std::array<Formula, 5> kDomes = {ellipsoid, paraboloid, torus, bell, quartic};
constexpr std::array<Formula, 5> kSections = {parabola, ellipse, cosine, catenary, s_shape};
constexpr std::array<Formula, 5> kSaddles = {hyperbolic, pass, ring_inside, skew, saddle_of_4};
// An anomaly for each, and the farthest sampling distance; of the factorial experiment, in.
const std::array<Eigen::Vector2d, 5> kSizes = {
    Eigen::Vector2d(1, 1), {3.25, 1}, {3.25, 3.25}, {3.25, 5.5}, {5.5, 7.75}};
constexpr double kDistance = 3.25;
// Touch noise of the experiments of 4.5: normal, 99 % within ±0.005 in.
const sampling::TouchNoise kNormal = {sampling::TouchNoise::Kind::normal, kNoise.amplitude};

struct Kind {
    std::string name;
    margin::RegressionKind regression;
    const std::array<Formula, 5>& formulas;
    double sign = 1;
};

job::Job job_around(const Eigen::Vector2d& size, bool swept)
{
    job::Job job;
    job.surface = swept ? job::SurfaceType::swept : job::SurfaceType::freeform;
    job.ruling_direction = std::acos(0.0); // the sections are along x, so the rulings along y
    const Eigen::Vector2d half = size * kInch / 2;
    const Eigen::Vector2d outer = half.array() + kDistance * kInch;
    job.anomaly = rectangle(-half, half);
    job.sampling = rectangle(-outer, outer);
    return job;
}

void compare(const Kind& kind, std::size_t which, std::uint64_t seed, std::ostream& out)
{
    const bool swept = kind.regression == margin::RegressionKind::swept;
    const Formula formula = kind.formulas[which];
    const Height truth = [&](const Eigen::Vector2d& xy) {
        return kind.sign * kInch * formula(xy.x() / kInch, xy.y() / kInch);
    };
    fit::FitInput input;
    input.job = job_around(kSizes[which], swept);
    const sampling::TouchPlan plan = sampling::plan_touches(input.job);
    Eigen::Matrix3Xd touches(3, plan.size());
    touches << plan.xy, (study::heights(truth, plan.xy) + sampling::draw_noise(kNormal, plan.size(), seed)).transpose();
    input.xyz = touches;
    input.roles = plan.role;
    if (!swept) {
        const Eigen::Matrix3Xd estimated = sampling::estimated_points(input.job, touches, plan.curve, plan.role);
        input.xyz.conservativeResize(3, touches.cols() + estimated.cols());
        input.xyz.rightCols(estimated.cols()) = estimated;
        input.roles = Eigen::VectorXi::Constant(input.xyz.cols(), static_cast<int>(sampling::Role::near_anomaly));
    }
    const surface::Surface surface =
        swept ? fit::fit_family_by_name(input, "swept").surface : fit::fit_griddata(input).surface;
    const Eigen::Matrix2Xd inside = margin::anomaly_grid(input.job, kPlacesAcross);
    const Eigen::VectorXd errors = fettle::surface::heights(surface, inside) - study::heights(truth, inside);
    const Eigen::VectorXd terms = margin::regression_values(kind.regression, touches, input.job);
    const margin::Regression& published = margin::published_regression(kind.regression);
    const double band = margin::error_band(errors) / kInch, shift = margin::shift_distance(errors) / kInch;
    write(out, "others/" + kind.name + "/band", band);
    write(out, "others/" + kind.name + "/band_off", std::abs(published.band.dot(terms) - band));
    write(out, "others/" + kind.name + "/shift_off", std::abs(published.shift.dot(terms) - shift));
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Wang's regressions on surfaces that are neither cylinders nor spheres.", [](cli::Tool& t) {
            const int& trials = t.count("--trials", 20, "Draws of the noise", 1, 100000);
            t.parse();

            const std::vector<Kind> kinds = {{"swept", margin::RegressionKind::swept, kSections},
                                             {"concave", margin::RegressionKind::concave, kDomes, -1},
                                             {"convex", margin::RegressionKind::convex, kDomes},
                                             {"saddle", margin::RegressionKind::saddle, kSaddles}};
            for (const Kind& kind : kinds)
                for (std::size_t which = 0; which < kSizes.size(); ++which)
                    for (int trial = 1; trial <= trials; ++trial)
                        compare(kind, which, seed_of(t.seed(), static_cast<std::uint64_t>(trial)), t.output());
            return cli::Verdict::yes;
        });
}
