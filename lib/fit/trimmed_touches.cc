#include "fit/trimmed_touches.h"

#include "core/cholesky.h"
#include "core/decompositions.h"
#include "fit/family.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A concentration step: replaces the touches by the three quarters nearest to their fit.
/// @param basis  orthonormal functions of the polynomial at the touches   @return  the sum of their squared residuals
double concentrate(const MatrixXd& basis, const VectorXd& z, TouchIndices& touches)
{
    const MatrixXd chosen = basis(touches, Eigen::all);
    const VectorXd theta = core::solve_ldlt(chosen.transpose() * chosen, chosen.transpose() * z(touches));
    const VectorXd squares = (z - basis * theta).cwiseAbs2();
    touches.resize(z.size());
    std::iota(touches.begin(), touches.end(), Index{0});
    const auto end = touches.begin() + (3 * z.size() + 3) / 4;
    std::nth_element(touches.begin(), end - 1, touches.end(),
                     [&](Index a, Index b) { return squares[a] < squares[b] || (squares[a] == squares[b] && a < b); });
    touches.erase(end, touches.end());
    return squares(touches).sum();
}

/// Least trimmed squares of a polynomial from random subsets with concentration steps.
TouchIndices least_trimmed_squares(const MatrixXd& basis, const VectorXd& z)
{
    constexpr int kSubsets = 300;          // one in seven subsets of 7 of 16 touches has none of 3 outliers
    constexpr int kConcentrationSteps = 3; // they suffice to recognise a bad subset
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const std::size_t subset_size = basis.cols() + 1;
    std::mt19937_64 random(1);
    TouchIndices best;
    double min_sum = kInfinity;
    for (int subset = 0; subset < kSubsets; ++subset) {
        TouchIndices touches(z.size());
        std::iota(touches.begin(), touches.end(), Index{0});
        for (std::size_t i = 0; i < subset_size; ++i)
            std::swap(touches[i], touches[i + random() % (touches.size() - i)]);
        touches.resize(subset_size);
        double sum = 0;
        for (int step = 0; step < kConcentrationSteps; ++step) sum = concentrate(basis, z, touches);
        if (!(sum < min_sum)) continue;
        for (double before = kInfinity; sum < before;) {
            before = sum;
            sum = concentrate(basis, z, touches);
        }
        min_sum = sum;
        best = touches;
    }
    std::sort(best.begin(), best.end());
    return best;
}

} // namespace

TouchIndices trimmed_touches(const TouchSet& touches)
{
    const TouchIndices all = all_touches(touches);
    for (const char* name : {"quadratic", "plane"}) {
        const std::optional<FamilySolution> design = solve_family(name, touches, all);
        if (design && 2 * design->gradients.rows() <= touches.xyz.cols())
            return least_trimmed_squares(
                core::householder_qr(design->gradients.transpose(), design->gradients.rows()).Q,
                touches.xyz.row(2).transpose());
    }
    return all;
}

} // namespace fettle::fit
