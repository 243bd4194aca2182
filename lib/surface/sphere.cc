#include "surface/quadratic.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

namespace fettle::surface {

// The surface is F(x; θ) = k/2 |d|² + n·d = 0, d = x - p, and F increases upward. Along a vertical line d = d0 + t e_z
// it is a parabola in t. By implicit differentiation ∂z/∂θ = -F_θ / F_z and ∂z/∂x = -F_x / F_z.

namespace {

Eigen::Vector3d offset(const Sphere& sphere, const Eigen::Vector2d& xy)
{
    const double k = sphere.curvature;
    Eigen::Vector3d d(xy.x() - sphere.point.x(), xy.y() - sphere.point.y(), 0);
    d.z() = increasing_root(k / 2, sphere.normal.z(), k / 2 * d.squaredNorm() + sphere.normal.dot(d));
    return d;
}

} // namespace

double height(const Sphere& sphere, const Eigen::Vector2d& xy) { return sphere.point.z() + offset(sphere, xy).z(); }

Eigen::Vector2d slope(const Sphere& sphere, const Eigen::Vector2d& xy)
{
    const Eigen::Vector3d gradient_of_F = sphere.curvature * offset(sphere, xy) + sphere.normal;
    return -gradient_of_F.head<2>() / gradient_of_F.z();
}

Eigen::VectorXd height_gradient(const Sphere& sphere, const Eigen::Vector2d& xy)
{
    const Eigen::Vector3d d = offset(sphere, xy);
    const std::array<Eigen::Vector3d, 2> t = tangents(sphere.normal);
    const double k = sphere.curvature;
    const Eigen::Vector4d F_theta(-k * sphere.normal.dot(d) - 1, t[0].dot(d), t[1].dot(d), d.squaredNorm() / 2);
    return -F_theta / (k * d.z() + sphere.normal.z());
}

std::array<Eigen::Vector3d, 2> tangents(const Eigen::Vector3d& normal)
{
    const Eigen::Vector3d first = Eigen::Vector3d(normal.z(), 0, -normal.x()).normalized();
    return {first, normal.cross(first)};
}

Sphere sphere_from_centre(const Eigen::Vector3d& centre, double radius, bool convex)
{
    const double side = convex ? 1 : -1;
    return {centre + side * radius * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ(), side / radius};
}

} // namespace fettle::surface
