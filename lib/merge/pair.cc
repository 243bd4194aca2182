#include "merge/pair.h"

#include "align/oriented_points.h"
#include "align/point_pairs.h"
#include "align/pose_search.h"
#include "core/decompositions.h"
#include "geometry/quantiles.h"

#include <Eigen/Dense>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace fettle::merge {
namespace {

// Normals of two means of one place differ by their noise and by the curvature between them: up to 40° or so.
constexpr double kMinNormalCosine = 0.75;
// Means of a that the poses of the search are ranked by, and so many means are given to the vote.
constexpr Eigen::Index kRankingMeans = 250, kVotingMeans = 5000;
constexpr int kRankingIterations = 12, kFinalIterations = 8;
// The vote is good to some 6°, and a tenth of the radius is what that moves the points by.
constexpr double kVoteReachRadii = 0.1;
constexpr std::size_t kMaxRefined = 6, kMaxHypotheses = 3;
constexpr double kDuplicateRadii = 0.05; // two poses nearer than this, in scan radii, are one

std::vector<Eigen::Index> every_nth(Eigen::Index size, Eigen::Index n)
{
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index i = 0; i < size; i += n) chosen.push_back(i);
    return chosen;
}

align::OrientedPoints voters(const Scan& scan)
{
    const auto chosen = align::scattered_indices(scan.means.xyz.cols(), kVotingMeans);
    return {scan.means.xyz(Eigen::all, chosen), scan.means.normals(Eigen::all, chosen), scan.means.outward};
}

/// The side on which most normals of near means agree; +1 if both are known.
double side_of(const Scan& a, const Scan& b, const Eigen::Isometry3d& T_b_a, const std::vector<Eigen::Index>& chosen)
{
    if (a.means.outward && b.means.outward) return 1;
    double sum = 0;
    for (const Eigen::Index i : chosen) {
        const Eigen::Vector3d p = T_b_a * a.means.xyz.col(i);
        const Eigen::Index j = b.index.nearest(p, 1).front();
        const double cosine = (T_b_a.linear() * a.means.normals.col(i)).dot(b.means.normals.col(j));
        sum += cosine / (1 + (b.means.xyz.col(j) - p).squaredNorm() / std::pow(kVoteReachRadii * a.frame.radius, 2));
    }
    return sum < 0 ? -1 : 1;
}

/// What lies on one scan of another, one way.
struct OneWay {
    double on = 0, near = 0, parallel = 0, all = 0, squares = 0, limits = 0;
};

OneWay look(const Scan& a, const Scan& b, const PairPose& pose, double length, Eigen::Index every,
            align::TwistMatrix& information)
{
    // Near is what lies over the other's surface and not far from it, though perhaps not on it.
    constexpr double kNearLengths = 6, kMaxNearSideways = 1;
    // Offsets of two scans of one surface: their noise, and what the grid does on edges and curved faces.
    constexpr double kMaxOffsetSigmas = 4, kMaxOffsetLengths = 0.1;
    // What runs beside the other surface at this distance is not there by an error of the pose.
    constexpr double kMinParallelLengths = 0.5;
    OneWay way;
    const Eigen::Isometry3d& T = pose.T_b_a;
    for (Eigen::Index i = 0; i < a.means.xyz.cols(); i += every) {
        ++way.all;
        const Eigen::Vector3d p = T * a.means.xyz.col(i);
        const std::optional<Eigen::Index> nearest = b.index.nearest_within(p, kNearLengths * length);
        if (!nearest) continue;
        const Eigen::Index j = *nearest;
        const Eigen::Vector3d between = p - b.means.xyz.col(j), nb = b.means.normals.col(j);
        if (nb.isZero(0)) continue;
        const Eigen::Vector3d na = pose.side * (T.linear() * a.means.normals.col(i));
        const double cosine = na.dot(nb);
        const Eigen::Vector3d sum = na + nb;
        const Eigen::Vector3d n = cosine > 0 ? Eigen::Vector3d(sum.normalized()) : nb;
        const double offset = between.dot(n);
        if ((between - offset * n).norm() > kMaxNearSideways * length) continue;
        ++way.near;
        const double limit = std::max(kMaxOffsetSigmas * std::hypot(a.sd(i), b.sd(j)), kMaxOffsetLengths * length);
        if (cosine < kMinNormalCosine) continue;
        if (std::abs(offset) > kMinParallelLengths * length) ++way.parallel;
        if (std::abs(offset) > limit) continue;
        ++way.on;
        way.limits += limit * limit;
        way.squares += offset * offset;
        const align::Twist g = align::TwistFrame{T * a.frame.centre, a.frame.radius}.gradient(p, n);
        information.noalias() += g * g.transpose();
    }
    return way;
}

} // namespace

