#pragma once

#include "core/constants.h"
#include "job/job.h"
#include "json/document.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace fettle::surface {

// Every shape is a height z(x, y) in the machine frame M, mm, with parameters θ. For each shape there are
//   double height(const Shape&, const Eigen::Vector2d& xy)             NaN where it is not defined
//   Eigen::Vector2d slope(const Shape&, const Eigen::Vector2d& xy)               (∂z/∂x, ∂z/∂y)
//   Eigen::VectorXd height_gradient(const Shape&, const Eigen::Vector2d& xy)     ∂z/∂θ
// so that the covariance C of θ gives the standard deviation of the height at any point: σ² = gᵀ C g.

/// z = z0 + a (x - x0) + b (y - y0).   θ = (z0, a, b)
struct Plane {
    Eigen::Vector2d origin; ///< x0, y0
    double z0 = 0;
    Eigen::Vector2d slope; ///< a, b
};

/// Sphere parameterised at one of its points by its curvature k (Lukács, Martin and Marshall 1998), which is well
/// conditioned for nearly flat pieces:  k/2 |d|² + n·d = 0 with d = x - point. k = 0 is a plane.
/// θ = (offset along n, tilts of n to tangents[0] and tangents[1], k)
struct Sphere {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal, upward
    double curvature = 0;   ///< 1/mm; > 0: convex (the metal is inside the sphere), < 0: concave
};

/// Cylinder, parameterised like the sphere:  k/2 (|d|² - (a·d)²) + n·d = 0.
/// θ = (offset along n, tilt of n across the axis, tilt of n and a along it, turn of a about n, k)
struct Cylinder {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal, upward
    Eigen::Vector3d axis;   ///< unit, along the axis, perpendicular to `normal`
    double curvature = 0;   ///< 1/mm; > 0: convex, < 0: concave
};

/// Cone parameterised at one of its points. The axis of revolution w is inclined by `lean` (half the opening angle)
/// from the ruling `axis` towards the outside of the metal; the distance of the point from it is 1/around:
///     w = sin(lean) normal + cos(lean) axis;   lean = 0 is the cylinder of curvature `around`.
/// θ = (offset along n, tilt of n across the ruling (towards normal × axis), tilt of n and ruling along it, turn of the
/// ruling about n, around, lean)
struct Cone {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal, upward
    Eigen::Vector3d axis;   ///< unit, along the ruling, perpendicular to `normal`
    double curvature_around =
        0;           ///< curvature around the axis, 1/mm; > 0: the axis of revolution is on the metal's side
    double lean = 0; ///< from the ruling to the axis of revolution, rad
};

/// Torus, parameterised like the cone: the profile that is revolved is a circle of curvature `along`. lean = 0 and
/// equal curvatures give a sphere.   θ = (those of the cone, along)
struct Torus {
    Eigen::Vector3d point;       ///< on the surface, M
    Eigen::Vector3d normal;      ///< unit, out of the metal, upward
    Eigen::Vector3d axis;        ///< unit, along the profile at the point, perpendicular to `normal`
    double curvature_around = 0; ///< curvature around the axis, 1/mm
    double lean = 0;             ///< from the profile's tangent to the axis of revolution, rad
    double curvature_along = 0;  ///< curvature of the profile, 1/mm; > 0: convex
};

/// General quadric, parameterised like the sphere:  ½ dᵀ A d + n·d = 0: ellipsoids, hyperboloids, paraboloids, cones
/// and cylinders. A = u nᵀ + n uᵀ gives a plane. θ = (offset along n, tilts of n to tangents(n)[0] and [1], A_00, A_10,
/// A_11, A_20, A_21, A_22 in that frame, n last)
struct Quadric {
    Eigen::Vector3d point;  ///< on the surface, M
    Eigen::Vector3d normal; ///< unit, out of the metal, upward
    Eigen::Matrix3d form;   ///< A, symmetric, M, 1/mm; uᵀ A u > 0: convex along the tangent u
};

