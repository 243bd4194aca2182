#include "fit/correlation.h"

namespace fettle::fit {

Eigen::ArrayXd correlation_at(const Correlation& correlation, const Eigen::ArrayXd& squared_distances)
{
    const Eigen::ArrayXd scaled = squared_distances / (correlation.length * correlation.length);
    if (correlation.kernel == Kernel::squared_exponential) return (scaled / -2).exp();
    const Eigen::ArrayXd r = (5 * scaled).sqrt();
    return (1 + r + r.square() / 3) * (-r).exp();
}

Eigen::MatrixXd squared_distances(const Eigen::Matrix2Xd& a, const Eigen::Matrix2Xd& b)
{
    Eigen::MatrixXd result(a.cols(), b.cols());
    for (Eigen::Index j = 0; j < b.cols(); ++j) result.col(j) = (a.colwise() - b.col(j)).colwise().squaredNorm();
    return result;
}

Eigen::MatrixXd correlation_matrix(const Correlation& correlation, const Eigen::MatrixXd& squared_distances)
{
    return correlation_at(correlation, squared_distances.reshaped())
        .reshaped(squared_distances.rows(), squared_distances.cols());
}

Eigen::MatrixXd correlation_matrix(const Correlation& correlation, const Eigen::Matrix2Xd& a, const Eigen::Matrix2Xd& b)
{
    return correlation_matrix(correlation, squared_distances(a, b));
}

} // namespace fettle::fit