std::vector<Correspondence> correspondences(const Scan& a, const Scan& b, const PairPose& pose, double reach,
                                            const std::vector<Eigen::Index>& chosen)
{
    std::vector<Correspondence> found;
    const Eigen::Isometry3d& T = pose.T_b_a;
    for (const Eigen::Index i : chosen) {
        const Eigen::Vector3d p = T * a.means.xyz.col(i);
        const std::optional<Eigen::Index> nearest = b.index.nearest_within(p, reach);
        if (!nearest) continue;
        const Eigen::Index j = *nearest;
        const Eigen::Vector3d between = p - b.means.xyz.col(j);
        const Eigen::Vector3d na = pose.side * (T.linear() * a.means.normals.col(i)), nb = b.means.normals.col(j);
        if (na.dot(nb) < kMinNormalCosine) continue;
        const Eigen::Vector3d n = (na + nb).normalized();
        const double offset = between.dot(n);
        found.push_back({i, j, p, n, offset, (between - offset * n).norm()});
    }
    return found;
}

PairPose refine_pair(const Scan& a, const Scan& b, PairPose pose, double reach, double length, int iterations,
                     const std::vector<Eigen::Index>& chosen)
{
    constexpr double kMinEigenvalueToTrace = 1e-6; // of a motion that no correspondence determines
    for (int k = 0; k < iterations; ++k) {
        const double share = iterations > 1 ? static_cast<double>(k) / (iterations - 1) : 1;
        const double limit = std::pow(reach, 1 - share) * std::pow(std::min(reach, 2 * length), share);
        const auto matches = correspondences(a, b, pose, limit, chosen);
        if (matches.size() < 6) break; // one for each degree of freedom
        Eigen::VectorXd offsets(matches.size());
        for (std::size_t m = 0; m < matches.size(); ++m) offsets[m] = matches[m].offset;
        const double sigma = std::max(geometry::kMedianToSigma * geometry::median_absolute(offsets), 1e-3 * length);
        const align::TwistFrame frame{pose.T_b_a * a.frame.centre, a.frame.radius};
        align::TwistMatrix A = align::TwistMatrix::Zero();
        align::Twist rhs = align::Twist::Zero();
        for (const Correspondence& m : matches) {
            const double relative = m.offset / (geometry::kTukeyCutoff * sigma);
            if (std::abs(relative) >= 1) continue;
            const double weight = std::pow(1 - relative * relative, 2);
            const align::Twist g = frame.gradient(m.place, m.normal);
            A.noalias() += weight * g * g.transpose();
            rhs += weight * m.offset * g;
        }
        const align::Twist x = align::solve_step(A, rhs, {}, kMinEigenvalueToTrace * A.trace());
        pose.T_b_a = align::orthonormalized(frame.motion(x) * pose.T_b_a);
    }
    return pose;
}