/// z = Σ c_ij u^i v^j with (u, v) = (xy - origin) / scale; by total degree, then by decreasing powers of u: 1, u, v,
/// u², uv, v², …   θ = the coefficients.
struct Polynomial {
    Eigen::Vector2d origin;
    double scale = 1;             ///< mm
    Eigen::VectorXd coefficients; ///< mm; those of a complete polynomial of some total degree
};

/// Straight swept surface (Wang 2007, 4.4.2): a cubic section curve swept along a straight ruling line. With t the
/// distance along the ruling and s across it, both in x-y from `origin`:  z = Σ c_k (s/scale)^k + slope · t.
/// θ = (c_0..c_3, slope)
struct Swept {
    Eigen::Vector2d origin;
    Eigen::Vector2d ruling;                  ///< unit, x-y direction of the rulings
    double scale = 1;                        ///< mm
    Eigen::Vector4d section;                 ///< c_k, mm
    double slope = 0;                        ///< dz/dt of the rulings
    double section_min = 0, section_max = 0; ///< range of s of the touches, mm; outside, the section is extrapolated
};

/// Tensor-product cubic B-spline height field with uniform knots over a rectangle rotated by `angle`. Not defined
/// outside the rectangle. θ = control heights, column-major.
struct Bspline {
    double angle = 0;        ///< rad, from X_m to the grid's u axis
    Eigen::Vector2d origin;  ///< corner of the first cell, M, mm
    Eigen::Vector2d cell;    ///< sides of a cell, mm
    Eigen::MatrixXd heights; ///< control heights, (cells_u + 3) x (cells_v + 3), mm
};

/// Tensor-product B-spline height field with arbitrary knots over the rectangle that they span. The knots are
/// coordinates along u and v, the axes of M rotated by `angle`; the degrees follow from the numbers of knots and
/// heights. Not defined outside the rectangle. θ = control heights, column-major.
struct TensorBspline {
    double angle = 0;                 ///< rad, from X_m to u
    Eigen::VectorXd knots_u, knots_v; ///< ascending, end knots degree + 1 times, mm
    Eigen::MatrixXd heights;          ///< control heights, rows along u, mm
};

/// Wang's modified griddata (2007, fig. 4-6): C1 cubic interpolation over the Delaunay triangulation of the points,
/// sampled uniformly and interpolated again. Not defined outside the convex hull of the points. θ = the points' z.
struct Griddata {
    Eigen::Matrix3Xd points; ///< samples and estimated points, M, mm
    double spacing = 0;      ///< spacing of the uniform sampling, mm; 0: no second interpolation
    double angle = 0;        ///< angle of the uniform grid from X_m, rad
    struct Interpolant;      ///< triangulations and gradients, computed once
    std::shared_ptr<const Interpolant> interpolant;
};

using Shape =
    std::variant<Plane, Sphere, Cylinder, Cone, Torus, Quadric, Polynomial, Swept, Bspline, TensorBspline, Griddata>;

/// Precision (inverse covariance) of a spline with too many control heights for a covariance (surface/precision.h).
struct SplinePrecision {
    Eigen::MatrixXd weights; ///< Σ 1/σ² of the points in each cell, cells_u x cells_v, 1/mm²
    double amplitude = 0;    ///< τ of the prior random field, 1/mm
};

/// Predicted error band and shift of a surface (fettle-margin), mm.
struct Prediction {
    std::string method;    ///< "posterior" or "wang"
    double confidence = 0; ///< joint confidence over all of B; 0 for Wang's regressions
    double band = 0;       ///< predicted error band (Wang 2007, eq. 4-1)
    double shift = 0;      ///< height by which the surface was raised
    bool clamped = false;  ///< the regression fell below the probe's accuracy, which was used instead
};

/// A less probable shape that was fitted to the same touches.
struct Alternative {
    std::string method;         ///< fit method
    double score = 0;           ///< information criterion (fit/family.h)
    double weight = 0;          ///< its probability; 0: negligible, and no shape is stored
    Shape shape;                ///< see Surface
    Eigen::MatrixXd covariance; ///< see Surface
};

