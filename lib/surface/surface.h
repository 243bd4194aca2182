#pragma once

#include "job/job.h"
#include "json/document.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace fettle {

// Every shape is a height z(x, y) over the machine frame M, mm, with parameters θ. For each shape there are
//   double height(const Shape&, const Eigen::Vector2d& xy)             NaN where it is not defined
//   Eigen::VectorXd height_gradient(const Shape&, const Eigen::Vector2d& xy)     ∂z/∂θ
//   Eigen::VectorXi parameter_powers(const Shape&)    dimension of each θ, as a power of length
// so that the covariance of θ gives the standard deviation of the height at any point: σ² = gᵀ C g.

/// z = z0 + a (x - x0) + b (y - y0).   θ = (z0, a, b)
struct Plane {
    Eigen::Vector2d origin; ///< x0, y0
    double z0 = 0;
    Eigen::Vector2d slope; ///< a, b
};

/// A piece of a sphere about a point of it, by its curvature (Lukács, Martin and Marshall 1998), so that a nearly flat
/// piece stays well conditioned:  k/2 |d|² + n·d = 0 with d = x - point. k = 0 is the plane.
/// θ = (offset along n, tilts of n to tangents[0] and tangents[1], k)
struct Sphere {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal: up
    double curvature = 0;   ///< 1/mm; > 0: convex (the metal is inside the sphere), < 0: concave
};

/// A piece of a cylinder, likewise:  k/2 (|d|² - (a·d)²) + n·d = 0.
/// θ = (offset along n, tilt of n across the axis, tilt of n and a along it, turn of a about n, k)
struct Cylinder {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal: up
    Eigen::Vector3d axis;   ///< unit, along the axis, perpendicular to `normal`
    double curvature = 0;   ///< 1/mm; > 0: convex, < 0: concave
};

/// Straight swept surface (Wang 2007, 4.4.2): a cubic section curve carried along a ruling line. With t the distance
/// along the ruling and s across it, both in x-y from `origin`:  z = Σ c_k (s/scale)^k + slope · t.   θ = (c_0..c_3,
/// slope)
struct Swept {
    Eigen::Vector2d origin;
    Eigen::Vector2d ruling;                     ///< unit, x-y direction of the rulings
    double scale = 1;                           ///< mm
    Eigen::Vector4d section;                    ///< c_k, mm
    double slope = 0;                           ///< dz/dt of the ruling line
    double section_least = 0, section_most = 0; ///< the s that were touched; outside, the section is extrapolated
};

/// Tensor-product cubic B-spline height field over a rectangle turned by `angle`; knots uniform. Not defined outside
/// the rectangle. θ = control heights, column-major.
struct Bspline {
    double angle = 0;        ///< rad, from X_m to the grid's u axis
    Eigen::Vector2d origin;  ///< M, corner of the first cell
    Eigen::Vector2d cell;    ///< sides of a cell, mm
    Eigen::MatrixXd heights; ///< control heights, (cells_u + 3) x (cells_v + 3), mm
};

/// Tensor-product B-spline height field with knots of its own, over the rectangle that they span. The knots are places
/// along u and v, the axes of M turned by `angle`; the degrees follow from the numbers of knots and heights. Not
/// defined outside the rectangle. θ = control heights, column-major.
struct TensorBspline {
    double angle = 0;                 ///< rad, from X_m to u
    Eigen::VectorXd knots_u, knots_v; ///< ascending, each end degree + 1 times, mm
    Eigen::MatrixXd heights;          ///< control heights, rows along u, mm
};

/// Wang's modified griddata (2007, fig. 4-6): C1 cubic interpolation over the Delaunay triangles of the points, sampled
/// uniformly and interpolated again. Defined inside the convex hull of the points. θ = the points' z.
struct Griddata {
    Eigen::Matrix3Xd points; ///< samples and estimated points, M
    double spacing = 0;      ///< of the uniform sampling, mm; 0: interpolated once
    double angle = 0;        ///< of the uniform grid against X_m, rad
    struct Interpolant;      ///< triangulations and gradients, made once
    std::shared_ptr<const Interpolant> interpolant;
};

using Shape = std::variant<Plane, Sphere, Cylinder, Swept, Bspline, TensorBspline, Griddata>;

/// What the margin foresees (fettle-margin), mm.
struct Prediction {
    std::string method;    ///< "posterior" or "wang"
    double confidence = 0; ///< of the whole of B at once; 0 for Wang's regressions
    double band = 0;       ///< predicted error band (Wang 2007, eq. 4-1)
    double shift = 0;      ///< by which the surface was raised
    bool clamped = false;  ///< the regression fell below the probe's accuracy, which was used instead
};

/// The desired surface beneath the anomaly, with how it came about.
struct Surface {
    Units units; ///< of its file
    Shape shape;
    double shift = 0;           ///< added to the shape's height, mm
    std::string method;         ///< that fitted it
    Eigen::MatrixXd covariance; ///< of θ, from the touch error; empty if unknown
    double touch_sigma = 0;     ///< standard deviation of one touch that the covariance rests on, mm
    double rms = 0;             ///< of the residuals, vertical, mm
    double goodness = 0;        ///< p-value of χ² of the residuals against touch_sigma
    Eigen::Matrix3Xd touches;   ///< used, M, mm
    Eigen::VectorXi roles;      ///< of the touches
    int ignored = 0;            ///< touches given but not used (estimated points in a statistical fit, NaN)
    std::optional<Prediction> prediction;
};

/// z of the (shifted) surface over xy, M; NaN where it is not defined.
double height(const Surface& surface, const Eigen::Vector2d& xy);
/// The same for many points, in parallel. @param xy  2xN
Eigen::VectorXd heights(const Surface& surface, const Eigen::Matrix2Xd& xy);
/// Upward unit normal.
Eigen::Vector3d normal(const Surface& surface, const Eigen::Vector2d& xy);
/// Standard deviation of the height; NaN if the covariance is unknown.
double sigma(const Surface& surface, const Eigen::Vector2d& xy);
/// ∂z/∂θ, one column a point: covariance of the heights is Gᵀ C G.
Eigen::MatrixXd height_gradients(const Shape& shape, const Eigen::Matrix2Xd& xy);
/// Dimension of each θ, as a power of length.
Eigen::VectorXi parameter_powers(const Shape& shape);

Surface read_surface(const std::string& path);
Surface parse_surface(json::Reader reader);
json::Value to_json(const Surface& surface);

} // namespace fettle
