#include "fit/correlation.h"

namespace fettle {

Eigen::ArrayXd at(const Correlation& correlation, const Eigen::ArrayXd& squares)
{
    const Eigen::ArrayXd squared = squares / (correlation.length * correlation.length);
    if (correlation.roughness == Roughness::none) return (squared / -2).exp();
    const Eigen::ArrayXd r = (5 * squared).sqrt();
    return (1 + r + r.square() / 3) * (-r).exp();
}

Eigen::MatrixXd correlations(const Correlation& correlation, const Eigen::Matrix2Xd& a, const Eigen::Matrix2Xd& b)
{
    Eigen::MatrixXd K(a.cols(), b.cols());
    for (Eigen::Index j = 0; j < b.cols(); ++j)
        K.col(j) = at(correlation, (a.colwise() - b.col(j)).colwise().squaredNorm().transpose());
    return K;
}

} // namespace fettle
