#include "fit/correlation.h"

namespace fettle::fit {

Eigen::ArrayXd correlation_at(const Correlation& correlation, const Eigen::ArrayXd& squared_distances)
{
    const Eigen::ArrayXd scaled = squared_distances / (correlation.length * correlation.length);
    if (correlation.kernel == Kernel::squared_exponential) return (scaled / -2).exp();
    const Eigen::ArrayXd r = (5 * scaled).sqrt();
    return (1 + r + r.square() / 3) * (-r).exp();
}

Eigen::MatrixXd correlation_matrix(const Correlation& correlation, const Eigen::Matrix2Xd& a, const Eigen::Matrix2Xd& b)
{
    Eigen::MatrixXd K(a.cols(), b.cols());
    for (Eigen::Index j = 0; j < b.cols(); ++j)
        K.col(j) = correlation_at(correlation, (a.colwise() - b.col(j)).colwise().squaredNorm().transpose());
    return K;
}

} // namespace fettle::fit
