#include "core/constants.h"
#include "surface/basis.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

namespace fettle::surface {

namespace {

// Relative to a cell: rounding must not place a point on the rectangle's edge outside.
constexpr double kEdgeTolerance = 1e-9;

} // namespace

std::optional<BsplineWeights> weights(const Bspline& bspline, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d uv = (Eigen::Rotation2Dd(-bspline.angle) * (xy - bspline.origin)).cwiseQuotient(bspline.cell);
    const Eigen::Vector2d cells(bspline.heights.rows() - 3, bspline.heights.cols() - 3);
    if (!((uv.array() >= -kEdgeTolerance).all() && (uv.array() <= cells.array() + kEdgeTolerance).all()))
        return std::nullopt;
    const Eigen::Vector2d corner = uv.array().floor().max(0).min(cells.array() - 1);
    const Eigen::Vector2d f = uv - corner;
    return BsplineWeights{static_cast<Eigen::Index>(corner.x()),
                          static_cast<Eigen::Index>(corner.y()),
                          uniform_cubic_basis(f.x()),
                          uniform_cubic_basis(f.y()),
                          uniform_cubic_basis(f.x(), 1) / bspline.cell.x(),
                          uniform_cubic_basis(f.y(), 1) / bspline.cell.y()};
}

double height(const Bspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<BsplineWeights> w = weights(bspline, xy);
    if (!w) return core::kNaN;
    return w->u.dot(bspline.heights.block<4, 4>(w->row, w->column) * w->v);
}

Eigen::Vector2d slope(const Bspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<BsplineWeights> w = weights(bspline, xy);
    if (!w) return Eigen::Vector2d::Constant(core::kNaN);
    const Eigen::Matrix4d heights = bspline.heights.block<4, 4>(w->row, w->column);
    return Eigen::Rotation2Dd(bspline.angle) * Eigen::Vector2d(w->du.dot(heights * w->v), w->u.dot(heights * w->dv));
}

Eigen::VectorXd height_gradient(const Bspline& bspline, const Eigen::Vector2d& xy)
{
    const std::optional<BsplineWeights> w = weights(bspline, xy);
    if (!w) return Eigen::VectorXd::Constant(bspline.heights.size(), core::kNaN);
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(bspline.heights.rows(), bspline.heights.cols());
    gradient.block<4, 4>(w->row, w->column) = w->u * w->v.transpose();
    return gradient.reshaped();
}

} // namespace fettle::surface
