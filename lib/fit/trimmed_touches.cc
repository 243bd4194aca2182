#include "fit/trimmed_touches.h"

#include "core/decompositions.h"
#include "fit/family.h"

#include <Eigen/Cholesky>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A subset of the touches, whose polynomial is to be fitted to.
struct Subset {
    TouchIndices touches;
    double sum = std::numeric_limits<double>::infinity(); ///< of squared residuals
};

/// A concentration step: replaces the touches by the three quarters nearest to their fit, in ascending order.
/// @param basis  orthonormal functions of the polynomial at the touches, a column for each touch
void concentrate(const MatrixXd& basis, const VectorXd& z, Subset& subset)
{
    // On the stack: a fit takes hundreds of these steps, which otherwise wait for the heap.
    constexpr int kMaxTerms = 6; // of a quadratic
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxTerms, kMaxTerms>;
    using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxTerms, 1>;
    const Index terms = basis.rows();
    Matrix A = Matrix::Zero(terms, terms); // lower half
    Vector b = Vector::Zero(terms);
    for (const Index touch : subset.touches) {
        const double* const functions = basis.col(touch).data();
        for (Index k = 0; k < terms; ++k) {
            for (Index i = k; i < terms; ++i) A(i, k) += functions[k] * functions[i];
            b[k] += z[touch] * functions[k];
        }
    }
    const Vector theta = Eigen::LDLT<Matrix>(A).solve(b);
    VectorXd squares = z;
    squares.noalias() -= basis.transpose() * theta;
    squares = squares.cwiseAbs2();
    subset.touches.resize(z.size());
    std::iota(subset.touches.begin(), subset.touches.end(), Index{0});
    const auto end = subset.touches.begin() + (3 * z.size() + 3) / 4;
    std::nth_element(subset.touches.begin(), end - 1, subset.touches.end(),
                     [&](Index i, Index k) { return squares[i] < squares[k] || (squares[i] == squares[k] && i < k); });
    subset.touches.erase(end, subset.touches.end());
    std::sort(subset.touches.begin(), subset.touches.end());
    subset.sum = squares(subset.touches).sum();
}

/// Leaves out subsets that have become one before them: they would go the same way.
void erase_repetitions(std::vector<Subset>& subsets)
{
    std::set<TouchIndices> seen;
    std::erase_if(subsets, [&](const Subset& subset) { return !seen.insert(subset.touches).second; });
}

/// Random subsets of `size` of `count` touches.
std::vector<Subset> random_subsets(Index count, Index size)
{
    constexpr int kSubsets = 300; // one in seven subsets of 7 of 16 touches has none of 3 outliers
    std::mt19937_64 random(1);
    std::vector<Subset> all(kSubsets);
    for (Subset& subset : all) {
        subset.touches.resize(count);
        std::iota(subset.touches.begin(), subset.touches.end(), Index{0});
        for (Index i = 0; i < size; ++i)
            std::swap(subset.touches[i], subset.touches[i + random() % (subset.touches.size() - i)]);
        subset.touches.resize(size);
    }
    return all;
}

/// Least trimmed squares of a polynomial from random subsets with concentration steps.
TouchIndices least_trimmed_squares(const MatrixXd& basis, const VectorXd& z)
{
    constexpr int kConcentrationSteps = 3; // they suffice to recognise a bad subset
    std::vector<Subset> subsets = random_subsets(z.size(), basis.rows() + 1);
    for (int step = 0; step < kConcentrationSteps; ++step) {
        if (step > 0) erase_repetitions(subsets);
        tbb::parallel_for(std::size_t{0}, subsets.size(), [&](std::size_t k) { concentrate(basis, z, subsets[k]); });
    }
    Subset best;
    for (Subset& subset : subsets) {
        if (!(subset.sum < best.sum)) continue;
        for (double before = std::numeric_limits<double>::infinity(); subset.sum < before;) {
            before = subset.sum;
            concentrate(basis, z, subset);
        }
        best = std::move(subset);
    }
    return best.touches;
}

} // namespace

TouchIndices trimmed_touches(const TouchSet& touches)
{
    const TouchIndices all = all_touches(touches);
    for (const char* name : {"quadratic", "plane"}) {
        const std::optional<FamilySolution> design = solve_family(name, touches, all);
        if (design && 2 * design->gradients.rows() <= touches.xyz.cols())
            return least_trimmed_squares(
                core::householder_qr(design->gradients.transpose(), design->gradients.rows()).Q.transpose(),
                touches.xyz.row(2).transpose());
    }
    return all;
}

} // namespace fettle::fit
