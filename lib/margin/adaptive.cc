#include "margin/adaptive.h"

#include "core/constants.h"
#include "core/error.h"
#include "fit/fit.h"
#include "geometry/bounding_box.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/field_draws.h"
#include "margin/shift.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fettle::margin {

namespace {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Enough touches to distinguish a sphere from a plane; later ones are chosen by the fit.
constexpr int kInitialTouches = 8;
// Further touches during which the band must stay as small as required. A wrong surface may fit few touches; each of
// these tests it at the most informative place.
constexpr int kConfirmations = 4;
// Candidates along the longer side of S; a finer grid changes a touch's gain by less than its error.
constexpr int kCandidatesPerSide = 30;
// Grid cells along the longer side of B: the surface bends between touches that are several cells apart.
constexpr int kAnomalyCells = 12;
constexpr int kDraws = 256;             // give the expected band within about 2 %; the same draws serve all candidates
constexpr int kMaxBandEvaluations = 40; // candidates with the largest variance reduction whose band is computed

/// Candidate places in S \ B, M, mm.
std::vector<Vector2d> candidate_places(const job::Job& job, const job::Boundaries& boundaries)
{
    if (boundaries.sampling.cols() == 0)
        throw core::InputError(job.source, "touching adaptively needs a sampling boundary");
    const Eigen::AlignedBox2d box = geometry::bounding_box(boundaries.sampling);
    const Vector2d side = box.sizes();
    const Eigen::Vector2i count = (side / side.maxCoeff() * kCandidatesPerSide).array().ceil().cast<int>().max(2);
    const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(job.theta).transpose();
    std::vector<Vector2d> places;
    for (int j = 0; j <= count.y(); ++j)
        for (int i = 0; i <= count.x(); ++i) {
            const Vector2d p = box.min() + Vector2d(i * side.x() / count.x(), j * side.y() / count.y());
            if (job::contains(boundaries.sampling, p) && !job::contains(boundaries.anomaly, p))
                places.push_back(R_machine_working * p);
        }
    if (static_cast<int>(places.size()) < kInitialTouches)
        throw core::InputError(job.source, "no room to touch beside the anomaly");
    return places;
}

Matrix2Xd as_columns(const std::vector<Vector2d>& points)
{
    Matrix2Xd columns(2, points.size());
    for (Index i = 0; i < columns.cols(); ++i) columns.col(i) = points[i];
    return columns;
}

/// The candidate farthest from all touches, or from the candidates' mean if there are none.
Index farthest(const std::vector<Vector2d>& places, const Matrix2Xd& touched)
{
    const Matrix2Xd all = as_columns(places);
    VectorXd distance = VectorXd::Constant(all.cols(), std::numeric_limits<double>::infinity());
    if (touched.cols() == 0) distance = (all.colwise() - all.rowwise().mean().eval()).colwise().norm();
    for (const auto& t : touched.colwise())
        distance = distance.cwiseMin((all.colwise() - t).colwise().norm().transpose());
    Index best = 0;
    distance.maxCoeff(&best);
    return best;
}

/// The candidate whose touch lowers the expected band most.
Index most_informative(const surface::Surface& surface, const Matrix2Xd& grid, const std::vector<Vector2d>& places)
{
    const Matrix2Xd all = as_columns(places);
    Matrix2Xd both(2, grid.cols() + all.cols());
    both << grid, all;
    const MatrixXd draws = draw_fields(surface, both, kDraws, 1); // one row for each place
    const MatrixXd over_grid = draws.topRows(grid.cols()), over_places = draws.bottomRows(all.cols());
    const MatrixXd covariance = over_grid * over_places.transpose() / kDraws;
    const VectorXd variance = over_places.rowwise().squaredNorm() / kDraws;
    const double noise = surface.touch_sigma * surface.touch_sigma;
    const VectorXd gain =
        covariance.colwise().squaredNorm().transpose().cwiseQuotient((variance.array() + noise).matrix());
    std::vector<Index> order(places.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return gain[a] > gain[b]; });
    order.resize(std::min<std::size_t>(order.size(), kMaxBandEvaluations));

