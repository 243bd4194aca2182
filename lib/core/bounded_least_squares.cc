#include "core/bounded_least_squares.h"

#include "core/error.h"

namespace fettle::core {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The problem in unknowns y = x / scale, in which all columns of A have length 1.
class ScaledProblem {
  public:
    ScaledProblem(const Eigen::SparseMatrix<double>& A, const VectorXd& b, const VectorXd& lower, const VectorXd& upper)
        : A_(A), b_(b), scale_(VectorXd::Ones(A.cols()))
    {
        for (Index k = 0; k < A.cols(); ++k)
            if (const double length = A.col(k).norm(); length > 0) scale_[k] = 1 / length;
        lower_ = lower.cwiseQuotient(scale_);
        upper_ = upper.cwiseQuotient(scale_);
    }

    VectorXd clamped(const VectorXd& y) const { return y.cwiseMax(lower_).cwiseMin(upper_); }
    VectorXd scaled(const VectorXd& x) const { return x.cwiseQuotient(scale_); }
    /// x is exactly at a bound wherever y is.
    VectorXd unscaled(const VectorXd& y, const VectorXd& lower, const VectorXd& upper) const
    {
        const VectorXd x = (y.array() >= upper_.array()).select(upper, y.cwiseProduct(scale_));
        return (y.array() <= lower_.array()).select(lower, x).cwiseMax(lower).cwiseMin(upper);
    }
    VectorXd times(const VectorXd& y) const { return A_ * y.cwiseProduct(scale_); }
    VectorXd transposed_times(const VectorXd& r) const { return (A_.transpose() * r).cwiseProduct(scale_); }
    VectorXd residual(const VectorXd& y) const { return times(y) - b_; }
    /// Projected gradient: 0 for unknowns at a bound that descent would violate.
    VectorXd projected_gradient(const VectorXd& y, VectorXd g) const
    {
        for (Index k = 0; k < y.size(); ++k)
            if ((y[k] <= lower_[k] && g[k] > 0) || (y[k] >= upper_[k] && g[k] < 0)) g[k] = 0;
        return g;
    }

  private:
    const Eigen::SparseMatrix<double>& A_;
    const VectorXd& b_;
    VectorXd scale_, lower_, upper_;
};

struct Iterate {
    VectorXd y, r, g; ///< unknowns, residual, gradient of half its square
};

/// Projected line search along d: halves the step until the objective decreases sufficiently (Armijo).
/// @return  true if the iterate moved
bool line_search(const ScaledProblem& problem, Iterate& at, const VectorXd& d, double step)
{
    constexpr int kMaxHalvings = 30;
    constexpr double kSufficientDecrease = 1e-3; // share of the decrease that the gradient predicts
    for (int k = 0; k < kMaxHalvings; ++k, step /= 2) {
        const VectorXd y = problem.clamped(at.y + step * d), moved = y - at.y, change = problem.times(moved);
        const double descent = at.g.dot(moved);
        // The decrease is computed directly: near the solution the difference of two objectives would be roundoff.
        if (descent + change.squaredNorm() / 2 <= kSufficientDecrease * descent) {
            at = {y, at.r + change, problem.transposed_times(at.r + change)};
            return descent < 0;
        }
    }
    return false;
}

/// Minimises by conjugate gradients over the free unknowns, where `g` is not 0; the others are fixed.
VectorXd newton_direction(const ScaledProblem& problem, const VectorXd& g)
{
    constexpr int kMaxIterations = 60;
    constexpr double kGradientReduction = 0.05; // more does not pay, because the active bounds change first
    const Eigen::ArrayXd is_free = (g.array() != 0).cast<double>();
    VectorXd d = VectorXd::Zero(g.size()), rest = -g, p = rest;
    double size = rest.squaredNorm();
    const double target = kGradientReduction * kGradientReduction * size;
    for (int k = 0; k < kMaxIterations && size > target; ++k) {
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
    constexpr int kMaxIterations = 500; // a few dozen are usual
    const ScaledProblem problem(A, b, lower, upper);
    Iterate at;
    at.y = problem.clamped(problem.scaled(start));
    at.r = problem.residual(at.y);
    at.g = problem.transposed_times(at.r);
    const double gradient_tolerance = tolerance * problem.transposed_times(b).lpNorm<Eigen::Infinity>();
    BoundedSolution solution;
    for (int k = 0; k < kMaxIterations; ++k) {
        VectorXd g = problem.projected_gradient(at.y, at.g);
        solution.converged = g.lpNorm<Eigen::Infinity>() <= gradient_tolerance;
        if (solution.converged) break;
        const bool descended = line_search(problem, at, -g, g.squaredNorm() / problem.times(g).squaredNorm());
        g = problem.projected_gradient(at.y, at.g);
        const bool moved = g.lpNorm<Eigen::Infinity>() > gradient_tolerance &&
                           line_search(problem, at, newton_direction(problem, g), 1);
        if (!descended && !moved) break;
    }
    solution.x = problem.unscaled(at.y, lower, upper);
    return solution;
}

} // namespace fettle::core
