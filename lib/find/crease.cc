#include "find/crease.h"

#include "geometry/quantiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace fettle::find {
namespace {

using Eigen::Index;

constexpr Index kMaxSearchPoints = 100; // more points do not distinguish lines better
constexpr int kSearchDirections = 8, kSearchOffsets = 7;
constexpr int kHalvings = 5; // of the steps between these
constexpr int kSearchDegree = 2, kRobustIterations = 2;
// Lines are compared by this quantile of the residuals: a fifth of the ring may be no metal.
constexpr double kSearchQuantile = 0.8;
// Lines are tried as far off the ring's centroid as this multiple of the region's radius, which is a quantile of the
// distances of the ring's points from there, and not beyond what leaves points on both sides.
constexpr double kInnerQuantile = 0.05, kMinInnerRadius = 0.1;
constexpr double kOffsetPerRadius = 1.5, kMaxOffset = 0.8;

struct Line {
    double direction, offset;

    Crease crease() const { return {{std::cos(direction), std::sin(direction)}, offset}; }
};

struct Sides {
    Eigen::VectorXd residuals;
    double bend; ///< of the slope across the line, at its middle
};

/// Quadratics on both sides of lines.
class SidesOfLines {
  public:
    explicit SidesOfLines(const Ring& ring) : ring_(ring), basis_(ring.xy, kSearchDegree) {}

    Sides operator()(const Crease& crease)
    {
        basis_.set_crease(ring_.xy, crease);
        const RingColumns columns = basis_.of(kSearchDegree, true);
        const Eigen::VectorXd all = Eigen::VectorXd::Ones(ring_.z.size());
        Eigen::VectorXd weights = all;
        RingCoefficients coefficients;
        Sides sides;
        for (int iteration = 0; iteration < kRobustIterations; ++iteration) {
            coefficients = columns.solve(ring_.z, weights.cwiseProduct(ring_.near));
            sides.residuals = columns.residuals(ring_.z, coefficients);
            if (iteration + 1 < kRobustIterations)
                reweigh(weights, sides.residuals, all, std::max(kMinRingSigmas * ring_.sigma, kMinRingSpread));
        }
        sides.bend = coefficients[0];
        return sides;
    }

  private:
    const Ring& ring_;
    RingBasis basis_;
};

/// Misfit of a line, mm; infinite where it is no ridge.
double misfit(const Sides& sides)
{
    return sides.bend < 0 ? quantile_of_sizes(sides.residuals, kSearchQuantile)
                          : std::numeric_limits<double>::infinity();
}

} // namespace

std::optional<Crease> find_crease(const Ring& ring, const std::optional<Crease>& near)
{
    const Ring some = thinned(ring, kMaxSearchPoints);
    std::vector<double> distances;
    for (const auto& p : some.xy.colwise()) distances.push_back(p.norm());
    const double radius = geometry::quantile(distances, kInnerQuantile);
    if (radius < kMinInnerRadius) return std::nullopt;
    const double reach = std::min(kOffsetPerRadius * radius, kMaxOffset);
    Line best{0, 0};
    double min = std::numeric_limits<double>::infinity();
    SidesOfLines sides_of(some);
    const auto try_line = [&](const Line& line) {
        if (std::abs(line.offset) > reach) return;
        if (const double own = misfit(sides_of(line.crease())); own < min) min = own, best = line;
    };
    double turn = std::numbers::pi / kSearchDirections, shift = 2 * reach / kSearchOffsets;
    if (near)
        try_line({std::atan2(near->across.y(), near->across.x()), near->offset});
    else
        for (int d = 0; d < kSearchDirections; ++d)
            for (int k = 0; k < kSearchOffsets; ++k) try_line({d * turn, (k - (kSearchOffsets - 1) / 2.0) * shift});
    if (!std::isfinite(min)) return std::nullopt;
    for (int halving = 0; halving < kHalvings; ++halving) {
        turn /= 2, shift /= 2;
        for (const Line& step : {Line{turn, 0}, Line{0, shift}})
            for (const double sign : {-1.0, 1.0}) {
                const Line from = best;
                try_line({from.direction + sign * step.direction, from.offset + sign * step.offset});
            }
    }
    return best.crease();
}

Eigen::VectorXd crease_weights(const Ring& ring, const Crease& crease)
{
    const Eigen::VectorXd residuals = SidesOfLines(ring)(crease).residuals;
    const double sd = std::max(
        {geometry::kMedianToSigma * quantile_of_sizes(residuals, 0.5), kMinRingSigmas * ring.sigma, kMinRingSpread});
    return (1 - (residuals.array() / (kRingStartCutoff * sd)).square()).max(0).square();
}

} // namespace fettle::find
