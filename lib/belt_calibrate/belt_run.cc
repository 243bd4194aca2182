#include "belt_calibrate/belt_run.h"

#include "belt/belt_path.h"
#include "belt_calibrate/belt_pass.h"
#include "core/cholesky.h"
#include "core/error.h"
#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::belt_calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// As fettle-belt's own defaults.
constexpr int kContactCells = 32;
constexpr double kContactTolerance = 1e-4;
/// The feed's exponent is fitted if the largest feed is that much more than the smallest.
constexpr double kMinFeedRatio = 1.05;
/// Prior standard deviations of level and exponents (law_belief.cc).
constexpr double kPriorLevel = 5, kPriorPressure = 1, kPriorFeed = 0.3;

/// The law as a function of what is fitted.
struct Parametrization {
    belt::BeltLaw given;
    double belt_speed, pressure, feed; ///< mm/s; reference pressure, MPa, and feed, mm/s
    bool fits_feed;

    VectorXd start() const
    {
        VectorXd x(fits_feed ? 3 : 2);
        const double speed_part = std::pow(belt_speed, given.speed_exponent);
        x[0] = std::log(given.coefficient * speed_part * std::pow(pressure, given.pressure_exponent) *
                        std::pow(feed, given.feed_exponent));
        x[1] = given.pressure_exponent;
        if (fits_feed) x[2] = given.feed_exponent;
        return x;
    }
    belt::BeltLaw law(const VectorXd& x) const
    {
        belt::BeltLaw law = given;
        law.pressure_exponent = x[1];
        if (fits_feed) law.feed_exponent = x[2];
        law.coefficient =
            std::exp(x[0]) / (std::pow(belt_speed, law.speed_exponent) * std::pow(pressure, law.pressure_exponent) *
                              std::pow(feed, law.feed_exponent));
        return law;
    }
};

/// The path of a trace: pressed by the forces that were recorded, and as long at each point as it says.
std::vector<belt::BeltPoint> recorded_path(const cloud::Cloud& trace)
{
    cloud::Cloud path = trace;
    if (cloud::has_field(path, "depth"))
        cloud::set_field(path, "depth", VectorXd::Constant(path.size(), std::numeric_limits<double>::quiet_NaN()));
    const VectorXd time = cloud::field(trace, "t");
    std::vector<belt::BeltPoint> points = belt::belt_path(path, {});
    const VectorXd lengths = belt::tributary_lengths(points);
    for (Index k = 0; k < time.size(); ++k) {
        belt::BeltPoint& point = points[k];
        if (!point.is_on_part()) continue;
        const double duration = time[k] - (k > 0 ? time[k - 1] : 0);
        if (!(duration > 0)) throw core::InputError("point " + std::to_string(k) + ": the time t does not grow");
        point.dwell = lengths[k] > 0 ? 0 : duration;
        if (lengths[k] > 0) point.feed = lengths[k] / duration;
    }
    return points;
}

class BeltFit {
  public:
    BeltFit(const std::vector<belt::BeltPoint>& path, const belt::ContactWheel& wheel, const belt::Surfels& before)
        : path_(path), wheel_(wheel), before_(before)
    {
        options_.contact = {belt::Gridding::kriging, kContactCells, kContactTolerance};
    }

    belt::BeltRun simulate(const belt::BeltLaw& law, bool keeps_removals = false) const
    {
        belt::ContactWheel wheel = wheel_;
        wheel.law = law;
        belt::Surfels surfels = before_;
        belt::BeltOptions options = options_;
        options.keep_removals = keeps_removals;
        return belt::grind(surfels, wheel, path_, options);
    }

  private:
    const std::vector<belt::BeltPoint>& path_;
    const belt::ContactWheel& wheel_;
    const belt::Surfels& before_;
    belt::BeltOptions options_;
};