Agreement agreement(const Scan& a, const Scan& b, const PairPose& pose, double length, Eigen::Index every)
{
    align::TwistMatrix information = align::TwistMatrix::Zero(), other = information;
    const OneWay there = look(a, b, pose, length, every, information);
    const OneWay back = look(b, a, {pose.T_b_a.inverse(), pose.side}, length, every, other);
    Agreement result;
    result.overlap_a = there.on / there.all;
    result.overlap_b = back.on / back.all;
    result.agreeing = std::min(there.on / std::max(there.near, 1.0), back.on / std::max(back.near, 1.0));
    result.parallel = std::max(there.parallel / there.all, back.parallel / back.all);
    // Offsets that are evenly distributed up to the limit have a mean square of a third of its square.
    const double by_chance = (there.limits + back.limits) / 3;
    if (by_chance > 0) result.tightness = std::max(0.0, 1 - std::sqrt((there.squares + back.squares) / by_chance));
    result.rms = std::sqrt((there.squares + back.squares) / std::max(there.on + back.on, 1.0));
    result.information = core::symmetric_eigen<6>(information).values[0] / std::max(there.on, 1.0);
    return result;
}

bool is_credible(const Agreement& agreement)
{
    constexpr double kMinOverlap = 0.1, kMinAgreeing = 0.75, kMinTightness = 0.45, kMinInformation = 2e-4;
    return std::min(agreement.overlap_a, agreement.overlap_b) >= kMinOverlap && agreement.agreeing >= kMinAgreeing &&
           agreement.tightness >= kMinTightness && agreement.information >= kMinInformation;
}

bool is_contradiction(const Agreement& agreement)
{
    constexpr double kMinShare = 0.05, kMinToOverlap = 0.5;
    return agreement.parallel > kMinShare &&
           agreement.parallel > kMinToOverlap * std::min(agreement.overlap_a, agreement.overlap_b);
}

double score_of(const Agreement& agreement)
{
    return std::sqrt(agreement.overlap_a * agreement.overlap_b) * agreement.agreeing * agreement.tightness;
}

Hypothesis judge_pair(const Scan& a, const Scan& b, const PairPose& start, double length)
{
    const auto chosen = every_nth(a.means.xyz.cols(), std::max<Eigen::Index>(1, a.means.xyz.cols() / 2000));
    Hypothesis result;
    result.pose = refine_pair(a, b, start, 4 * length, length, kFinalIterations, chosen);
    result.agreement = agreement(a, b, result.pose, length, std::max<Eigen::Index>(1, a.means.xyz.cols() / 4000));
    result.score = score_of(result.agreement);
    return result;
}

std::vector<Hypothesis> search_pair(const Scan& a, const Scan& b, double length)
{
    const std::vector<Eigen::Isometry3d> voted = align::match_point_pairs(voters(a), voters(b));
    const Eigen::Index size = a.means.xyz.cols();
    const auto few = every_nth(size, std::max<Eigen::Index>(1, size / kRankingMeans));
    std::vector<Hypothesis> ranked(voted.size());
    tbb::parallel_for(std::size_t{0}, voted.size(), [&](std::size_t k) {
        Hypothesis& h = ranked[k];
        h.pose = {voted[k], side_of(a, b, voted[k], few)};
        h.pose = refine_pair(a, b, h.pose, kVoteReachRadii * a.frame.radius, length, kRankingIterations, few);
        h.agreement = agreement(a, b, h.pose, length, std::max<Eigen::Index>(1, size / 1000));
        h.score = -score_of(h.agreement);
    });
    const auto distinct = [&](std::vector<Hypothesis> list, std::size_t count) {
        std::ranges::stable_sort(list, {}, &Hypothesis::score);
        std::vector<Hypothesis> kept;
        for (const Hypothesis& h : list) {
            const auto is_near = [&](const Hypothesis& other) {
                return align::pose_distance(h.pose.T_b_a, other.pose.T_b_a, a.frame) < kDuplicateRadii * a.frame.radius;
            };
            if (kept.size() < count && std::ranges::none_of(kept, is_near)) kept.push_back(h);
        }
        return kept;
    };
    std::vector<Hypothesis> best = distinct(std::move(ranked), kMaxRefined);
    tbb::parallel_for(std::size_t{0}, best.size(), [&](std::size_t k) {
        best[k] = judge_pair(a, b, best[k].pose, length);
        best[k].score *= -1;
    });
    best = distinct(std::move(best), kMaxHypotheses);
    for (Hypothesis& h : best) h.score *= -1;
    return best;
}

} // namespace fettle::merge