/// The desired surface beneath the anomaly and the results of its fit. Where several shapes explain the touches about
/// equally well, it is their mean weighted by probability, and its standard deviation includes their differences.
struct Surface {
    units::Units units;                       ///< units of its file
    Shape shape;                              ///< the most probable shape
    double shift = 0;                         ///< added to the height, mm
    std::string method;                       ///< fit method
    Eigen::MatrixXd covariance;               ///< covariance of θ due to the touch error; empty if unknown
    std::optional<SplinePrecision> precision; ///< for a spline instead of the covariance
    double score = 0;                         ///< information criterion, if there are alternatives
    double weight = 1;                        ///< probability of `shape`
    std::vector<Alternative> alternatives;    ///< their weights and `weight` sum up to 1
    double touch_sigma = 0;                   ///< standard deviation of one touch, used for the covariance, mm
    double touch_sigma_dof = core::kInfinity; ///< degrees of freedom of touch_sigma if estimated from the residuals;
                                              ///< infinite if it is known
    double rms = 0;                           ///< root mean square of the vertical residuals, mm
    double goodness = 0;                      ///< p-value of the χ² test of the residuals against touch_sigma
    Eigen::Matrix3Xd touches;                 ///< the touches of the fit, M, mm
    Eigen::VectorXi roles;                    ///< Role of each touch (sampling/touch_plan.h)
    std::vector<Eigen::Index> outliers;       ///< outliers: columns of `touches` that the fit left out
    int ignored = 0;                          ///< number of unused touches (estimated points in a statistical fit, NaN)
    std::optional<Prediction> prediction;
};

/// z of the shifted surface over xy, M, mm; NaN where `shape` is not defined. Alternatives that are not defined there
/// are left out of the mean.
double height(const Surface& surface, const Eigen::Vector2d& xy);
/// Heights over many points, in parallel. @param xy  2xN, M, mm
Eigen::VectorXd heights(const Surface& surface, const Eigen::Matrix2Xd& xy);
/// Upward unit normal.
Eigen::Vector3d normal(const Surface& surface, const Eigen::Vector2d& xy);
/// Is the standard deviation of the height that of its error? It is with a precision, or with the covariance of a fit
/// that allows for what the touches leave open. Interpolants (griddata, tensor-bspline) go through every touch: their
/// covariance holds the touches' noise alone, and they are mostly wrong by much more between the touches.
bool has_sigma(const Surface& surface);
/// True if the surface has a covariance, but is an interpolant.
bool has_touch_noise_only(const Surface& surface);
/// Standard deviation of the height by covariance or precision, mm; NaN if there is none, or the surface is not
/// defined. See has_sigma() for what it means.
double sigma(const Surface& surface, const Eigen::Vector2d& xy);
/// Standard deviations over many points, in parallel. @param xy  2xN, M, mm
Eigen::VectorXd sigmas(const Surface& surface, const Eigen::Matrix2Xd& xy);

/// One of the shapes whose weighted mean is the surface.
struct WeightedShape {
    double weight;
    const Shape& shape;
    const Eigen::MatrixXd& covariance;
};
/// `shape` first, then the alternatives with a positive weight.
std::vector<WeightedShape> weighted_shapes(const Surface& surface);

/// ∂z/∂θ, one column per point: the covariance of the heights is Gᵀ C G.
Eigen::MatrixXd height_gradients(const Shape& shape, const Eigen::Matrix2Xd& xy);
/// Heights of one shape, without shift.
Eigen::VectorXd heights(const Shape& shape, const Eigen::Matrix2Xd& xy);
/// Dimension of each θ as a power of length.
Eigen::VectorXi parameter_powers(const Shape& shape);

/// Reads a surface file ("-": stdin). @throws InputError that names the key's path
Surface read_surface(const std::string& path);
/// Parses a surface from a JSON object (a plan contains its surface).
Surface parse_surface(json::Reader reader);
json::Value to_json(const Surface& surface);

} // namespace fettle::surface