Parametrization parametrization(const belt::ContactWheel& wheel, const std::vector<belt::BeltPoint>& path,
                                const belt::BeltRun& run)
{
    double log_feed = 0, log_pressure = 0, count = 0;
    double min_feed = std::numeric_limits<double>::infinity(), max_feed = 0;
    for (std::size_t k = 0; k < path.size(); ++k) {
        if (!path[k].is_on_part()) continue;
        min_feed = std::min(min_feed, path[k].feed);
        max_feed = std::max(max_feed, path[k].feed);
        log_feed += std::log(path[k].feed);
        log_pressure += std::log(run.trace[k].force / run.trace[k].area);
        ++count;
    }
    return {wheel.law, wheel.belt_speed, std::exp(log_pressure / count), std::exp(log_feed / count),
            max_feed > kMinFeedRatio * min_feed};
}

/// Tukey's weights of residuals, and their robust standard deviation.
VectorXd weights_of(const VectorXd& residuals, double& sigma)
{
    sigma = std::max(geometry::kMedianToSigma * geometry::median_absolute(residuals), 1e-9); // mm: rounding of files
    const Eigen::ArrayXd u = residuals.array() / (geometry::kTukeyCutoff * sigma);
    return (u.abs() < 1).select((1 - u.square()).square(), 0);
}

/// Trials of the passes from the measured depths, shared as the simulation by the fitted law shares them.
/// @param run, stepped_run  simulated by the fitted law, and with kExponentStep more that is as fast at `pressure`, MPa
/// @param wheel  with the fitted law
void add_passes(const std::vector<belt::BeltPoint>& path, const belt::BeltRun& run, const belt::BeltRun& stepped_run,
                double pressure, const VectorXd& measured, const belt::ContactWheel& wheel,
                const calibrate::TrialBase& base, BeltRunLaw& result)
{
    struct Sums {
        double impulse = 0, length = 0, measured = 0, simulated = 0, log_feed = 0, stepped = 0;
    };
    std::vector<Sums> passes;
    std::vector<std::size_t> pass_of(path.size());
    const VectorXd lengths = belt::tributary_lengths(path);
    for (std::size_t k = 0; k < path.size(); ++k) {
        if (path[k].touches_down || passes.empty()) passes.emplace_back();
        pass_of[k] = passes.size() - 1;
        if (!path[k].is_on_part()) continue;
        const belt::BeltTrace& at = run.trace[k];
        Sums& pass = passes.back();
        pass.impulse += at.force * at.duration;
        pass.length += lengths[k];
    }
    for (const belt::SurfelRemoval& loss : run.removals) {
        const double share = loss.depth / run.removed[loss.surfel];
        if (!(share > 0) || !std::isfinite(measured[loss.surfel])) continue;
        Sums& pass = passes[pass_of[loss.point]];
        pass.measured += share * measured[loss.surfel];
        pass.simulated += loss.depth;
        pass.log_feed += loss.depth * std::log(path[loss.point].feed);
    }
    for (const belt::SurfelRemoval& loss : stepped_run.removals)
        if (std::isfinite(measured[loss.surfel])) passes[pass_of[loss.point]].stepped += loss.depth;
    double work = 0;
    for (const Sums& pass : passes) {
        if (!(pass.length > 0 && pass.measured > 0 && pass.simulated > 0)) continue; // or it only stood
        removal::RemovalTrial trial =
            expected_trial(wheel, base, pressure * std::pow(pass.stepped / pass.simulated, 1 / kExponentStep),
                           std::exp(pass.log_feed / pass.simulated), work);
        trial.volume *= pass.measured / pass.simulated;
        result.passes.push_back(trial);
        work += pass.impulse * wheel.belt_speed;
    }
    result.pass_work = work / std::max<std::size_t>(result.passes.size(), 1);
}

} // namespace

removal::RemovalTrial expected_trial(const belt::ContactWheel& wheel, const calibrate::TrialBase& base, double pressure,
                                     double feed, double prior_work)
{
    constexpr double kUnrecorded = std::numeric_limits<double>::quiet_NaN();
    const double rate = wheel.law.coefficient * std::pow(wheel.belt_speed, wheel.law.speed_exponent);
    const removal::RemovalTrial preston{.force = pressure,
                                        .speed = kUnrecorded,
                                        .feed = feed,
                                        .duration = kUnrecorded,
                                        .prior_work = prior_work,
                                        .volume = rate * pressure / feed};
    return rebased(preston, {wheel.law.pressure_exponent, wheel.law.feed_exponent}, base);
}

