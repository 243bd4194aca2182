#include "surface/shapes.h"

namespace fettle::surface {

double height(const Plane& plane, const Eigen::Vector2d& xy) { return plane.z0 + plane.slope.dot(xy - plane.origin); }

Eigen::Vector2d slope(const Plane& plane, const Eigen::Vector2d&) { return plane.slope; }

Eigen::VectorXd height_gradient(const Plane& plane, const Eigen::Vector2d& xy)
{
    return Eigen::Vector3d(1, xy.x() - plane.origin.x(), xy.y() - plane.origin.y());
}

} // namespace fettle::surface
