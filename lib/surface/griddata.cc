#include "surface/griddata.h"

#include <limits>

namespace fettle {

struct Griddata::Interpolant {};

Griddata make_griddata(const Eigen::Matrix3Xd& points, double spacing, double angle)
{
    return {points, spacing, angle, std::make_shared<const Griddata::Interpolant>()};
}

double height(const Griddata&, const Eigen::Vector2d&) { return std::numeric_limits<double>::quiet_NaN(); }

Eigen::VectorXd height_gradient(const Griddata& surface, const Eigen::Vector2d&)
{
    return Eigen::VectorXd::Constant(surface.points.cols(), std::numeric_limits<double>::quiet_NaN());
}

Eigen::VectorXi parameter_powers(const Griddata& surface)
{
    return Eigen::VectorXi::Constant(surface.points.cols(), 1);
}

} // namespace fettle
