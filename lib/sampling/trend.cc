#include "sampling/trend.h"

#include "core/decompositions.h"

#include <Eigen/Dense>

#include <cmath>

namespace fettle {

namespace {

std::vector<std::pair<int, int>> terms(SurfaceType surface)
{
    switch (surface) {
    case SurfaceType::plane:
        return {{0, 0}, {1, 0}, {0, 1}};
    case SurfaceType::swept:
        return {{0, 0}, {1, 0}, {0, 1}, {0, 2}, {0, 3}};
    case SurfaceType::freeform:
        break;
    }
    return {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}};
}

} // namespace

Trend::Trend(const Job& job, const Eigen::Matrix3Xd& points)
    : powers_(terms(job.surface)), turn_(rotation_working_machine(job.theta + job.direction)),
      centre_(points.topRows<2>().rowwise().mean())
{
    const double extent = (points.topRows<2>().colwise() - centre_).cwiseAbs().maxCoeff();
    scale_ = extent > 0 ? extent : 1;
    Eigen::MatrixXd A(points.cols(), static_cast<Eigen::Index>(powers_.size()));
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector2d uv = scaled(points.col(i).head<2>());
        for (std::size_t k = 0; k < powers_.size(); ++k)
            A(i, static_cast<Eigen::Index>(k)) =
                std::pow(uv.x(), powers_[k].first) * std::pow(uv.y(), powers_[k].second);
    }
    // rank may fail: touches on too few lines
    coefficients_ = shortest_least_squares(A, points.row(2).transpose()).x;
}

Eigen::Vector2d Trend::scaled(const Eigen::Vector2d& xy) const { return turn_ * (xy - centre_) / scale_; }

double Trend::height(const Eigen::Vector2d& xy) const
{
    const Eigen::Vector2d uv = scaled(xy);
    double z = 0;
    for (std::size_t k = 0; k < powers_.size(); ++k)
        z += coefficients_[static_cast<Eigen::Index>(k)] * std::pow(uv.x(), powers_[k].first) *
             std::pow(uv.y(), powers_[k].second);
    return z;
}

Eigen::Vector2d Trend::gradient(const Eigen::Vector2d& xy) const
{
    const Eigen::Vector2d uv = scaled(xy);
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    for (std::size_t k = 0; k < powers_.size(); ++k) {
        const auto [i, j] = powers_[k];
        const double c = coefficients_[static_cast<Eigen::Index>(k)];
        if (i > 0) slope.x() += c * i * std::pow(uv.x(), i - 1) * std::pow(uv.y(), j);
        if (j > 0) slope.y() += c * j * std::pow(uv.x(), i) * std::pow(uv.y(), j - 1);
    }
    return turn_.transpose() * slope / scale_;
}

} // namespace fettle
