#include "surface/quadratic.h"
#include "surface/shapes.h"

namespace fettle::surface {

// F(x; θ) = ½ dᵀ A d + n·d, d = x - p. See sphere.cc; a sphere has A = k I.

namespace {

Eigen::Vector3d offset(const Quadric& quadric, const Eigen::Vector2d& xy)
{
    Eigen::Vector3d d(xy.x() - quadric.point.x(), xy.y() - quadric.point.y(), 0);
    const Eigen::Vector3d Ad = quadric.form * d;
    d.z() = increasing_root(quadric.form(2, 2) / 2, quadric.normal.z() + Ad.z(), d.dot(Ad) / 2 + quadric.normal.dot(d));
    return d;
}

Eigen::Vector3d gradient_of_F(const Quadric& quadric, const Eigen::Vector3d& d)
{
    return quadric.form * d + quadric.normal;
}

} // namespace

double height(const Quadric& quadric, const Eigen::Vector2d& xy) { return quadric.point.z() + offset(quadric, xy).z(); }

Eigen::Vector2d slope(const Quadric& quadric, const Eigen::Vector2d& xy)
{
    const Eigen::Vector3d gradient = gradient_of_F(quadric, offset(quadric, xy));
    return -gradient.head<2>() / gradient.z();
}

Eigen::VectorXd height_gradient(const Quadric& quadric, const Eigen::Vector2d& xy)
{
    const Eigen::Vector3d d = offset(quadric, xy);
    const Eigen::Vector3d gradient = gradient_of_F(quadric, d);
    const std::array<Eigen::Vector3d, 2> t = tangents(quadric.normal);
    const Eigen::Vector3d e(t[0].dot(d), t[1].dot(d), quadric.normal.dot(d));
    Eigen::VectorXd F_theta(9);
    F_theta << -quadric.normal.dot(gradient), e[0], e[1], e[0] * e[0] / 2, e[1] * e[0], e[1] * e[1] / 2, e[2] * e[0],
        e[2] * e[1], e[2] * e[2] / 2;
    return -F_theta / gradient.z();
}

} // namespace fettle::surface
