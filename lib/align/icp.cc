#include "align/icp.h"

#include "geometry/quantiles.h"

#include <Eigen/Dense>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::align {

namespace {

// Rounding of float coordinates, relative to the scan's radius; and of sums of doubles, relative to the distance of the
// scan from the origin.
constexpr double kFloatRounding = 1e-7, kDoubleRounding = 1e-14;
// A motion that changes the distances by less than this share of its own length may do so by errors of the normals.
constexpr double kMinSlope = 0.01;
// Converged: a step is shorter than this share of the standard error of the pose.
constexpr double kStepToleranceSigmas = 1e-2;
// A scan whose points are on average farther from the reference than this share of its own radius does not lie on it:
// the distances along the normals may vanish far away from it, too.
constexpr double kMaxDistanceRadii = 0.25;
// Trimming considers overlaps from here on: with fewer points a chance plane would fit.
constexpr double kMinOverlap = 0.3;

Trim trim_by_options(const Eigen::VectorXd& distances, const IcpOptions& options, double rounding)
{
    if (options.max_distance) {
        const double cutoff = *options.max_distance;
        return {cutoff, distances.array().min(cutoff).square().mean()};
    }
    if (!options.overlap) return estimate_overlap(distances, rounding);
    Eigen::VectorXd sorted = distances;
    std::sort(sorted.begin(), sorted.end());
    const auto overlapping = static_cast<Eigen::Index>(std::ceil(*options.overlap * distances.size()));
    const Eigen::Index n = std::clamp<Eigen::Index>(overlapping, 1, distances.size());
    return {sorted[n - 1], sorted.head(n).squaredNorm() / n};
}

std::vector<Eigen::Index> indices_within(const Eigen::VectorXd& distances, double cutoff)
{
    std::vector<Eigen::Index> within;
    for (Eigen::Index i = 0; i < distances.size(); ++i)
        if (distances[i] <= cutoff) within.push_back(i);
    return within;
}

// Estimates sigma and sets the cutoff. Returns the overlapping points. Trimming cuts off the tails of the noise: unless
// the options fix it, the cutoff is widened to the end of Tukey's weights, while sigma follows from the points within.
std::vector<Eigen::Index> estimate_noise(IcpFit& fit, const FootDistances& d, double cutoff, const IcpOptions& options,
                                         double rounding)
{
    constexpr int kMaxRounds = 5; // sigma converges in two or three
    std::vector<Eigen::Index> overlapping;
    fit.cutoff = cutoff;
    for (int round = 0; round < kMaxRounds; ++round) {
        overlapping = indices_within(d.absolute, fit.cutoff);
        fit.sigma =
            std::max(geometry::kMedianToSigma * geometry::median_absolute(d.along_normal(overlapping)), rounding);
        if (options.max_distance || options.overlap || geometry::kTukeyCutoff * fit.sigma <= fit.cutoff) break;
        fit.cutoff = geometry::kTukeyCutoff * fit.sigma;
    }
    return overlapping;
}

// Whether enough points overlap, and are near the reference for a scan of this radius.
bool lies_on_reference(const Eigen::VectorXd& distances, const std::vector<Eigen::Index>& overlapping, double radius)
{
    constexpr std::size_t kMinPoints = 6; // one for each degree of freedom
    return overlapping.size() >= kMinPoints &&
           std::sqrt(distances(overlapping).squaredNorm() / overlapping.size()) <= kMaxDistanceRadii * radius;
}

} // namespace

FootDistances foot_distances(const Eigen::Matrix3Xd& points, const AlignReference& reference)
{
    FootDistances d{Eigen::VectorXd(points.cols()), Eigen::VectorXd(points.cols()), Eigen::Matrix3Xd(3, points.cols())};
    tbb::parallel_for(Eigen::Index{0}, points.cols(), [&](Eigen::Index i) {
        const AlignReference::Foot foot = reference.closest(points.col(i));
        const Eigen::Vector3d offset = points.col(i) - foot.point;
        d.absolute[i] = offset.norm();
        d.along_normal[i] = offset.dot(foot.normal);
        d.normals.col(i) = foot.normal;
    });
    return d;
}

Trim estimate_overlap(Eigen::VectorXd absolute, double rounding)
{
    std::sort(absolute.begin(), absolute.end());
    const double n = absolute.size();
    const auto first = static_cast<Eigen::Index>(kMinOverlap * n);
    double sum = 0;
    Trim best{0, std::numeric_limits<double>::infinity()};
    for (Eigen::Index i = 0; i < absolute.size(); ++i) {
        sum += absolute[i] * absolute[i];
        const double misfit = (sum / (i + 1) + rounding * rounding) / std::pow((i + 1) / n, 3);
        if (i >= first && misfit <= best.misfit) best = {absolute[i], misfit};
    }
    return best;
}

IcpFit icp(const Eigen::Isometry3d& start, const Eigen::Matrix3Xd& scan, const TwistFrame& scan_frame,
           const AlignReference& reference, const IcpOptions& options)
{
    IcpFit fit;
    fit.T_reference_scan = start;
    const Eigen::Vector3d& centre = scan_frame.centre;
    const double rounding =
        kFloatRounding * scan_frame.radius + kDoubleRounding * std::max(centre.norm(), (start * centre).norm());
    Twist last_step = Twist::Zero();
    double step_share = 1; // share of each Gauss-Newton step that is taken
    for (;; ++fit.iterations) {
        const Eigen::Matrix3Xd points = fit.T_reference_scan * scan;
        const FootDistances d = foot_distances(points, reference);
        const Trim trim = trim_by_options(d.absolute, options, rounding);
        fit.misfit = trim.misfit;
        const std::vector<Eigen::Index> overlapping = estimate_noise(fit, d, trim.cutoff, options, rounding);
        fit.overlap = double(overlapping.size()) / points.cols();

        const TwistFrame frame{fit.T_reference_scan * centre, scan_frame.radius};
        fit.information.setZero();
        Twist b = Twist::Zero();
        double weights = 0;
        for (const Eigen::Index i : overlapping) {
            const double relative = d.along_normal[i] / (geometry::kTukeyCutoff * fit.sigma);
            if (std::abs(relative) >= 1) continue;
            const double weight = std::pow(1 - relative * relative, 2);
            const Twist g = frame.gradient(points.col(i), d.normals.col(i));
            fit.information.noalias() += weight * g * g.transpose();
            b += weight * d.along_normal[i] * g;
            weights += weight;
        }
        fit.min_information = kMinSlope * kMinSlope * weights;
        const bool is_last = fit.converged || fit.iterations == options.max_iterations;
        if (fit.converged) fit.converged = lies_on_reference(d.absolute, overlapping, scan_frame.radius);
        if (is_last) break;
        const Twist x = solve_step(fit.information, b, options.held, fit.min_information);
        // The steps may oscillate where a foot jumps from one disc to the next or a point across the cutoff. A step
        // that turns back and is not much shorter than the last halves itself and all later ones.
        if (x.dot(last_step) < 0 && x.norm() > last_step.norm() / 2) step_share /= 2;
        last_step = x;
        fit.T_reference_scan = orthonormalized(frame.motion(step_share * x) * fit.T_reference_scan);
        const double tolerance = kStepToleranceSigmas * fit.sigma / std::sqrt(std::max(weights, 1.0));
        fit.converged = step_share * x.norm() <= tolerance;
    }
    return fit;
}

} // namespace fettle::align
