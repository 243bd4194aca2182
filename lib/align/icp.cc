#include "align/icp.h"

#include <Eigen/Dense>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

// Tukey's biweight at 95 % efficiency for normal noise, and the factor from the median |residual| to sigma.
constexpr double kTukey = 4.685;
constexpr double kMedianToSigma = 1.4826;
// Of float coordinates, as a share of the scan's radius; and of sums of doubles, as a share of how far off it lies.
constexpr double kRounding = 1e-7, kDoubleRounding = 1e-14;
// A motion that changes the distances by less than a hundredth of itself is made by what normals are wrong by.
constexpr double kLeastSlope = 0.01;
// A step that moves the scan by less than this share of what noise leaves open is none.
constexpr double kStill = 1e-2;
// Trimming looks at shares from here on: with fewer points a chance plane would fit.
constexpr double kLeastOverlap = 0.3;

double median_of(Eigen::VectorXd values)
{
    if (values.size() == 0) return 0;
    const auto middle = values.begin() + values.size() / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The trim that the options ask for.
Trim trim_of(const Eigen::VectorXd& closest, const IcpOptions& options, double floor)
{
    if (options.max_distance) {
        const double cut = *options.max_distance;
        return {cut, closest.array().min(cut).square().mean()};
    }
    if (!options.overlap) return trim(closest, floor);
    Eigen::VectorXd sorted = closest;
    std::sort(sorted.begin(), sorted.end());
    const auto kept = static_cast<Eigen::Index>(std::ceil(*options.overlap * static_cast<double>(closest.size())));
    const Eigen::Index n = std::clamp<Eigen::Index>(kept, 1, closest.size());
    return {sorted[n - 1], sorted.head(n).squaredNorm() / static_cast<double>(n)};
}

std::vector<Eigen::Index> within(const Eigen::VectorXd& closest, double cut)
{
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < closest.size(); ++i)
        if (closest[i] <= cut) kept.push_back(i);
    return kept;
}

// Sets the cut and sigma. Returns the points within. Trimming cuts into the tails of the noise: where it is left to
// itself, the cut moves out to where Tukey's weights end, as sigma follows from what is within.
std::vector<Eigen::Index> judge_noise(IcpFit& fit, const Distances& d, double cut, const IcpOptions& options,
                                      double rounding)
{
    constexpr int kRounds = 5; // sigma settles in two or three
    std::vector<Eigen::Index> kept;
    fit.cut = cut;
    for (int round = 0; round < kRounds; ++round) {
        kept = within(d.closest, fit.cut);
        fit.sigma = std::max(kMedianToSigma * median_of(d.across(kept).cwiseAbs()), rounding);
        if (options.max_distance || options.overlap || kTukey * fit.sigma <= fit.cut) break;
        fit.cut = kTukey * fit.sigma;
    }
    return kept;
}

} // namespace

Distances distances(const Eigen::Matrix3Xd& points, const AlignReference& reference)
{
    Distances d{Eigen::VectorXd(points.cols()), Eigen::VectorXd(points.cols()), Eigen::Matrix3Xd(3, points.cols())};
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, points.cols()), [&](const auto& range) {
        for (Eigen::Index i = range.begin(); i < range.end(); ++i) {
            const AlignReference::Foot foot = reference.closest(points.col(i));
            const Eigen::Vector3d offset = points.col(i) - foot.point;
            d.closest[i] = offset.norm();
            d.across[i] = offset.dot(foot.normal);
            d.normal.col(i) = foot.normal;
        }
    });
    return d;
}

Trim trim(Eigen::VectorXd closest, double floor)
{
    std::sort(closest.begin(), closest.end());
    const auto n = closest.size();
    const auto first = static_cast<Eigen::Index>(kLeastOverlap * static_cast<double>(n));
    double sum = 0;
    Trim best{0, std::numeric_limits<double>::infinity()};
    for (Eigen::Index i = 0; i < n; ++i) {
        sum += closest[i] * closest[i];
        const double share = static_cast<double>(i + 1) / static_cast<double>(n);
        const double misfit = (sum / static_cast<double>(i + 1) + floor * floor) / std::pow(share, 3);
        if (i >= first && misfit <= best.misfit) best = {closest[i], misfit};
    }
    return best;
}

IcpFit icp(const Eigen::Isometry3d& start, const Eigen::Matrix3Xd& scan, const TwistFrame& about,
           const AlignReference& reference, const IcpOptions& options)
{
    IcpFit fit;
    fit.T_reference_scan = start;
    const double rounding =
        kRounding * about.radius + kDoubleRounding * std::max(about.centre.norm(), (start * about.centre).norm());
    Twist last = Twist::Zero();
    double share = 1; // of a step that is taken
    for (;; ++fit.iterations) {
        const Eigen::Matrix3Xd at = fit.T_reference_scan * scan;
        const Distances d = distances(at, reference);
        const Trim trimmed = trim_of(d.closest, options, rounding);
        fit.misfit = trimmed.misfit;
        const std::vector<Eigen::Index> kept = judge_noise(fit, d, trimmed.cut, options, rounding);
        fit.overlap = static_cast<double>(kept.size()) / static_cast<double>(at.cols());

        const TwistFrame frame{fit.T_reference_scan * about.centre, about.radius};
        fit.information.setZero();
        Twist b = Twist::Zero();
        double weights = 0;
        for (const Eigen::Index i : kept) {
            const double relative = d.across[i] / (kTukey * fit.sigma);
            if (std::abs(relative) >= 1) continue;
            const double weight = std::pow(1 - relative * relative, 2);
            const Twist g = frame.gradient(at.col(i), d.normal.col(i));
            fit.information.noalias() += weight * g * g.transpose();
            b += weight * d.across[i] * g;
            weights += weight;
        }
        fit.least_information = kLeastSlope * kLeastSlope * weights;
        if (fit.iterations == options.iterations || fit.converged) break;
        const Twist x = solve_step(fit.information, b, options.held, fit.least_information);
        // Where a foot jumps from one disc to the next, or a point across the cut, a step may lead back and forth:
        // one that turns back and is no shorter is halved, and so are those after it.
        if (x.dot(last) < 0 && x.norm() > last.norm() / 2) share /= 2;
        last = x;
        fit.T_reference_scan = straightened(frame.motion(share * x) * fit.T_reference_scan);
        fit.converged = kept.size() >= 6 && share * x.norm() <= kStill * fit.sigma / std::sqrt(std::max(weights, 1.0));
    }
    return fit;
}

} // namespace fettle
