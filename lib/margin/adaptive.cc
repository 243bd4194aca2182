#include "margin/adaptive.h"

#include "core/constants.h"
#include "core/error.h"
#include "fit/fit.h"
#include "fit/selection.h"
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
#include <optional>
#include <set>

namespace fettle::margin {

namespace {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Number of touches that distinguishes a sphere from a plane; later ones are chosen by the fit.
constexpr int kInitialTouches = 8;
// Further touches during which the band must stay as small as required. A wrong surface may fit few touches; each of
// these tests it at the most informative place.
constexpr int kConfirmations = 4;
// Minimum number of touches for a rare family: twenty touches of a wavy surface often fit a cubic, thirty seldom.
constexpr int kTouchesPerParameter = 4;
// On a rough surface the band stops falling well above the tolerance, and touches only show more of the roughness.
// Touching continues as long as the mean band of the last touches is below this share of that of as many before.
constexpr double kMaxBandShare = 0.95;
// Candidates along the longer side of S; a finer grid changes a touch's gain by less than its error.
constexpr int kCandidatesPerSide = 30;
// Grid cells along the longer side of B: the surface bends between touches that are several cells apart.
constexpr int kAnomalyCells = 12;
constexpr int kDraws = 256;             // yield the expected band within about 2 %; all candidates share them
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

/// The candidate nearest to a place.
Index nearest(const std::vector<Vector2d>& places, const Vector2d& place)
{
    Index best = 0;
    (as_columns(places).colwise() - place).colwise().norm().minCoeff(&best);
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
        // Residuals of the draws after kriging with the new touch, without its noise, which would shift all of them
        // alike.
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

/// Whether a surface may fit its touches by chance: it is of a rare family, with many parameters for their number.
bool may_be_chance(const surface::Surface& surface, Index touches)
{
    return fit::is_rare(surface.method) && touches < kTouchesPerParameter * surface.covariance.rows();
}

surface::Surface fit_touches(const job::Job& job, const sampling::TouchPlan& plan, const Eigen::Matrix3Xd& touches)
{
    fit::FitInput input;
    input.job = job;
    input.xyz = touches;
    input.roles = plan.role;
    return fit::fit_surface(input, "auto").surface;
}

/// The band by which touching continues or stops. At 95 % the tails of a process change it by half a percent.
double predicted_band(const surface::Surface& surface, const job::Job& job, double confidence)
{
    return predict_by_posterior(surface, job, confidence, 1, "surface", Tails::normal).band;
}

/// The search for touches of one job, with the touches so far and the band that their fit predicts.
class AdaptiveSearch {
  public:
    AdaptiveSearch(const job::Job& job, const AdaptiveLimits& limits, const ProbeFunction& probe)
        : job_(job), limits_(limits), probe_(probe), polygons_(job::working_boundaries(job)),
          places_(candidate_places(job, polygons_)), grid_(anomaly_grid(job, kAnomalyCells))
    {
        constexpr double kDefaultSpacings = 50; // along the longer side
        min_distance_ = limits.min_distance > 0
                            ? limits.min_distance
                            : geometry::bounding_box(as_columns(places_)).sizes().maxCoeff() / kDefaultSpacings;
        result_.plan.xy.resize(2, 0);
    }

    /// Begins with touches that exist already, and the band that their fit predicts.
    void begin(const sampling::TouchPlan& layout, const Eigen::Matrix3Xd& touches, const surface::Surface& surface,
               double band)
    {
        result_.plan = layout;
        result_.touches = touches;
        result_.layout = layout.size();
        bands_.assign(layout.size(), core::kNaN);
        bands_.back() = band;
        surface_ = surface;
        confirmed_ = band <= limits_.max_band ? 1 : 0;
        for (const auto& xy : layout.xy.colwise()) exclude(xy, min_distance_);
    }

    AdaptiveTouches run()
    {
        while (!places_.empty() && result_.plan.size() < limits_.max_touches && !result_.band_reached && !stagnates())
            touch_next();
        if (result_.plan.size() < std::min(kInitialTouches, limits_.max_touches))
            throw core::InputError(job_.source,
                                   "only " + std::to_string(result_.plan.size()) + " places could be touched");
        result_.band = Eigen::Map<VectorXd>(bands_.data(), bands_.size());
        return std::move(result_);
    }

  private:
    bool stagnates() const
    {
        const Index n = limits_.patience, count = static_cast<Index>(bands_.size());
        if (n == 0 || count < 2 * n) return false;
        const Eigen::Map<const VectorXd> bands(bands_.data(), count);
        const double before = bands.segment(count - 2 * n, n).sum(); // NaN while there are too few to compare
        return bands.tail(n).sum() > kMaxBandShare * before;
    }

    void exclude(const Vector2d& place, double radius)
    {
        std::erase_if(places_, [&](const Vector2d& p) { return (p - place).norm() <= radius; });
    }

    /// An outlier of the fit beside which no other touch was made since. It may be an error of the probe, or a feature
    /// of the surface that the fit does not have; a second touch distinguishes them.
    std::optional<Index> unchecked_outlier() const
    {
        for (const Index i : surface_.outliers)
            if (!checked_.contains(i)) return i;
        return std::nullopt;
    }

    /// The place to touch next. A sphere through few touches may end inside of S: then distant touches refute it.
    Index next_place() const
    {
        if (const std::optional<Index> outlier = unchecked_outlier())
            return nearest(places_, result_.plan.xy.col(*outlier));
        const bool is_begun = result_.plan.size() >= kInitialTouches;
        if (is_begun && surface::heights(surface_, as_columns(places_)).allFinite())
            return most_informative(surface_, grid_, places_);
        return farthest(places_, result_.plan.xy);
    }

    void touch_next()
    {
        const Index n = result_.plan.size();
        const Vector2d place = places_[next_place()];
        sampling::TouchPlan longer = result_.plan;
        append(longer, place, job_, polygons_);
        Eigen::Matrix3Xd touches = probe_(longer);
        const bool found = !std::isnan(touches(2, n));
        if (!found) result_.unreachable.push_back(place);
        exclude(place, found ? min_distance_ : 0);
        if (!found) return;
        if (const std::optional<Index> outlier = unchecked_outlier()) checked_.insert(*outlier);
        result_.plan = std::move(longer);
        result_.touches = std::move(touches);
        bands_.push_back(core::kNaN);
        if (result_.plan.size() < kInitialTouches) return;
        surface_ = fit_touches(job_, result_.plan, result_.touches);
        bands_.back() = predicted_band(surface_, job_, limits_.confidence);
        confirmed_ = bands_.back() <= limits_.max_band ? confirmed_ + 1 : 0;
        result_.band_reached =
            confirmed_ > kConfirmations && !may_be_chance(surface_, result_.plan.size()) && !unchecked_outlier();
    }

    const job::Job& job_;
    const AdaptiveLimits& limits_;
    const ProbeFunction& probe_;
    job::Boundaries polygons_;
    std::vector<Vector2d> places_; ///< candidates, M, mm
    Matrix2Xd grid_;               ///< places inside B at which the band is predicted, M, mm
    double min_distance_;          ///< between any two touches, mm
    AdaptiveTouches result_;
    std::vector<double> bands_;
    surface::Surface surface_; ///< fit of the touches so far
    std::set<Index> checked_;  ///< outliers beside which a touch was made
    int confirmed_ = 0;        ///< touches in a row with a band as small as required
};

} // namespace

AdaptiveTouches touch_adaptively(const job::Job& job, const AdaptiveLimits& limits, const ProbeFunction& probe)
{
    return AdaptiveSearch(job, limits, probe).run();
}

AdaptiveTouches extend_layout(const job::Job& job, const sampling::TouchPlan& layout, const Eigen::Matrix3Xd& touches,
                              const AdaptiveLimits& limits, const ProbeFunction& probe)
{
    const surface::Surface surface = fit_touches(job, layout, touches);
    const double band = predicted_band(surface, job, limits.confidence);
    const bool is_enough =
        band <= limits.max_band && !may_be_chance(surface, layout.size()) && surface.outliers.empty();
    if (!is_enough && layout.size() < limits.max_touches && job.sampling.cols() > 0) {
        AdaptiveSearch search(job, limits, probe);
        search.begin(layout, touches, surface, band);
        return search.run();
    }
    AdaptiveTouches result;
    result.plan = layout;
    result.touches = touches;
    result.layout = layout.size();
    result.band = VectorXd::Constant(layout.size(), core::kNaN);
    result.band[layout.size() - 1] = band;
    result.band_reached = band <= limits.max_band;
    return result;
}

} // namespace fettle::margin
