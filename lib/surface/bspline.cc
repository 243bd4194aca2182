#include "surface/shapes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

constexpr double kEdge = 1e-9; // of a cell: rounding of a point on the rectangle's edge does not put it outside

/// The four uniform cubic basis functions over a cell, f in [0, 1] (de Boor 1978, ch. X).
Eigen::Vector4d basis(double f)
{
    const double g = 1 - f;
    return Eigen::Vector4d(g * g * g, 4 - 6 * f * f + 3 * f * f * f, 4 - 6 * g * g + 3 * g * g * g, f * f * f) / 6;
}

Eigen::Vector4d basis_slope(double f)
{
    const double g = 1 - f;
    return Eigen::Vector4d(-g * g, 3 * f * f - 4 * f, 4 * g - 3 * g * g, f * f) / 2;
}

} // namespace

std::optional<BsplineWeights> weights(const Bspline& bspline, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d uv = (Eigen::Rotation2Dd(-bspline.angle) * (xy - bspline.origin)).cwiseQuotient(bspline.cell);
    const Eigen::Vector2d cells(static_cast<double>(bspline.heights.rows() - 3),
                                static_cast<double>(bspline.heights.cols() - 3));
    if (!((uv.array() >= -kEdge).all() && (uv.array() <= cells.array() + kEdge).all())) return std::nullopt;
    const Eigen::Vector2d corner = uv.array().floor().max(0).min(cells.array() - 1);
    const Eigen::Vector2d f = uv - corner;
    return BsplineWeights{
        static_cast<Eigen::Index>(corner.x()), static_cast<Eigen::Index>(corner.y()), basis(f.x()), basis(f.y()),
        basis_slope(f.x()) / bspline.cell.x(), basis_slope(f.y()) / bspline.cell.y()};
}

double height(const Bspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<BsplineWeights> w = weights(bspline, xy);
    if (!w) return std::numeric_limits<double>::quiet_NaN();
    return w->u.dot(bspline.heights.block<4, 4>(w->row, w->column) * w->v);
}

Eigen::Vector2d slope(const Bspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<BsplineWeights> w = weights(bspline, xy);
    if (!w) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    const Eigen::Matrix4d heights = bspline.heights.block<4, 4>(w->row, w->column);
    return Eigen::Rotation2Dd(bspline.angle) * Eigen::Vector2d(w->du.dot(heights * w->v), w->u.dot(heights * w->dv));
}

Eigen::VectorXd height_gradient(const Bspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<BsplineWeights> w = weights(bspline, xy);
    const double outside = std::numeric_limits<double>::quiet_NaN();
    if (!w) return Eigen::VectorXd::Constant(bspline.heights.size(), outside);
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(bspline.heights.rows(), bspline.heights.cols());
    gradient.block<4, 4>(w->row, w->column) = w->u * w->v.transpose();
    return gradient.reshaped();
}

Eigen::VectorXi parameter_powers(const Bspline& bspline)
{
    return Eigen::VectorXi::Constant(bspline.heights.size(), 1);
}

} // namespace fettle
