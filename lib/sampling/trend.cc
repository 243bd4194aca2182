#include "sampling/trend.h"

#include "core/decompositions.h"

#include <cmath>

namespace fettle::sampling {

namespace {

// Powers of u and v of the terms.
std::vector<std::pair<int, int>> powers_of_terms(job::SurfaceType surface)
{
    switch (surface) {
    case job::SurfaceType::plane:
        return {{0, 0}, {1, 0}, {0, 1}};
    case job::SurfaceType::swept:
        return {{0, 0}, {1, 0}, {0, 1}, {0, 2}, {0, 3}};
    case job::SurfaceType::freeform:
        break;
    }
    return {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}};
}

} // namespace

Trend::Trend(const job::Job& job, const Eigen::Matrix3Xd& points)
    : powers_(powers_of_terms(job.surface)), rotation_(job::rotation_working_machine(job.theta + job.ruling_direction)),
      centre_(points.topRows<2>().rowwise().mean())
{
    const double extent = (points.topRows<2>().colwise() - centre_).cwiseAbs().maxCoeff();
    scale_ = extent > 0 ? extent : 1;
    Eigen::MatrixXd A(points.cols(), powers_.size());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector2d uv = scaled(points.col(i).head<2>());
        for (std::size_t k = 0; k < powers_.size(); ++k)
            A(i, k) = std::pow(uv.x(), powers_[k].first) * std::pow(uv.y(), powers_[k].second);
    }
    // The rank may be deficient: touches on too few lines.
    coefficients_ = core::min_norm_least_squares(A, points.row(2).transpose()).x;
}

Eigen::Vector2d Trend::scaled(const Eigen::Vector2d& xy) const { return rotation_ * (xy - centre_) / scale_; }

double Trend::height(const Eigen::Vector2d& xy) const
{
    const Eigen::Vector2d uv = scaled(xy);
    double z = 0;
    for (std::size_t k = 0; k < powers_.size(); ++k)
        z += coefficients_[k] * std::pow(uv.x(), powers_[k].first) * std::pow(uv.y(), powers_[k].second);
    return z;
}

Eigen::Vector2d Trend::gradient(const Eigen::Vector2d& xy) const
{
    const Eigen::Vector2d uv = scaled(xy);
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    for (std::size_t k = 0; k < powers_.size(); ++k) {
        const auto [i, j] = powers_[k];
        const double c = coefficients_[k];
        if (i > 0) slope.x() += c * i * std::pow(uv.x(), i - 1) * std::pow(uv.y(), j);
        if (j > 0) slope.y() += c * j * std::pow(uv.x(), i) * std::pow(uv.y(), j - 1);
    }
    return rotation_.transpose() * slope / scale_;
}

} // namespace fettle::sampling
