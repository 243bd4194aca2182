#include "align/align.h"

#include "align/pose_search.h"
#include "core/decompositions.h"
#include "core/error.h"

#include <Eigen/Dense>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

// Points that a place found by the search is judged with, those that the best of these places are compared with, and
// those that the last steps are taken with: more would make the figures of the fit no better than the scan's own errors
// leave them.
constexpr Eigen::Index kJudged = 400, kCompared = 2000, kFitted = 20000;
constexpr int kJudgedSteps = 30;
constexpr std::size_t kFinalists = 3; // of the places, so many are compared
// Two poses that put the scan closer together than this, in radii, are one.
constexpr double kSame = 0.1;

std::vector<IcpFit> fits(const std::vector<IcpFit>& starts, const Eigen::Matrix3Xd& points, const TwistFrame& about,
                         const AlignReference& reference, const IcpOptions& options)
{
    std::vector<IcpFit> found(starts.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found.size(), 1), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
            found[i] = icp(starts[i].T_reference_scan, points, about, reference, options);
    });
    std::stable_sort(found.begin(), found.end(), [](const IcpFit& a, const IcpFit& b) { return a.misfit < b.misfit; });
    std::vector<IcpFit> apart;
    for (const IcpFit& fit : found) {
        const auto same = [&](const IcpFit& other) {
            return distance_between(fit.T_reference_scan, other.T_reference_scan, about) < kSame * about.radius;
        };
        if (std::none_of(apart.begin(), apart.end(), same)) apart.push_back(fit);
    }
    return apart;
}

// Where the last steps may begin, the best first.
std::vector<IcpFit> starts_for(const Eigen::Matrix3Xd& scan, const TwistFrame& about, const AlignReference& reference,
                               const AlignOptions& options)
{
    std::vector<IcpFit> starts;
    if (options.start) {
        starts.emplace_back().T_reference_scan = *options.start;
        return starts;
    }
    for (const Pose& pose : search_poses(scan, about, reference.points(), options.icp.held))
        starts.emplace_back().T_reference_scan = pose.T_reference_scan;
    IcpOptions few = options.icp;
    few.iterations = std::min(few.iterations, kJudgedSteps);
    starts = fits(starts, scan(Eigen::all, farthest_points(scan, kJudged)), about, reference, few);
    starts.resize(std::min(starts.size(), kFinalists));
    return fits(starts, scan(Eigen::all, every_nth(scan.cols(), kCompared)), about, reference, options.icp);
}

// Covariance of the step, as if the points' distances were independent: sigma² (Σ w g gᵀ)⁻¹.
std::array<Freedom, 6> freedoms(const IcpFit& fit, const HeldAxes& held)
{
    TwistMatrix A = fit.information;
    for (Eigen::Index k = 0; k < 6; ++k)
        if (held[static_cast<std::size_t>(k)]) {
            A.row(k).setZero();
            A.col(k).setZero();
            A(k, k) = -1; // a mode by itself, apart from those that nothing determines
        }
    const SymmetricEigen<6> modes = symmetric_eigen(A);
    std::array<Freedom, 6> found;
    for (Eigen::Index k = 0; k < 6; ++k) {
        Freedom& freedom = found[static_cast<std::size_t>(5 - k)];
        freedom.motion = modes.vectors.col(k);
        Eigen::Index largest = 0; // one of two signs, whatever the rounding
        freedom.motion.cwiseAbs().maxCoeff(&largest);
        if (freedom.motion[largest] < 0) freedom.motion *= -1;
        const double value = modes.values[k];
        freedom.determined = value > fit.least_information;
        freedom.sd = freedom.determined ? fit.sigma / std::sqrt(value) : std::numeric_limits<double>::infinity();
        freedom.held = value < -0.5;
    }
    return found;
}

} // namespace

Alignment align(const OrientedPoints& scan, const AlignReference& reference, const AlignOptions& options)
{
    if (scan.xyz.cols() < 6) // one a degree of freedom
        throw InputError("needs at least 6 points, got " + std::to_string(scan.xyz.cols()));
    const TwistFrame about = twist_frame(scan.xyz);
    if (!(about.radius > 0)) throw InputError("all points lie in one place");
    const Eigen::Matrix3Xd fitted = scan.xyz(Eigen::all, every_nth(scan.xyz.cols(), kFitted));
    const std::vector<IcpFit> starts = starts_for(fitted, about, reference, options);
    Alignment alignment;
    alignment.fit = icp(starts.front().T_reference_scan, fitted, about, reference, options.icp);
    alignment.frame = {alignment.fit.T_reference_scan * about.centre, about.radius};
    alignment.freedoms = freedoms(alignment.fit, options.icp.held);
    if (starts.size() > 1) alignment.next = starts[1];
    return alignment;
}

} // namespace fettle
