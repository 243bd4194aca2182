#include "fit/trimmed_touches.h"

#include "core/decompositions.h"
#include "fit/family.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Least trimmed squares of a polynomial from random subsets, with concentration steps.
class TrimmedSearch {
  public:
    TrimmedSearch(const MatrixXd& design, const VectorXd& z)
        : design_(design), z_(z), kept_(static_cast<std::size_t>((3 * z.size() + 3) / 4))
    {
    }

    Columns search()
    {
        constexpr int kSubsets = 300; // 8 good ones of 16 touches with 3 slips are found in every tenth
        constexpr int kSteps = 3;     // a start that leads nowhere shows by then
        std::mt19937_64 random(1);
        Columns order(static_cast<std::size_t>(z_.size()));
        std::iota(order.begin(), order.end(), Index{0});
        Columns best;
        double least = std::numeric_limits<double>::infinity();
        for (int subset = 0; subset < kSubsets; ++subset) {
            Columns drawn = order;
            const auto count = static_cast<std::size_t>(design_.cols()) + 1;
            for (std::size_t i = 0; i < count; ++i) std::swap(drawn[i], drawn[i + random() % (drawn.size() - i)]);
            drawn.resize(count);
            double sum = 0;
            for (int step = 0; step < kSteps; ++step) sum = concentrate(drawn);
            if (!(sum < least)) continue;
            for (double before = std::numeric_limits<double>::infinity(); sum < before;) {
                before = sum;
                sum = concentrate(drawn);
            }
            least = sum;
            best = drawn;
        }
        return best;
    }

  private:
    /// Replaces the touches by those nearest to their fit. @return  the sum of those squares
    double concentrate(Columns& touches) const
    {
        const VectorXd theta = shortest_least_squares(design_(touches, Eigen::all), z_(touches)).x;
        const VectorXd squares = (z_ - design_ * theta).cwiseAbs2();
        Columns order(static_cast<std::size_t>(z_.size()));
        std::iota(order.begin(), order.end(), Index{0});
        std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return squares[a] < squares[b]; });
        order.resize(kept_);
        touches = order;
        return squares(touches).sum();
    }

    const MatrixXd& design_;
    const VectorXd& z_;
    std::size_t kept_;
};

} // namespace

Columns trimmed_touches(const Touched& touched)
{
    constexpr int kQuadratic = 2;
    const Columns all = all_touches(touched);
    for (int degree = kQuadratic; degree >= 1; --degree) {
        const std::optional<FamilySolution> design = solve_family(degree == 2 ? "quadratic" : "plane", touched, all);
        if (!design || 2 * design->gradients.rows() > touched.xyz.cols()) continue;
        const MatrixXd A = design->gradients.transpose();
        const VectorXd z = touched.xyz.row(2).transpose();
        Columns kept = TrimmedSearch(A, z).search();
        std::sort(kept.begin(), kept.end());
        return kept;
    }
    return all;
}

} // namespace fettle
