#include "fit/smoothing.h"

#include "surface/spline_energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace fettle {

namespace {

using Eigen::VectorXd;

constexpr double kFree = 6; // quadratics, which have no energy

// λ E against Σ w g gᵀ, by their traces. Below, what bridges a gap is lost in rounding; above, all that differs from a
// quadratic is gone.
constexpr double kLeastShare = 1e-4;
constexpr double kMostShare = 1e8;

struct Solution {
    Smoothed result;
    double cost = 0; ///< -2 ln of the restricted likelihood, without its constant
};

Solution solve(const NormalEquations& e, const VectorXd& heights, const Energy& energy, double lambda)
{
    BandMatrix H = e.matrix;
    H.add(energy.K, lambda);
    const BandCholesky factor(std::move(H));
    const VectorXd pull = lambda * (energy.K * heights);
    const VectorXd b = e.right - pull;
    const VectorXd step = factor.solve(b);
    const double least = std::max(e.square + heights.dot(pull) - b.dot(step), e.least_square);
    const double freedom = std::max(e.weight - kFree, 1.0);
    Solution s;
    s.result.heights = heights + step;
    s.result.lambda = lambda;
    s.result.variance = least / freedom;
    s.result.change = std::sqrt(step.dot(e.matrix * step) / e.weight);
    s.cost = freedom * std::log(least) + factor.log_determinant() -
             (static_cast<double>(step.size()) - kFree) * std::log(lambda);
    return s;
}

} // namespace

Energy energy_over(const Bspline& grid)
{
    BandMatrix K = band_over(grid);
    add_energy(K, grid, 1);
    const double trace = K.trace();
    return {std::move(K), trace};
}

Smoothed smoothed(const NormalEquations& equations, const VectorXd& heights, const Energy& energy, double lambda)
{
    return solve(equations, heights, energy, lambda).result;
}

double least_lambda(const NormalEquations& equations, const Energy& energy)
{
    return kLeastShare * equations.matrix.trace() / energy.trace;
}

// Downhill in ln λ to three neighbours with the least in the middle, then to the vertex of their parabola: the
// likelihood is flat about its maximum.
Smoothed smoothed_by_likelihood(const NormalEquations& equations, const VectorXd& heights, const Energy& energy,
                                double start)
{
    constexpr double kStep = 2;    // in ln λ
    constexpr double kNear = 0.25; // of a step: closer to the vertex nothing changes that matters
    const double least = least_lambda(equations, energy), most = least / kLeastShare * kMostShare;
    start = start > 0 ? std::clamp(start, least, most) : least / kLeastShare;
    const int lowest = static_cast<int>(std::floor(std::log(least / start) / kStep));
    const int highest = static_cast<int>(std::ceil(std::log(most / start) / kStep));
    std::map<int, Solution> known;
    { // the least that it takes, at once
        std::array<Solution, 3> first;
        const int from = std::max(lowest, -1), to = std::min(highest, 1);
        tbb::parallel_for(from, to + 1, [&](int k) {
            first[static_cast<std::size_t>(k - from)] = solve(equations, heights, energy, start * std::exp(kStep * k));
        });
        for (int k = from; k <= to; ++k) known.emplace(k, std::move(first[static_cast<std::size_t>(k - from)]));
    }
    const auto at = [&](int k) -> const Solution& {
        auto found = known.find(k);
        if (found == known.end())
            found = known.emplace(k, solve(equations, heights, energy, start * std::exp(kStep * k))).first;
        return found->second;
    };
    int k = 0;
    while (k > lowest && at(k - 1).cost < at(k).cost) --k;
    while (k < highest && at(k + 1).cost < at(k).cost) ++k;
    if (k == lowest || k == highest) return at(k).result;
    const double left = at(k - 1).cost - at(k).cost, right = at(k + 1).cost - at(k).cost;
    const double vertex = left + right > 0 ? (left - right) / (2 * (left + right)) : 0;
    if (std::abs(vertex) < kNear) return at(k).result;
    return solve(equations, heights, energy, start * std::exp(kStep * (k + vertex))).result;
}

} // namespace fettle
