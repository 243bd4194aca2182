#include "fit/trimmed_touches.h"

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
/// @return  the sum of their squared residuals
double concentrate(const MatrixXd& design, const VectorXd& z, TouchIndices& touches)
{
    const VectorXd theta = core::min_norm_least_squares(design(touches, Eigen::all), z(touches)).x;
    const VectorXd squares = (z - design * theta).cwiseAbs2();
    touches.resize(z.size());
    std::iota(touches.begin(), touches.end(), Index{0});
    std::stable_sort(touches.begin(), touches.end(), [&](Index a, Index b) { return squares[a] < squares[b]; });
    touches.resize((3 * z.size() + 3) / 4);
    return squares(touches).sum();
}

/// Least trimmed squares of a polynomial from random subsets with concentration steps.
TouchIndices least_trimmed_squares(const MatrixXd& design, const VectorXd& z)
{
    constexpr int kSubsets = 300;          // one in seven subsets of 7 of 16 touches has none of 3 outliers
    constexpr int kConcentrationSteps = 3; // they suffice to recognise a bad subset
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const std::size_t subset_size = design.cols() + 1;
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
        for (int step = 0; step < kConcentrationSteps; ++step) sum = concentrate(design, z, touches);
        if (!(sum < min_sum)) continue;
        for (double before = kInfinity; sum < before;) {
            before = sum;
            sum = concentrate(design, z, touches);
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
            return least_trimmed_squares(design->gradients.transpose(), touches.xyz.row(2).transpose());
    }
    return all;
}

} // namespace fettle::fit
