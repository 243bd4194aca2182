#include "calibrate/gantry_passes.h"

#include "calibrate/gantry_replay.h"
#include "core/cholesky.h"
#include "core/error.h"
#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>

namespace fettle::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using strategy::TraceRow;

/// Unknowns of a linear least-squares problem with their covariance.
struct LinearFit {
    VectorXd x;
    MatrixXd covariance;
    double sigma = 0; ///< of the residuals
};

LinearFit fit_linear(const MatrixXd& A, const VectorXd& b)
{
    const MatrixXd normal = A.transpose() * A; // a few columns of like size
    LinearFit fit;
    fit.x = core::solve_ldlt(normal, A.transpose() * b);
    const double freedom = std::max<double>(A.rows() - A.cols(), 1);
    fit.sigma = std::sqrt((A * fit.x - b).squaredNorm() / freedom);
    fit.covariance = fit.sigma * fit.sigma * core::solve_ldlt(normal, MatrixXd::Identity(A.cols(), A.cols()));
    return fit;
}

Measured measured(const LinearFit& fit, Index k) { return {fit.x[k], std::sqrt(fit.covariance(k, k))}; }

/// Fits the machine's yielding to the stock after the run, by least squares over the cells that the wheel ground. How
/// much a cell's height depends on it is the difference of two replays.
void fit_compliance(const std::vector<TraceRow>& trace, const job::Job& job, const removal::HeightField& before,
                    const removal::HeightField& after, GantryLaw& law)
{
    constexpr double kStep = 0.01; // mm that the difference moves the rim by at the largest force: far below a layer
    constexpr double kOutlierSigmas = 4; // walls and burrs, where a cell's height says nothing of the rim
    double max_force = 0;
    for (const TraceRow& row : trace) max_force = std::max(max_force, is_grinding(row) ? row.force : 0);
    const double step = kStep / max_force;
    const removal::HeightField left = replay(trace, job, before, 0).left,
                               stepped = replay(trace, job, before, step).left;
    std::vector<Index> ground;
    std::vector<double> residuals;
    for (Index k = 0; k < left.z.size(); ++k)
        if (stepped.z(k) < before.z(k) && std::isfinite(after.z(k))) {
            ground.push_back(k);
            residuals.push_back(after.z(k) - left.z(k));
        }
    if (ground.size() < 3) throw core::InputError("the trace ground nothing of the stock after");
    const VectorXd all = VectorXd::Map(residuals.data(), residuals.size());
    const VectorXd offsets = all.array() - geometry::median(residuals);
    const double limit = kOutlierSigmas * geometry::kMedianToSigma * geometry::median_absolute(offsets);
    std::erase_if(ground, [&, k = 0](Index) mutable { return std::abs(offsets[k++]) > limit; });
    MatrixXd A(ground.size(), 2);
    VectorXd b(ground.size());
    for (Index row = 0; row < A.rows(); ++row) {
        const Index k = ground[row];
        A.row(row) << 1, (stepped.z(k) - left.z(k)) / kStep;
        b[row] = after.z(k) - left.z(k);
    }
    const LinearFit fit = fit_linear(A, b);
    // The cells of a line across the wheel were left by one position of it.
    const double alike = std::max(job.wheel.width / before.cell, 1.0);
    law.height_offset = fit.x[0];
    law.compliance = {fit.x[1] / max_force, measured(fit, 1).sigma / max_force * std::sqrt(alike)};
    law.height_error = fit.sigma;
    law.cells = A.rows();
}

/// The intervals between two measurements of the radius.
std::vector<WearInterval> wear_intervals(const std::vector<Stroke>& strokes, const job::Job& job)
{
    std::vector<WearInterval> intervals;
    WearInterval interval;
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        const double radius = strokes[k].radius, last = strokes[k > 0 ? k - 1 : 0].radius;
        if (radius != last) {
            interval.lost = std::numbers::pi * (last * last - radius * radius) * job.wheel.width;
            if (radius < last) intervals.push_back(interval); // otherwise it is a new wheel
            interval = {};
        }
        interval.removed += strokes[k].removed;
    }
    return intervals;
}

/// Least squares over intervals whose impulses have variances as large as they are.
LinearFit fit_impulses(const std::vector<Interval>& intervals, const MatrixXd& volumes)
{
    VectorXd root(intervals.size());
    for (Index k = 0; k < root.size(); ++k) root[k] = std::sqrt(intervals[k].impulse);
    return fit_linear(root.cwiseInverse().asDiagonal() * volumes, root);
}

/// Is the force that removes material normal to the rim, and the measured one its vertical part? Then
/// k ∫F dt = Σ V (cos φ + t sin φ) over the slopes φ of the rim (removal::RimForce): a deep cut on the side that the
/// rim is dragged into removes more than its vertical force tells. Otherwise it is the whole volume.
/// @return  t, the ratio of the tangential to the normal force; none if slopes explain less than they cost
std::optional<Measured> fit_tangential(const std::vector<Interval>& intervals)
{
    const double count = double(intervals.size());
    if (count < 3) return std::nullopt;
    MatrixXd volumes(intervals.size(), 3);
    for (Index k = 0; k < volumes.rows(); ++k)
        volumes.row(k) << intervals[k].volume, intervals[k].cosine_volume, intervals[k].sine_volume;
    const LinearFit plain = fit_impulses(intervals, volumes.leftCols<1>()),
                    along_normal = fit_impulses(intervals, volumes.rightCols<2>());
    // By the Bayesian information criterion, whose one parameter more costs ln n.
    const bool explains = 2 * count * std::log(plain.sigma / along_normal.sigma) > std::log(count);
    const double scale = along_normal.x[0], t = along_normal.x[1] / scale;
    if (!explains || !(t > 0)) return std::nullopt;
    return Measured{t, std::sqrt(along_normal.covariance(1, 1)) / scale};
}

