#include "align/align.h"

#include "align/pose_search.h"
#include "core/decompositions.h"
#include "core/error.h"

#include <Eigen/Dense>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <optional>

namespace fettle::align {

namespace {

// Number of scan points by which ICP ranks all poses found by the search, compares the best of them, and refines the
// final one: more points would lower the figures of the fit no further than the scan's own errors.
constexpr Eigen::Index kRankingPoints = 400, kComparisonPoints = 2000, kFinalPoints = 20000;
// A few iterations show which poses deserve many: at poses where the scan fits, the search has nearly converged.
// One that has not converged after the last number is not the best, which the final refinement continues.
constexpr int kScreeningIterations = 4, kRankingIterations = 30, kComparisonIterations = 60;
// Points of the reference for this: where the scan fits is seen with fewer than a fine scan of a whole scene has.
constexpr Eigen::Index kRankingReferencePoints = 50000;
constexpr std::size_t kMaxScreened = 16;
constexpr std::size_t kMaxFinalists = 3;
// Two poses closer than this, in scan radii, are duplicates.
constexpr double kDuplicateFitRadii = 0.1;

// Runs ICP from each start. Returns the `max_count` best distinct poses, best first.
std::vector<IcpFit> refine_all(const std::vector<IcpFit>& starts, const Eigen::Matrix3Xd& points,
                               const TwistFrame& frame, const AlignReference& reference, const IcpOptions& options,
                               std::size_t max_count)
{
    std::vector<IcpFit> fits(starts.size());
    tbb::parallel_for(std::size_t{0}, fits.size(), [&](std::size_t i) {
        fits[i] = icp(starts[i].T_reference_scan, points, frame, reference, options);
    });
    return distinct_poses(std::move(fits), &IcpFit::misfit, frame, kDuplicateFitRadii, max_count);
}

// Poses from which the final refinement may start, best first.
std::vector<IcpFit> find_starts(const OrientedPoints& points, const TwistFrame& frame, const AlignReference& reference,
                                const AlignOptions& options)
{
    std::vector<IcpFit> starts;
    if (options.start) {
        starts.emplace_back().T_reference_scan = *options.start;
        return starts;
    }
    const Eigen::Matrix3Xd& scan = points.xyz;
    for (const PoseCandidate& pose : search_poses(points, frame, reference.points(), options.icp))
        starts.emplace_back().T_reference_scan = pose.T_reference_scan;
    const Eigen::Matrix3Xd few = scan(Eigen::all, farthest_point_sample(scan, kRankingPoints));
    const auto at_most = [&](int iterations) {
        IcpOptions limited = options.icp;
        limited.max_iterations = std::min(options.icp.max_iterations, iterations);
        return limited;
    };
    const std::optional<AlignReference> thinned = reference.thinned(kRankingReferencePoints);
    const AlignReference& ranking = thinned ? *thinned : reference;
    starts = refine_all(starts, few, frame, ranking, at_most(kScreeningIterations), kMaxScreened);
    starts = refine_all(starts, few, frame, ranking, at_most(kRankingIterations), kMaxFinalists);
    return refine_all(starts, scan(Eigen::all, scattered_indices(scan.cols(), kComparisonPoints)), frame, reference,
                      at_most(kComparisonIterations), kMaxFinalists);
}

// Modes of the covariance sigma² (Σ w g gᵀ)⁻¹ of the pose, as if the distances of the points were independent.
std::array<MotionMode, 6> analyse_modes(const IcpFit& fit, const HeldAxes& held)
{
    TwistMatrix A = without_held_axes(fit.information, held);
    for (int k = 0; k < 6; ++k)
        if (held[k]) A(k, k) = -1; // separates held axes from undetermined ones, whose eigenvalue is 0
    const auto [values, vectors] = core::symmetric_eigen(A);
    std::array<MotionMode, 6> modes;
    for (int k = 0; k < 6; ++k) {
        MotionMode& mode = modes[5 - k];
        mode.motion = vectors.col(k);
        Eigen::Index largest = 0; // fixes the sign of the eigenvector, whatever the rounding
        mode.motion.cwiseAbs().maxCoeff(&largest);
        if (mode.motion[largest] < 0) mode.motion *= -1;
        mode.determined = values[k] > fit.min_information;
        mode.sd = mode.determined ? fit.sigma / std::sqrt(values[k]) : std::numeric_limits<double>::infinity();
        mode.held = values[k] < -0.5;
    }
    return modes;
}

} // namespace

Alignment align(const OrientedPoints& scan, const AlignReference& reference, const AlignOptions& options)
{
    const Eigen::Index count = scan.xyz.cols();
    if (count < 6) // one for each degree of freedom
        throw core::InputError("needs at least 6 points, got " + std::to_string(count));
    const TwistFrame frame = twist_frame(scan.xyz);
    if (!(frame.radius > 0)) throw core::InputError("all points coincide");
    const std::vector<Eigen::Index> chosen = scattered_indices(count, kFinalPoints);
    const OrientedPoints points{scan.xyz(Eigen::all, chosen), scan.normals(Eigen::all, chosen), scan.outward};
    const std::vector<IcpFit> starts = find_starts(points, frame, reference, options);
    Alignment alignment;
    alignment.fit = icp(starts.front().T_reference_scan, points.xyz, frame, reference, options.icp);
    alignment.frame = {alignment.fit.T_reference_scan * frame.centre, frame.radius};
    alignment.modes = analyse_modes(alignment.fit, options.icp.held);
    if (starts.size() > 1) alignment.second_best = starts[1];
    return alignment;
}

} // namespace fettle::align
