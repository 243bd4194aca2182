#include "surface/quadratic.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

namespace fettle::surface {

// F(x; θ) = k/2 (|d|² - (a·d)²) + n·d, d = x - p. See sphere.cc; only the component of d across the axis is curved.

namespace {

Eigen::Vector3d offset(const Cylinder& cylinder, const Eigen::Vector2d& xy)
{
    const double k = cylinder.curvature;
    const Eigen::Vector3d& a = cylinder.axis;
    Eigen::Vector3d d(xy.x() - cylinder.point.x(), xy.y() - cylinder.point.y(), 0);
    const double along = a.dot(d);
    d.z() = increasing_root(k / 2 * (1 - a.z() * a.z()), cylinder.normal.z() - k * along * a.z(),
                            k / 2 * (d.squaredNorm() - along * along) + cylinder.normal.dot(d));
    return d;
}

Eigen::Vector3d gradient_of_F(const Cylinder& cylinder, const Eigen::Vector3d& d)
{
    return cylinder.curvature * (d - cylinder.axis.dot(d) * cylinder.axis) + cylinder.normal;
}

} // namespace

double height(const Cylinder& cylinder, const Eigen::Vector2d& xy)
{
    return cylinder.point.z() + offset(cylinder, xy).z();
}

Eigen::Vector2d slope(const Cylinder& cylinder, const Eigen::Vector2d& xy)
{
    const Eigen::Vector3d gradient = gradient_of_F(cylinder, offset(cylinder, xy));
    return -gradient.head<2>() / gradient.z();
}

Eigen::VectorXd height_gradient(const Cylinder& cylinder, const Eigen::Vector2d& xy)
{
    const Eigen::Vector3d d = offset(cylinder, xy);
    const double k = cylinder.curvature;
    const double along = cylinder.axis.dot(d);
    const double across = cylinder.axis.cross(cylinder.normal).dot(d);
    const double up = cylinder.normal.dot(d);
    Eigen::VectorXd F_theta(5);
    F_theta << -k * up - 1, across, -along * (1 + k * up), -k * along * across, (d.squaredNorm() - along * along) / 2;
    return -F_theta / gradient_of_F(cylinder, d).z();
}

Cylinder cylinder_from_axis(const Eigen::Vector3d& on_axis, const Eigen::Vector3d& axis, double radius, bool convex)
{
    const Eigen::Vector3d a = axis.normalized();
    const Eigen::Vector3d up = (Eigen::Vector3d::UnitZ() - a.z() * a).normalized();
    const double side = convex ? 1 : -1;
    return {on_axis + side * radius * up, up, a, side / radius};
}

} // namespace fettle::surface