BeltRunLaw measure_belt(const cloud::Cloud& trace, const belt::ContactWheel& wheel, const belt::Surfels& before,
                        const belt::Surfels& after, const core::Progress& progress)
{
    if (before.size() != after.size())
        throw core::InputError("the surfels before and after are not the same: " + std::to_string(before.size()) +
                               " and " + std::to_string(after.size()));
    const VectorXd measured = before.displacement - after.displacement;
    const std::vector<belt::BeltPoint> path = recorded_path(trace);
    const BeltFit fit(path, wheel, before);
    belt::BeltRun run = fit.simulate(wheel.law);
    const Parametrization map = parametrization(wheel, path, run);
    // Surfels at the rim of the path's strip lose little, and what they lose hangs on the contact's width.
    constexpr double kMinShare = 0.1; // of the largest simulated depth
    const double min_depth = kMinShare * run.removed.maxCoeff();
    std::vector<Index> used;
    for (Index i = 0; i < measured.size(); ++i)
        if (run.removed[i] > min_depth && std::isfinite(measured[i])) used.push_back(i);

    VectorXd x = map.start();
    const Index unknowns = x.size(), count = used.size();
    if (count <= unknowns) throw core::InputError("the path removes nothing from the surfels before");
    VectorXd center(unknowns), prior(unknowns);
    center << x[0], 1, VectorXd::Zero(unknowns - 2);
    prior << kPriorLevel, kPriorPressure, VectorXd::Constant(unknowns - 2, kPriorFeed);
    BeltRunLaw result;
    constexpr int kMaxRounds = 8;
    constexpr double kStep = 0.05, kMaxChange = 1e-3; // in logarithm and exponents
    MatrixXd normal;
    for (int round = 0; round < kMaxRounds; ++round) {
        core::report_progress(progress, double(round) / kMaxRounds);
        MatrixXd A(count, unknowns);
        const VectorXd b = (measured - run.removed)(used);
        for (Index k = 0; k < unknowns; ++k) {
            VectorXd stepped = x;
            stepped[k] += kStep;
            A.col(k) = (fit.simulate(map.law(stepped)).removed - run.removed)(used) / kStep;
        }
        // The first steps are long, and no surfel is an outlier yet.
        VectorXd weight = weights_of(b, result.depth_error);
        if (round < 2) weight.setOnes();
        const MatrixXd AtW = A.transpose() * weight.asDiagonal() / std::pow(result.depth_error, 2);
        normal = AtW * A;
        normal.diagonal() += prior.cwiseInverse().cwiseAbs2();
        const VectorXd gradient = AtW * b + prior.cwiseInverse().cwiseAbs2().cwiseProduct(center - x);
        VectorXd change = core::solve_ldlt(normal, gradient);
        constexpr double kMaxStep = 0.7; // a factor of two at once: farther off the simulation is not linear
        change *= std::min(1.0, kMaxStep / change.cwiseAbs().maxCoeff());
        x += change;
        x[1] = std::clamp(x[1], 0.0, 5.0); // the range of a wheel's file
        run = fit.simulate(map.law(x));
        if (round >= 2 && change.cwiseAbs().maxCoeff() < kMaxChange) break;
    }
    weights_of((measured - run.removed)(used), result.depth_error);
    result.law = map.law(x);
    result.names = {"level", "pressure"};
    if (map.fits_feed) result.names.push_back("feed");
    result.mean = x;
    result.covariance = core::solve_ldlt(normal, MatrixXd::Identity(unknowns, unknowns));
    result.reference_pressure = map.pressure;
    result.reference_feed = map.feed;
    result.surfels = count;
    const belt::BeltLaw stepped =
        with_pressure_exponent(result.law, result.law.pressure_exponent + kExponentStep, map.pressure);
    belt::ContactWheel fitted = wheel;
    fitted.law = result.law;
    add_passes(path, fit.simulate(result.law, true), fit.simulate(stepped, true), map.pressure, measured, fitted,
               {wheel.law.pressure_exponent, wheel.law.feed_exponent}, result);
    if (result.passes.empty()) throw core::InputError("no pass removed anything");
    return result;
}

} // namespace fettle::belt_calibrate
