#include "core/decompositions.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <type_traits>

namespace fettle::core {

template <int kSize>
SymmetricEigen<kSize> symmetric_eigen(const Eigen::Matrix<double, kSize, kSize>& A)
{
    // Eigen is faster with the fixed size 3, which is called often.
    using Matrix = std::conditional_t<kSize == 3, Eigen::Matrix3d, Eigen::MatrixXd>;
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen{Matrix(A)};
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

template SymmetricEigen<2> symmetric_eigen(const Eigen::Matrix<double, 2, 2>&);
template SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix<double, 3, 3>&);
template SymmetricEigen<6> symmetric_eigen(const Eigen::Matrix<double, 6, 6>&);
template SymmetricEigen<Eigen::Dynamic> symmetric_eigen(const Eigen::MatrixXd&);

QrFactors householder_qr(const Eigen::MatrixXd& A, Eigen::Index columns)
{
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A);
    return {qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), columns),
            qr.matrixQR().topRows(A.cols()).triangularView<Eigen::Upper>()};
}

std::optional<Eigen::MatrixXd> inverse_gram_factor(const Eigen::MatrixXd& A, double threshold)
{
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
    qr.setThreshold(threshold);
    const Eigen::Index p = A.cols();
    if (qr.rank() < p) return std::nullopt;
    const Eigen::MatrixXd R_inverse =
        qr.matrixR().topLeftCorner(p, p).triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(p, p));
    return qr.colsPermutation() * R_inverse;
}

namespace {

template <typename Decomposition>
LeastSquaresSolution solved(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::optional<double> threshold)
{
    Decomposition decomposition;
    if (threshold) decomposition.setThreshold(*threshold);
    decomposition.compute(A);
    return {decomposition.solve(b), decomposition.rank()};
}

} // namespace

LeastSquaresSolution least_squares_by_qr(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                         std::optional<double> threshold)
{
    return solved<Eigen::ColPivHouseholderQR<Eigen::MatrixXd>>(A, b, threshold);
}

LeastSquaresSolution min_norm_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                            std::optional<double> threshold)
{
    return solved<Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>>(A, b, threshold);
}

} // namespace fettle::core
