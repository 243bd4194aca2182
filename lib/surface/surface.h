#pragma once

#include "job/job.h"
#include "json/document.h"

#include <Eigen/Core>

#include <limits>
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

/// A piece of a cone about a point of it. The axis of revolution w leans by `lean` out of the metal from the ruling
/// `axis` there, and the point's distance from it is 1/around:
///     w = sin(lean) normal + cos(lean) axis;   lean = 0 is the cylinder of curvature `around`.
/// θ = (offset along n, tilt of n across the ruling (towards normal × axis), tilt of n and ruling along it, turn of the
/// ruling about n, around, lean)
struct Cone {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal: up
    Eigen::Vector3d axis;   ///< unit, along the ruling, perpendicular to `normal`
    double around = 0;      ///< 1/mm; > 0: the axis of revolution is on the metal's side
    double lean = 0;        ///< rad
};

/// A piece of a torus, likewise: the profile that turns about the axis is a circle of curvature `along`. With lean = 0
/// and equal curvatures it is a sphere.   θ = (those of the cone, along)
struct Torus {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal: up
    Eigen::Vector3d axis;   ///< unit, along the profile at the point, perpendicular to `normal`
    double around = 0;      ///< 1/mm
    double lean = 0;        ///< rad
    double along = 0;       ///< 1/mm; > 0: convex
};

/// A piece of any quadric about a point of it, as the sphere and the cylinder are:  ½ dᵀ A d + n·d = 0. Ellipsoids,
/// hyperboloids, paraboloids, cones and cylinders; A = u nᵀ + n uᵀ is the plane.
/// θ = (offset along n, tilts of n to tangents(n)[0] and [1], A_00, A_10, A_11, A_20, A_21, A_22 in that frame, n last)
struct Quadric {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal: up
    Eigen::Matrix3d form;   ///< A, symmetric, M, 1/mm; uᵀ A u > 0: convex along the tangent u
};

/// z = Σ c_ij u^i v^j with (u, v) = (xy - origin) / scale; by total degree, then with falling powers of u: 1, u, v, u²,
/// uv, v², …   θ = the coefficients.
struct Polynomial {
    Eigen::Vector2d origin;
    double scale = 1;             ///< mm
    Eigen::VectorXd coefficients; ///< mm; as many as a complete degree has
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

using Shape =
    std::variant<Plane, Sphere, Cylinder, Cone, Torus, Quadric, Polynomial, Swept, Bspline, TensorBspline, Griddata>;

/// What is known of a spline's height where its control heights are too many for a covariance (surface/precision.h).
struct SplinePrecision {
    Eigen::MatrixXd weights; ///< of the points in each cell, Σ 1/σ², cells_u x cells_v, 1/mm²
    double amplitude = 0;    ///< τ of the random field that the surface is where there are no points, 1/mm
};

/// What the margin foresees (fettle-margin), mm.
struct Prediction {
    std::string method;    ///< "posterior" or "wang"
    double confidence = 0; ///< of the whole of B at once; 0 for Wang's regressions
    double band = 0;       ///< predicted error band (Wang 2007, eq. 4-1)
    double shift = 0;      ///< by which the surface was raised
    bool clamped = false;  ///< the regression fell below the probe's accuracy, which was used instead
};

/// Another kind of surface that was fitted to the touches.
struct Alternative {
    std::string method;         ///< that fitted it
    double score = 0;           ///< information criterion (fit/family.h)
    double weight = 0;          ///< its probability; 0: too small to count, no shape is kept
    Shape shape;                ///< as below
    Eigen::MatrixXd covariance; ///< as below
};

/// The desired surface beneath the anomaly, with how it came about. Where several kinds of surface explain the touches
/// about as well, it is their mean by probability, and its standard deviation holds how they differ.
struct Surface {
    Units units;                              ///< of its file
    Shape shape;                              ///< the most probable one
    double shift = 0;                         ///< added to the height, mm
    std::string method;                       ///< that fitted it
    Eigen::MatrixXd covariance;               ///< of θ, from the touch error; empty if unknown
    std::optional<SplinePrecision> precision; ///< of a spline without covariance: its inverse
    double score = 0;                         ///< information criterion, if there was a choice
    double weight = 1;                        ///< probability of `shape`
    std::vector<Alternative> alternatives;    ///< weights and `weight` sum up to 1
    double touch_sigma = 0;                   ///< standard deviation of one touch that the covariance rests on, mm
    double touch_freedom = std::numeric_limits<double>::infinity(); ///< of touch_sigma where the residuals tell it;
                                                                    ///< else infinite: it is known
    double rms = 0;                                                 ///< of the residuals, vertical, mm
    double goodness = 0;                    ///< p-value of χ² of the residuals against touch_sigma
    Eigen::Matrix3Xd touches;               ///< used, M, mm
    Eigen::VectorXi roles;                  ///< of the touches
    std::vector<Eigen::Index> gross_errors; ///< columns of `touches` that were taken for slips and left out
    int ignored = 0;                        ///< touches given but not used (estimated points in a statistical fit, NaN)
    std::optional<Prediction> prediction;
};

/// z of the (shifted) surface over xy, M; NaN where `shape` is not defined (an alternative that is not stands back).
double height(const Surface& surface, const Eigen::Vector2d& xy);
/// The same for many points, in parallel. @param xy  2xN
Eigen::VectorXd heights(const Surface& surface, const Eigen::Matrix2Xd& xy);
/// Upward unit normal.
Eigen::Vector3d normal(const Surface& surface, const Eigen::Vector2d& xy);
/// Does it know its covariance or precision?
bool knows_sigma(const Surface& surface);
/// Standard deviation of the height; NaN if it is unknown or the surface not defined.
double sigma(const Surface& surface, const Eigen::Vector2d& xy);
/// The same for many points, in parallel. @param xy  2xN
Eigen::VectorXd sigmas(const Surface& surface, const Eigen::Matrix2Xd& xy);

/// One of the shapes that a surface is the mean of.
struct Member {
    double weight;
    const Shape& shape;
    const Eigen::MatrixXd& covariance;
};
/// `shape` first, then the alternatives that have a weight.
std::vector<Member> members(const Surface& surface);

/// ∂z/∂θ, one column a point: covariance of the heights is Gᵀ C G.
Eigen::MatrixXd height_gradients(const Shape& shape, const Eigen::Matrix2Xd& xy);
/// Heights of a shape by itself.
Eigen::VectorXd heights(const Shape& shape, const Eigen::Matrix2Xd& xy);
/// Dimension of each θ, as a power of length.
Eigen::VectorXi parameter_powers(const Shape& shape);

Surface read_surface(const std::string& path);
Surface parse_surface(json::Reader reader);
json::Value to_json(const Surface& surface);

} // namespace fettle
