#pragma once

#include "surface/surface.h"

#include <array>

namespace fettle {

// Each shape by itself (TensorBspline: surface/tensor_bspline.h; Griddata: surface/griddata.h). xy is in M, mm; NaN
// where the shape is not defined.

double height(const Plane& plane, const Eigen::Vector2d& xy);
double height(const Sphere& sphere, const Eigen::Vector2d& xy);
double height(const Cylinder& cylinder, const Eigen::Vector2d& xy);
double height(const Cone& cone, const Eigen::Vector2d& xy);
double height(const Torus& torus, const Eigen::Vector2d& xy);
double height(const Quadric& quadric, const Eigen::Vector2d& xy);
double height(const Polynomial& polynomial, const Eigen::Vector2d& xy);
double height(const Swept& swept, const Eigen::Vector2d& xy);
double height(const Bspline& bspline, const Eigen::Vector2d& xy);

/// (∂z/∂x, ∂z/∂y)
Eigen::Vector2d slope(const Plane& plane, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const Sphere& sphere, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const Cylinder& cylinder, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const Cone& cone, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const Torus& torus, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const Quadric& quadric, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const Polynomial& polynomial, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const Swept& swept, const Eigen::Vector2d& xy);
Eigen::Vector2d slope(const Bspline& bspline, const Eigen::Vector2d& xy);

/// ∂z/∂θ
Eigen::VectorXd height_gradient(const Plane& plane, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const Sphere& sphere, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const Cylinder& cylinder, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const Cone& cone, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const Torus& torus, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const Quadric& quadric, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const Polynomial& polynomial, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const Swept& swept, const Eigen::Vector2d& xy);
Eigen::VectorXd height_gradient(const Bspline& bspline, const Eigen::Vector2d& xy);

/// Powers of length in the dimensions of θ.
Eigen::VectorXi parameter_powers(const Plane& plane);
Eigen::VectorXi parameter_powers(const Sphere& sphere);
Eigen::VectorXi parameter_powers(const Cylinder& cylinder);
Eigen::VectorXi parameter_powers(const Cone& cone);
Eigen::VectorXi parameter_powers(const Torus& torus);
Eigen::VectorXi parameter_powers(const Quadric& quadric);
Eigen::VectorXi parameter_powers(const Polynomial& polynomial);
Eigen::VectorXi parameter_powers(const Swept& swept);
Eigen::VectorXi parameter_powers(const Bspline& bspline);

/// The sphere with this centre, about its highest (convex) or lowest (concave) point.
Sphere sphere_about(const Eigen::Vector3d& centre, double radius, bool convex);
/// The cylinder with this axis (not vertical), about its highest or lowest point next to `on_axis`.
Cylinder cylinder_about(const Eigen::Vector3d& on_axis, const Eigen::Vector3d& axis, double radius, bool convex);

/// Coefficients of a polynomial in x and y of that total degree.
Eigen::Index monomials(int degree);
int degree(const Polynomial& polynomial);

/// Infinite for a flat piece.
template <typename Round>
double radius(const Round& round)
{
    return 1 / std::abs(round.curvature);
}
/// Centre of a sphere; the point of a cylinder's axis beneath or above `point`.
template <typename Round>
Eigen::Vector3d centre(const Round& round)
{
    return round.point - round.normal / round.curvature;
}

/// Two unit tangents that make a right-handed frame with an upward normal; the first has no y.
std::array<Eigen::Vector3d, 2> tangents(const Eigen::Vector3d& normal);

/// Basis functions of a cell that do not vanish over xy: the control height (i, j) weighs u[i - row] · v[j - column].
struct BsplineWeights {
    Eigen::Index row = 0;
    Eigen::Index column = 0;
    Eigen::Vector4d u, v;   ///< values
    Eigen::Vector4d du, dv; ///< first derivatives, 1/mm
};
/// Nothing outside the rectangle.
std::optional<BsplineWeights> weights(const Bspline& bspline, const Eigen::Vector2d& xy);

} // namespace fettle
