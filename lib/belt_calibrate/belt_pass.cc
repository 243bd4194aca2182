#include "belt_calibrate/belt_pass.h"

#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace fettle::belt_calibrate {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Surfels at the rim of a pass lose little, and what they lose hangs on the contact's width.
constexpr double kMinLossShare = 0.1; // of the largest loss

belt::BeltRun simulate(belt::Surfels surfels, const belt::ContactWheel& wheel,
                       const std::vector<belt::BeltPoint>& points, const belt::BeltOptions& options,
                       const belt::ContactGrid& grid)
{
    belt::BeltGrinding simulation(surfels, wheel, points, options);
    simulation.set_contact_grid(grid); // cells of another size would take another depth
    while (!simulation.is_done()) simulation.step();
    return simulation.run();
}

bool has_one_feed(const std::vector<belt::BeltPoint>& points)
{
    for (const belt::BeltPoint& point : points)
        if (point.is_on_part() && point.feed != points.front().feed) return false;
    return true;
}

} // namespace

belt::BeltLaw with_pressure_exponent(belt::BeltLaw law, double exponent, double pressure)
{
    law.coefficient *= std::pow(pressure, law.pressure_exponent - exponent);
    law.pressure_exponent = exponent;
    return law;
}

double mean_pressure(const std::vector<belt::BeltTrace>& trace)
{
    double sum = 0, count = 0;
    for (const belt::BeltTrace& at : trace) {
        if (!(at.area > 0)) continue;
        sum += std::log(at.force / at.area);
        ++count;
    }
    return std::exp(sum / count);
}

SimulatedPass simulate_pass(const belt::Surfels& surfels, const belt::ContactWheel& wheel,
                            const std::vector<belt::BeltPoint>& points, belt::BeltOptions options,
                            const belt::ContactGrid& grid)
{
    SimulatedPass pass;
    options.keep_removals = !has_one_feed(points);
    pass.run = simulate(surfels, wheel, points, options, grid);
    const VectorXd& removed = pass.run.removed;
    const auto is_lost = removed.array() > kMinLossShare * removed.maxCoeff();

    options.keep_removals = false;
    const double pressure = mean_pressure(pass.run.trace);
    const auto losses_by = [&](const belt::BeltLaw& law) {
        belt::ContactWheel stepped = wheel;
        stepped.law = law;
        return simulate(surfels, stepped, points, options, grid).removed;
    };
    belt::BeltLaw faster = wheel.law;
    faster.coefficient *= std::exp(kLevelStep);
    const VectorXd more = losses_by(faster), other = losses_by(with_pressure_exponent(
                                                 wheel.law, wheel.law.pressure_exponent + kExponentStep, pressure));
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    pass.sensitivity = is_lost.select((more.array() / removed.array()).log() / kLevelStep, kNan);
    pass.log_pressure =
        (other.array() / removed.array()).log() / kExponentStep / pass.sensitivity.array() + std::log(pressure);
    pass.pass_sensitivity = std::log(more.sum() / removed.sum()) / kLevelStep;
    pass.pressure = pressure * std::exp(std::log(other.sum() / removed.sum()) / kExponentStep / pass.pass_sensitivity);

    VectorXd sum = VectorXd::Zero(removed.size());
    if (pass.run.removals.empty())
        sum = std::log(points.front().feed) * removed;
    else
        for (const belt::SurfelRemoval& loss : pass.run.removals)
            sum[loss.surfel] += loss.depth * std::log(points[loss.point].feed);
    pass.log_feed = is_lost.select(sum.array() / removed.array(), kNan);
    pass.feed = std::exp(sum.sum() / removed.sum());
    pass.run.removals = {};
    return pass;
}

std::vector<PassPart> divide_pass(const SimulatedPass& pass, const VectorXd& lost)
{
    constexpr double kRatio = 0.1;     // in logarithm: finer parts tell hardly more
    constexpr double kMinShare = 0.05; // of the pass
    struct Sums {
        double measured = 0, simulated = 0, log_pressure = 0, log_feed = 0, sensitivity = 0;
    };
    std::map<std::pair<long, long>, Sums> parts;
    double total = 0;
    for (Index i = 0; i < lost.size(); ++i) {
        const double log_pressure = pass.log_pressure[i], log_feed = pass.log_feed[i], depth = pass.run.removed[i];
        if (!std::isfinite(log_pressure) || !std::isfinite(lost[i])) continue;
        Sums& part = parts[{std::lround((log_pressure - std::log(pass.pressure)) / kRatio),
                            std::lround((log_feed - std::log(pass.feed)) / kRatio)}];
        part.measured += lost[i];
        part.simulated += depth;
        part.log_pressure += depth * log_pressure;
        part.log_feed += depth * log_feed;
        part.sensitivity += depth * pass.sensitivity[i];
        total += depth;
    }
    std::vector<PassPart> result;
    for (const auto& [key, part] : parts)
        if (part.simulated > kMinShare * total && part.measured > 0)
            result.push_back({std::exp(part.log_pressure / part.simulated), std::exp(part.log_feed / part.simulated),
                              std::pow(part.measured / part.simulated, part.simulated / part.sensitivity)});
    if (result.size() < 2) result.clear();
    return result;
}

} // namespace fettle::belt_calibrate
