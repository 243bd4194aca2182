#include "margin/adaptive.h"

#include "core/constants.h"
#include "core/error.h"
#include "fit/fit.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/field_draws.h"
#include "margin/shift.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Enough to tell a sphere from a plane; the fit is asked from then on.
constexpr int kFirst = 8;
// Touches that must leave the band as small as wanted. Few touches are soon explained by the wrong surface; each of
// these tests it where it would tell most.
constexpr int kConfirmations = 4;
// Places to choose from across the longer side of S; finer ones change a touch's worth by less than its error.
constexpr int kAcross = 30;
// Over B: the surface bends between touches that are several of its cells apart.
constexpr int kAcrossAnomaly = 12;
constexpr int kDraws = 256;   // of the expected band: known to about 2 %, the same draws for all places
constexpr int kCompared = 40; // places that lower the variance most, of which the best is looked for

/// Places in S \ B, M.
std::vector<Vector2d> places_for(const Job& job, const Boundaries& boundaries)
{
    if (boundaries.sampling.cols() == 0) throw InputError(job.source, "touching adaptively needs a sampling boundary");
    const Vector2d least = boundaries.sampling.rowwise().minCoeff();
    const Vector2d side = boundaries.sampling.rowwise().maxCoeff() - least;
    const Eigen::Vector2i count = (side / side.maxCoeff() * kAcross).array().ceil().cast<int>().max(2);
    const Eigen::Matrix2d R_machine_working = rotation_working_machine(job.theta).transpose();
    std::vector<Vector2d> places;
    for (int j = 0; j <= count.y(); ++j)
        for (int i = 0; i <= count.x(); ++i) {
            const Vector2d p = least + Vector2d(i * side.x() / count.x(), j * side.y() / count.y());
            if (contains(boundaries.sampling, p) && !contains(boundaries.anomaly, p))
                places.push_back(R_machine_working * p);
        }
    if (static_cast<int>(places.size()) < kFirst) throw InputError(job.source, "no room to touch beside the anomaly");
    return places;
}

Matrix2Xd as_columns(const std::vector<Vector2d>& points)
{
    Matrix2Xd columns(2, static_cast<Index>(points.size()));
    for (Index i = 0; i < columns.cols(); ++i) columns.col(i) = points[static_cast<std::size_t>(i)];
    return columns;
}

/// The place farthest from all touches; the first one farthest from the middle.
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

/// The place whose touch lowers the expected band most.
Index most_telling(const Surface& surface, const Matrix2Xd& grid, const std::vector<Vector2d>& places)
{
    const Matrix2Xd all = as_columns(places);
    Matrix2Xd both(2, grid.cols() + all.cols());
    both << grid, all;
    const MatrixXd draws = draw_fields(surface, both, kDraws, 1); // rows: places
    const MatrixXd over_grid = draws.topRows(grid.cols()), over_places = draws.bottomRows(all.cols());
    const MatrixXd covariance = over_grid * over_places.transpose() / kDraws;
    const VectorXd variance = over_places.rowwise().squaredNorm() / kDraws;
    const double noise = surface.touch_sigma * surface.touch_sigma;
    const VectorXd gain =
        covariance.colwise().squaredNorm().transpose().cwiseQuotient((variance.array() + noise).matrix());
    std::vector<Index> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return gain[a] > gain[b]; });
    order.resize(std::min<std::size_t>(order.size(), kCompared));

    VectorXd band(static_cast<Index>(order.size()));
    tbb::parallel_for(Index{0}, band.size(), [&](Index k) {
        const Index c = order[static_cast<std::size_t>(k)];
        // What remains of each draw once the touch has said its value: the noise adds the same to all places' variance.
        const VectorXd weight = covariance.col(c) / (variance[c] + noise);
        double sum = 0;
        for (Index d = 0; d < kDraws; ++d) sum += error_band(over_grid.col(d) - over_places(c, d) * weight);
        band[k] = sum;
    });
    Index best = 0;
    band.minCoeff(&best);
    return order[static_cast<std::size_t>(best)];
}

void append(TouchPlan& plan, const Vector2d& xy, const Job& job, const Boundaries& boundaries)
{
    const Vector2d working = rotation_working_machine(job.theta) * xy;
    const bool near = distance_to_edge(boundaries.anomaly, working) <= distance_to_edge(boundaries.sampling, working);
    const Index n = plan.size();
    plan.xy.conservativeResize(2, n + 1);
    plan.xy.col(n) = xy;
    plan.z.conservativeResize(n + 1);
    plan.z[n] = kNaN;
    plan.curve.conservativeResize(n + 1);
    plan.curve[n] = kNoLine;
    plan.role.conservativeResize(n + 1);
    plan.role[n] = static_cast<int>(near ? Role::near_anomaly : Role::near_sampling_boundary);
}

Surface fit_touches(const Job& job, const TouchPlan& plan, const Eigen::Matrix3Xd& touches)
{
    FitInput input;
    input.job = job;
    input.xyz = touches;
    input.roles = plan.role;
    return fit_surface(input, "auto").surface;
}

} // namespace

AdaptiveTouches touch_adaptively(const Job& job, const AdaptiveLimits& limits, const ProbePlan& probe)
{
    const Boundaries polygons = boundaries(job);
    std::vector<Vector2d> places = places_for(job, polygons);
    const Matrix2Xd all = as_columns(places);
    constexpr double kShare = 50;
    const double distance = limits.distance > 0
                                ? limits.distance
                                : (all.rowwise().maxCoeff() - all.rowwise().minCoeff()).maxCoeff() / kShare;
    const Matrix2Xd grid = anomaly_grid(job, kAcrossAnomaly);
    AdaptiveTouches result;
    result.plan.xy.resize(2, 0);
    std::vector<double> bands;
    Surface surface;
    int confirmed = 0;
    while (!places.empty() && result.plan.size() < limits.most_touches && !result.enough) {
        const Index n = result.plan.size();
        const Index chosen = n < kFirst ? farthest(places, result.plan.xy) : most_telling(surface, grid, places);
        const Vector2d place = places[static_cast<std::size_t>(chosen)];
        TouchPlan longer = result.plan;
        append(longer, place, job, polygons);
        Eigen::Matrix3Xd touches = probe(longer);
        const bool found = !std::isnan(touches(2, n));
        if (!found) result.unreachable.push_back(place);
        const double keep_off = found ? distance : 0;
        std::erase_if(places, [&](const Vector2d& p) { return (p - place).norm() <= keep_off; });
        if (!found) continue;
        result.plan = std::move(longer);
        result.touches = std::move(touches);
        bands.push_back(kNaN);
        if (result.plan.size() < kFirst) continue;
        surface = fit_touches(job, result.plan, result.touches);
        bands.back() = predict_by_posterior(surface, job, limits.confidence, 1).band;
        confirmed = bands.back() <= limits.band ? confirmed + 1 : 0;
        result.enough = confirmed > kConfirmations;
    }
    if (result.plan.size() < std::min(kFirst, limits.most_touches))
        throw InputError(job.source, "only " + std::to_string(result.plan.size()) + " places could be touched");
    result.band = Eigen::Map<VectorXd>(bands.data(), static_cast<Index>(bands.size()));
    return result;
}

} // namespace fettle
