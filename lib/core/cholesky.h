#pragma once

#include <Eigen/Core>

namespace fettle::core {

// As Eigen's LLT and LDLT of matrices of any size, which take two seconds to compile in each file that names one; these
// are compiled once. Of A only the lower half is read. A right side may be an expression, of one column or of several.

/// A = L Lᵀ for a positive definite A
class Cholesky {
  public:
    explicit Cholesky(const Eigen::MatrixXd& A);

    /// Its upper half is 0.
    const Eigen::MatrixXd& L() const { return L_; }

    /// A⁻¹ B
    template <typename Expression>
    auto solve(const Eigen::MatrixBase<Expression>& B) const
    {
        if constexpr (Expression::ColsAtCompileTime == 1)
            return solve_column(B);
        else
            return solve_columns(B);
    }

    /// L⁻¹ B
    Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& B) const;

  private:
    Eigen::VectorXd solve_column(const Eigen::VectorXd& b) const;
    Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& B) const;

    Eigen::MatrixXd L_;
};

Eigen::VectorXd solve_ldlt_column(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd solve_ldlt_columns(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// A⁻¹ B for a semidefinite A, by pivoting: A = Pᵀ L D Lᵀ P
template <typename Expression>
auto solve_ldlt(const Eigen::MatrixXd& A, const Eigen::MatrixBase<Expression>& B)
{
    if constexpr (Expression::ColsAtCompileTime == 1)
        return solve_ldlt_column(A, B);
    else
        return solve_ldlt_columns(A, B);
}

} // namespace fettle::core