/// What was ground in the intervals of a stroke. The volume is that which the force explains: on slopes, weighted with
/// the vertical force of its normal force.
struct Work {
    double impulse = 0, duration = 0, volume = 0; ///< N s, s, mm³
};

std::vector<Work> work_of_strokes(const Replay& run, const std::optional<Measured>& tangential)
{
    std::vector<Work> works(run.strokes.size());
    for (const Interval& interval : run.intervals) {
        Work& work = works[interval.stroke];
        work.impulse += interval.impulse;
        work.duration += interval.duration;
        work.volume += tangential ? interval.cosine_volume + tangential->value * interval.sine_volume : interval.volume;
    }
    return works;
}

void fit_spring(const std::vector<TraceRow>& trace, GantryLaw& law)
{
    std::vector<const TraceRow*> pressed;
    for (const TraceRow& row : trace)
        if (is_grinding(row) && row.deflection > 0) pressed.push_back(&row);
    if (pressed.size() < 3) return;
    const auto [min, max] = std::ranges::minmax(pressed, {}, &TraceRow::deflection);
    if (!(max->deflection > min->deflection)) return;
    MatrixXd A(pressed.size(), 2);
    VectorXd b(pressed.size());
    for (Index k = 0; k < A.rows(); ++k) {
        A.row(k) << 1, pressed[k]->deflection;
        b[k] = pressed[k]->force;
    }
    const LinearFit fit = fit_linear(A, b);
    law.preload = measured(fit, 0);
    law.stiffness = measured(fit, 1);
}

/// Weighted median of volume over impulse, whose standard deviation is that of a mean of as many, times √(π/2).
void fit_coefficient(std::vector<Work> strokes, GantryLaw& law)
{
    const auto ratio = [](const Work& stroke) { return stroke.volume / stroke.impulse; };
    std::ranges::sort(strokes, {}, ratio);
    double total = 0, half = 0, squares = 0;
    for (const Work& stroke : strokes) {
        total += stroke.impulse;
        squares += stroke.impulse * stroke.impulse;
    }
    std::size_t middle = 0;
    while ((half += strokes[middle].impulse) < total / 2) ++middle;
    const double coefficient = ratio(strokes[middle]);
    VectorXd deviations(strokes.size());
    for (Index k = 0; k < deviations.size(); ++k) deviations[k] = ratio(strokes[k]) - coefficient;
    const double sigma = geometry::kMedianToSigma * geometry::median_absolute(deviations);
    law.coefficient = {coefficient, sigma * std::sqrt(std::numbers::pi / 2 * squares) / total};
}

/// Adds up consecutive strokes to passes of about the same work, so that all are known about as well: the force is read
/// a few times in a short stroke, and many times in a long one.
void add_passes(const std::vector<Work>& strokes, GantryLaw& law)
{
    constexpr double kStrokes = 3; // mean ones in a pass
    double mean_impulse = 0;
    for (const Work& stroke : strokes) mean_impulse += stroke.impulse / strokes.size();
    law.pass_work = kStrokes * mean_impulse;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    Work sum;
    double work = 0;
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        sum.impulse += strokes[k].impulse;
        sum.duration += strokes[k].duration;
        sum.volume += strokes[k].volume;
        const bool is_last_of_few = k + 1 == strokes.size() && law.passes.empty();
        if (sum.impulse < law.pass_work && !is_last_of_few) continue;
        law.passes.push_back({.force = sum.impulse / sum.duration,
                              .speed = kNone,
                              .feed = kNone,
                              .duration = kNone,
                              .prior_work = work,
                              .volume = sum.volume / sum.duration});
        work += sum.impulse;
        sum = {};
    }
}

} // namespace

std::optional<Measured> fit_wear(const std::vector<WearInterval>& intervals)
{
    if (intervals.size() < 2) return std::nullopt;
    VectorXd removed(intervals.size()), lost(intervals.size());
    for (Index k = 0; k < removed.size(); ++k) {
        removed[k] = intervals[k].removed;
        lost[k] = intervals[k].lost;
    }
    const Measured ratio = measured(fit_linear(removed, lost), 0);
    return ratio.value > 0 ? std::optional(ratio) : std::nullopt;
}

GantryLaw measure_gantry(const std::vector<TraceRow>& trace, const job::Job& job, const removal::HeightField& before,
                         const std::optional<removal::HeightField>& after)
{
    GantryLaw law;
    if (after) fit_compliance(trace, job, before, *after, law);
    constexpr double kSignificantSigmas = 3;
    const bool yields = law.compliance && law.compliance->value > kSignificantSigmas * law.compliance->sigma;
    const Replay run = replay(trace, job, before, yields ? law.compliance->value : 0);
    law.wear = wear_intervals(run.strokes, job);
    if (const auto wear = fit_wear(law.wear))
        law.grinding_ratio = {1 / wear->value, wear->sigma / (wear->value * wear->value)};
    // With less force the wheel rides on ridges, and meets them between the readings.
    constexpr double kMinForceShare = 0.5; // of F_min
    const auto presses = [&](const auto& ground) {
        return ground.volume > 0 && ground.impulse > kMinForceShare * job.force.min * ground.duration;
    };
    std::vector<Interval> pressed;
    std::ranges::copy_if(run.intervals, std::back_inserter(pressed), presses);
    law.tangential = fit_tangential(pressed);
    std::vector<Work> strokes = work_of_strokes(run, law.tangential);
    std::erase_if(strokes, std::not_fn(presses));
    if (strokes.empty()) return law;
    add_passes(strokes, law);
    fit_coefficient(strokes, law);
    fit_spring(trace, law);
    return law;
}

} // namespace fettle::calibrate