    VectorXd band(order.size());
    tbb::parallel_for(Index{0}, band.size(), [&](Index k) {
        const Index c = order[k];
        // Kriging with the new touch leaves these residuals of the draws. Its noise would add to all of them alike.
        const VectorXd weight = covariance.col(c) / (variance[c] + noise);
        double sum = 0;
        for (Index d = 0; d < kDraws; ++d) sum += error_band(over_grid.col(d) - over_places(c, d) * weight);
        band[k] = sum;
    });
    Index best = 0;
    band.minCoeff(&best);
    return order[best];
}

void append(sampling::TouchPlan& plan, const Vector2d& xy, const job::Job& job, const job::Boundaries& boundaries)
{
    const Vector2d working = job::rotation_working_machine(job.theta) * xy;
    const bool nearer_to_anomaly =
        job::distance_to_edge(boundaries.anomaly, working) <= job::distance_to_edge(boundaries.sampling, working);
    const Index n = plan.size();
    plan.xy.conservativeResize(2, n + 1);
    plan.xy.col(n) = xy;
    plan.z.conservativeResize(n + 1);
    plan.z[n] = core::kNaN;
    plan.curve.conservativeResize(n + 1);
    plan.curve[n] = sampling::kNoLine;
    plan.role.conservativeResize(n + 1);
    plan.role[n] =
        static_cast<int>(nearer_to_anomaly ? sampling::Role::near_anomaly : sampling::Role::near_sampling_boundary);
}

surface::Surface fit_touches(const job::Job& job, const sampling::TouchPlan& plan, const Eigen::Matrix3Xd& touches)
{
    fit::FitInput input;
    input.job = job;
    input.xyz = touches;
    input.roles = plan.role;
    return fit::fit_surface(input, "auto").surface;
}

} // namespace

AdaptiveTouches touch_adaptively(const job::Job& job, const AdaptiveLimits& limits, const ProbeFunction& probe)
{
    const job::Boundaries polygons = job::working_boundaries(job);
    std::vector<Vector2d> places = candidate_places(job, polygons);
    const Matrix2Xd all = as_columns(places);
    constexpr double kDefaultSpacings = 50; // along the longer side
    const double distance = limits.min_distance > 0 ? limits.min_distance
                                                    : geometry::bounding_box(all).sizes().maxCoeff() / kDefaultSpacings;
    const Matrix2Xd grid = anomaly_grid(job, kAnomalyCells);
    AdaptiveTouches result;
    result.plan.xy.resize(2, 0);
    std::vector<double> bands;
    surface::Surface surface;
    int confirmed = 0;
    while (!places.empty() && result.plan.size() < limits.max_touches && !result.band_reached) {
        const Index n = result.plan.size();
        const Index chosen =
            n < kInitialTouches ? farthest(places, result.plan.xy) : most_informative(surface, grid, places);
        const Vector2d place = places[chosen];
        sampling::TouchPlan longer = result.plan;
        append(longer, place, job, polygons);
        Eigen::Matrix3Xd touches = probe(longer);
        const bool found = !std::isnan(touches(2, n));
        if (!found) result.unreachable.push_back(place);
        const double exclusion_radius = found ? distance : 0;
        std::erase_if(places, [&](const Vector2d& p) { return (p - place).norm() <= exclusion_radius; });
        if (!found) continue;
        result.plan = std::move(longer);
        result.touches = std::move(touches);
        bands.push_back(core::kNaN);
        if (result.plan.size() < kInitialTouches) continue;
        surface = fit_touches(job, result.plan, result.touches);
        bands.back() = predict_by_posterior(surface, job, limits.confidence, 1).band;
        confirmed = bands.back() <= limits.max_band ? confirmed + 1 : 0;
        result.band_reached = confirmed > kConfirmations;
    }
    if (result.plan.size() < std::min(kInitialTouches, limits.max_touches))
        throw core::InputError(job.source, "only " + std::to_string(result.plan.size()) + " places could be touched");
    result.band = Eigen::Map<VectorXd>(bands.data(), bands.size());
    return result;
}

} // namespace fettle::margin
