#pragma once

#include "surface/surface.h"

#include <array>

namespace fettle::surface {

// Functions of each shape (TensorBspline: surface/tensor_bspline.h; Griddata: surface/griddata.h). xy is in M, mm;
// results are NaN where the shape is not defined.

/// z, M, mm
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

/// The sphere with this centre; its `point` is the highest (convex) or the lowest (concave) one.
Sphere sphere_from_centre(const Eigen::Vector3d& centre, double radius, bool convex);
/// The cylinder with this axis (not vertical); its `point` is the highest or the lowest one at `on_axis`.
Cylinder cylinder_from_axis(const Eigen::Vector3d& on_axis, const Eigen::Vector3d& axis, double radius, bool convex);

/// Number of coefficients of a complete polynomial in x and y of that total degree.
Eigen::Index monomial_count(int degree);
/// Total degree.
int degree(const Polynomial& polynomial);

/// Two unit tangents that form a right-handed frame with an upward normal; the first has y = 0.
std::array<Eigen::Vector3d, 2> tangents(const Eigen::Vector3d& normal);

/// Basis functions that do not vanish at xy: control height (i, j) has the weight u[i - row] · v[j - column].
struct BsplineWeights {
    Eigen::Index row = 0;
    Eigen::Index column = 0;
    Eigen::Vector4d u, v;   ///< values
    Eigen::Vector4d du, dv; ///< first derivatives, 1/mm
};
/// @return  nothing outside the rectangle
std::optional<BsplineWeights> weights(const Bspline& bspline, const Eigen::Vector2d& xy);

} // namespace fettle::surface
