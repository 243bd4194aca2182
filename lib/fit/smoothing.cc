#include "fit/smoothing.h"

#include "surface/spline_energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace fettle::fit {

namespace {

using Eigen::VectorXd;

constexpr double kNullSpace = 6; // dimension of the quadratics, which have no energy

// Range of λ trace(K) / trace(Σ w g gᵀ). Below it rounding swallows the energy that bridges gaps; above it the spline
// is a quadratic.
constexpr double kMinTraceRatio = 1e-4;
constexpr double kMaxTraceRatio = 1e8;

struct Solution {
    SmoothedSpline result;
    double cost = 0; ///< -2 ln of the restricted likelihood, without its constant
};

Solution solve(const NormalEquations& e, const VectorXd& heights, const SplineEnergy& energy, double lambda)
{
    surface::BandMatrix H = e.matrix;
    H.add(energy.K, lambda);
    const surface::BandCholesky factor(std::move(H));
    const VectorXd pull = lambda * (energy.K * heights);
    const VectorXd b = e.right_side - pull;
    const VectorXd step = factor.solve(b);
    const double min_objective = std::max(e.square_sum + heights.dot(pull) - b.dot(step), e.min_square_sum);
    const double freedom = std::max(e.weight_sum - kNullSpace, 1.0);
    Solution s;
    s.result.heights = heights + step;
    s.result.lambda = lambda;
    s.result.variance = min_objective / freedom;
    s.result.change = std::sqrt(step.dot(e.matrix * step) / e.weight_sum);
    s.cost =
        freedom * std::log(min_objective) + factor.log_determinant() - (step.size() - kNullSpace) * std::log(lambda);
    return s;
}

} // namespace

SplineEnergy spline_energy_matrix(const surface::Bspline& grid)
{
    surface::BandMatrix K = surface::zero_band_matrix(grid);
    surface::add_derivative_energy(K, grid, 1);
    const double trace = K.trace();
    return {std::move(K), trace};
}

SmoothedSpline smooth_spline(const NormalEquations& equations, const VectorXd& heights, const SplineEnergy& energy,
                             double lambda)
{
    return solve(equations, heights, energy, lambda).result;
}

double min_lambda(const NormalEquations& equations, const SplineEnergy& energy)
{
    return kMinTraceRatio * equations.matrix.trace() / energy.trace;
}

// Steps in ln λ until three neighbours bracket the minimum of the cost, then goes to the vertex of their parabola; the
// likelihood is flat about its maximum.
SmoothedSpline smooth_spline_by_likelihood(const NormalEquations& equations, const VectorXd& heights,
                                           const SplineEnergy& energy, double start)
{
    constexpr double kLogStep = 2;          // in ln λ
    constexpr double kStepTolerance = 0.25; // in steps: a vertex as near changes the spline too little to matter
    const double lower = min_lambda(equations, energy), upper = lower / kMinTraceRatio * kMaxTraceRatio;
    start = start > 0 ? std::clamp(start, lower, upper) : lower / kMinTraceRatio;
    const int lowest = static_cast<int>(std::floor(std::log(lower / start) / kLogStep));
    const int highest = static_cast<int>(std::ceil(std::log(upper / start) / kLogStep));
    const auto solve_step = [&](double k) { return solve(equations, heights, energy, start * std::exp(kLogStep * k)); };
    std::map<int, Solution> solutions;
    // Three neighbours are needed in any case: solve them in parallel.
    const int from = std::max(lowest, -1), to = std::min(highest, 1);
    for (int i = from; i <= to; ++i) solutions[i];
    tbb::parallel_for(from, to + 1, [&](int i) { solutions.at(i) = solve_step(i); });
    const auto at = [&](int i) -> const Solution& {
        const auto [found, is_new] = solutions.try_emplace(i);
        if (is_new) found->second = solve_step(i);
        return found->second;
    };
    int k = 0;
    while (k > lowest && at(k - 1).cost < at(k).cost) --k;
    while (k < highest && at(k + 1).cost < at(k).cost) ++k;
    if (k == lowest || k == highest) return at(k).result;
    const double left = at(k - 1).cost - at(k).cost, right = at(k + 1).cost - at(k).cost;
    const double vertex = left + right > 0 ? (left - right) / (2 * (left + right)) : 0;
    if (std::abs(vertex) < kStepTolerance) return at(k).result;
    return solve_step(k + vertex).result;
}

} // namespace fettle::fit
