#include "core/cholesky.h"

#include <Eigen/Cholesky>

namespace fettle::core {

Cholesky::Cholesky(const Eigen::MatrixXd& A) : L_(Eigen::LLT<Eigen::MatrixXd>(A).matrixL()) {}

Eigen::MatrixXd Cholesky::solve_lower(const Eigen::MatrixXd& B) const
{
    return L_.triangularView<Eigen::Lower>().solve(B);
}

Eigen::VectorXd Cholesky::solve_column(const Eigen::VectorXd& b) const
{
    Eigen::VectorXd x = b;
    L_.triangularView<Eigen::Lower>().solveInPlace(x);
    L_.triangularView<Eigen::Lower>().adjoint().solveInPlace(x);
    return x;
}

Eigen::MatrixXd Cholesky::solve_columns(const Eigen::MatrixXd& B) const
{
    Eigen::MatrixXd X = B;
    L_.triangularView<Eigen::Lower>().solveInPlace(X);
    L_.triangularView<Eigen::Lower>().adjoint().solveInPlace(X);
    return X;
}

Eigen::VectorXd solve_ldlt_column(const Eigen::MatrixXd& A, const Eigen::VectorXd& b)
{
    return Eigen::LDLT<Eigen::MatrixXd>(A).solve(b);
}

Eigen::MatrixXd solve_ldlt_columns(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B)
{
    return Eigen::LDLT<Eigen::MatrixXd>(A).solve(B);
}

} // namespace fettle::core
