#include "core/bounded_least_squares.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

class Problem {
  public:
    Problem(const Eigen::SparseMatrix<double>& A, const VectorXd& b, const VectorXd& lower, const VectorXd& upper)
        : A_(A), b_(b), scale_(VectorXd::Ones(A.cols()))
    {
        for (Index k = 0; k < A.cols(); ++k)
            if (const double length = A.col(k).norm(); length > 0) scale_[k] = 1 / length;
        lower_ = lower.cwiseQuotient(scale_);
        upper_ = upper.cwiseQuotient(scale_);
    }

    VectorXd clamped(const VectorXd& y) const { return y.cwiseMax(lower_).cwiseMin(upper_); }
    VectorXd scaled(const VectorXd& x) const { return x.cwiseQuotient(scale_); }
    /// Exactly the bounds where y is there.
    VectorXd unscaled(const VectorXd& y, const VectorXd& lower, const VectorXd& upper) const
    {
        const VectorXd x = (y.array() >= upper_.array()).select(upper, y.cwiseProduct(scale_));
        return (y.array() <= lower_.array()).select(lower, x).cwiseMax(lower).cwiseMin(upper);
    }
    VectorXd times(const VectorXd& y)
    {
        ++products;
        return A_ * y.cwiseProduct(scale_);
    }
    VectorXd transposed_times(const VectorXd& r)
    {
        ++products;
        return (A_.transpose() * r).cwiseProduct(scale_);
    }
    VectorXd residual(const VectorXd& y) { return times(y) - b_; }
    /// The gradient without what would go through a bound.
    VectorXd allowed(const VectorXd& y, VectorXd g) const
    {
        for (Index k = 0; k < y.size(); ++k)
            if ((y[k] <= lower_[k] && g[k] > 0) || (y[k] >= upper_[k] && g[k] < 0)) g[k] = 0;
        return g;
    }
    int products = 0;

  private:
    const Eigen::SparseMatrix<double>& A_;
    const VectorXd& b_;
    VectorXd scale_, lower_, upper_;
};

/// Where it stands.
struct State {
    VectorXd y, r, g; ///< unknowns, residual, gradient of half its square
};

/// Goes along d as far as the residual shrinks, bent by the bounds. @return  did it get anywhere?
bool advance(Problem& problem, State& at, const VectorXd& d, double step)
{
    constexpr int kHalvings = 30;
    constexpr double kShare = 1e-3; // of the descent that the gradient promises
    for (int k = 0; k < kHalvings; ++k, step /= 2) {
        const VectorXd y = problem.clamped(at.y + step * d), way = y - at.y, change = problem.times(way);
        const double descent = at.g.dot(way);
        // not the difference of two sums, which roundoff would decide in the end
        if (descent + change.squaredNorm() / 2 <= kShare * descent) {
            at = {y, at.r + change, problem.transposed_times(at.r + change)};
            return descent < 0;
        }
    }
    return false;
}

/// Conjugate gradients over the unknowns where `g` is not 0, the others held.
VectorXd newton_direction(Problem& problem, const VectorXd& g)
{
    constexpr int kMost = 60;
    constexpr double kEnough = 0.05; // of the gradient; the bounds that hold change before more pays
    const Eigen::ArrayXd is_free = (g.array() != 0).cast<double>();
    VectorXd d = VectorXd::Zero(g.size()), rest = -g, p = rest;
    double size = rest.squaredNorm();
    const double enough = kEnough * kEnough * size;
    for (int k = 0; k < kMost && size > enough; ++k) {
        const VectorXd Ap = problem.times(p);
        const double curvature = Ap.squaredNorm();
        if (!(curvature > 0)) break;
        const double step = size / curvature;
        d += step * p;
        rest -= (step * problem.transposed_times(Ap).array() * is_free).matrix();
        const double next = rest.squaredNorm();
        p = rest + next / size * p;
        size = next;
    }
    return d;
}

} // namespace

BoundedSolution bounded_least_squares(const Eigen::SparseMatrix<double>& A, const VectorXd& b, const VectorXd& lower,
                                      const VectorXd& upper, const VectorXd& start, double tolerance)
{
    if ((lower.array() > upper.array()).any()) throw InputError("a lower bound is above the upper");
    constexpr int kMost = 500; // rounds; a few dozen are usual
    Problem problem(A, b, lower, upper);
    State at;
    at.y = problem.clamped(problem.scaled(start));
    at.r = problem.residual(at.y);
    at.g = problem.transposed_times(at.r);
    const double small = tolerance * problem.transposed_times(b).lpNorm<Eigen::Infinity>();
    BoundedSolution solution;
    for (int round = 0; round < kMost; ++round) {
        VectorXd g = problem.allowed(at.y, at.g);
        solution.converged = g.lpNorm<Eigen::Infinity>() <= small;
        if (solution.converged) break;
        const bool descended = advance(problem, at, -g, g.squaredNorm() / problem.times(g).squaredNorm());
        g = problem.allowed(at.y, at.g);
        const bool went = g.lpNorm<Eigen::Infinity>() > small && advance(problem, at, newton_direction(problem, g), 1);
        if (!descended && !went) break;
    }
    solution.x = problem.unscaled(at.y, lower, upper);
    solution.products = problem.products;
    return solution;
}

} // namespace fettle
