#include "margin/field_draws.h"

#include "core/decompositions.h"
#include "surface/precision.h"

#include <cmath>
#include <random>
#include <vector>

namespace fettle {

namespace {

/// F with F Fᵀ = covariance: Cholesky's factor, the largest variance left first (Golub and Van Loan 2013, 4.2.8), up to
/// where rounding makes pivots negative. Smooth fields have few columns.
Eigen::MatrixXd root(const Eigen::MatrixXd& covariance)
{
    constexpr double kRounding = 1e-10; // of the largest variance
    // Parameters differ in unit (lengths, angles, curvatures): by their own size first.
    const Eigen::VectorXd size = covariance.diagonal().cwiseMax(0).cwiseSqrt();
    const Eigen::VectorXd inverse = size.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; });
    Eigen::VectorXd left = covariance.diagonal().cwiseProduct(inverse.cwiseAbs2());
    Eigen::MatrixXd L(covariance.rows(), covariance.cols());
    Eigen::Index rank = 0, largest = 0;
    for (; rank < L.cols() && left.maxCoeff(&largest) > kRounding; ++rank) {
        Eigen::VectorXd column = covariance.col(largest).cwiseProduct(inverse) * inverse[largest];
        column.noalias() -= L.leftCols(rank) * L.row(largest).head(rank).transpose();
        L.col(rank) = column / std::sqrt(left[largest]);
        left -= L.col(rank).cwiseAbs2();
        left[largest] = 0;
    }
    return size.asDiagonal() * L.leftCols(rank);
}

/// The same of the heights Gᵀ θ, by the principal axes of the heights themselves, so that a job that is turned has the
/// same draws. With B a root, Bᵀ B is small, and B times its eigenvectors is the root whose columns are perpendicular.
Eigen::MatrixXd field_root(const Eigen::MatrixXd& gradients, const Eigen::MatrixXd& covariance)
{
    const Eigen::MatrixXd B = gradients.transpose() * root(covariance);
    const SymmetricEigen<Eigen::Dynamic> axes = symmetric_eigen<Eigen::Dynamic>(B.transpose() * B);
    Eigen::MatrixXd field = B * axes.vectors;
    // Axes have no sign of their own. Weights without symmetry, or those of symmetric places cancel.
    const Eigen::VectorXd weights =
        Eigen::VectorXd::LinSpaced(field.rows(), 1, static_cast<double>(field.rows())).array().sin();
    for (Eigen::Index k = 0; k < field.cols(); ++k)
        if (field.col(k).dot(weights) < 0) field.col(k) *= -1;
    return field;
}

/// Where the touches' noise was estimated: what it may be, over what the covariance was widened for (its mean square is
/// 1), so that heights have Student's t distribution.
double noise_ratio(double freedom, std::mt19937_64& random)
{
    if (!std::isfinite(freedom)) return 1;
    std::chi_squared_distribution<double> squares(freedom);
    return std::sqrt((freedom - 2) / squares(random));
}

struct Possible {
    double weight;
    Eigen::VectorXd offset; ///< from the mean
    Eigen::MatrixXd field;  ///< heights about it for independent unit normal numbers
};

} // namespace

Eigen::MatrixXd draw_fields(const Surface& surface, const Eigen::Matrix2Xd& xy, int draws, std::uint64_t seed)
{
    const Eigen::VectorXd mean = heights(surface, xy).array() - surface.shift;
    std::vector<Possible> all;
    double sum = 0;
    if (surface.precision) {
        const Eigen::MatrixXd covariance = height_covariance(std::get<Bspline>(surface.shape), *surface.precision, xy);
        all.push_back({1, Eigen::VectorXd::Zero(xy.cols()), root(covariance)});
        sum = 1;
    }
    for (const Member& member : members(surface)) {
        if (member.covariance.size() == 0) continue;
        const Eigen::MatrixXd gradients = height_gradients(member.shape, xy);
        const Eigen::VectorXd offset = heights(member.shape, xy) - mean;
        if (!gradients.allFinite() || !offset.allFinite()) continue;
        all.push_back({member.weight, offset, field_root(gradients, member.covariance)});
        sum += member.weight;
    }
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Eigen::MatrixXd fields = Eigen::MatrixXd::Zero(xy.cols(), draws);
    double due = 0;
    Eigen::Index column = 0;
    for (const Possible& one : all) {
        due += one.weight / sum * draws / 2;
        const Eigen::Index count = std::lround(due) - column / 2;
        Eigen::MatrixXd unit(one.field.cols(), count);
        for (double& number : unit.reshaped()) number = normal(random);
        const Eigen::MatrixXd about = one.field * unit;
        for (Eigen::Index k = 0; k < count; ++k) {
            const double noise = noise_ratio(surface.touch_freedom, random);
            fields.col(column++) = one.offset + noise * about.col(k);
            fields.col(column++) = one.offset - noise * about.col(k);
        }
    }
    return fields;
}

} // namespace fettle
