#pragma once

#include "machining/cutter.h"
#include "mesh/mesh.h"
#include "json/document.h"

#include <limits>
#include <string>

namespace fettle::machining {

/// The properties of a design on which the step of a grid over it depends.
struct DesignShape {
    double convex_radius = std::numeric_limits<double>::infinity();  ///< smallest radius of convex curvature, mm
    double concave_radius = std::numeric_limits<double>::infinity(); ///< smallest radius of concave curvature, mm
    double slope = 0;                                                ///< steepest slope, rad, without walls
};

/// Estimates curvatures and slope from the facets that face up, by the angles at their edges. The results are 99 %
/// quantiles by area, so that a few sliver triangles have no effect. Edges sharper than 30 degrees are left out as
/// sharp edges of the design, facets steeper than 80 degrees because a height field does not show their errors.
/// @throws InputError if no facet faces up
DesignShape estimate_design_shape(const mesh::Mesh& design);

/// How the error is composed of e_s, the deviation of triangles from a curved surface, and e_p, the deviation of the
/// cutter between the points of the grid (Guan & Xiong, figure 3).
enum class ShapeKind { convex, concave, mixed };
std::string to_string(ShapeKind kind);
ShapeKind kind_of(const DesignShape& shape);

/// Step of a grid and its predicted errors.
struct Spacing {
    double step = 0; ///< R_x, mm
    ShapeKind kind = ShapeKind::mixed;
    double surface_error = 0;   ///< e_s at this step, mm
    double sampling_error = 0;  ///< e_p at this step, mm
    double predicted_error = 0; ///< their sum, mm; concave: the larger of both
};

/// The radius r of eq. 3, mm: the corner radius, or the radius of a flat or pointed cutter.
double sampling_radius(const Cutter& cutter);

/// The coarsest grid whose predicted error is within the tolerance: e_s by eq. 1, e_p = R_x²/(3 r) (eq. 3); convex and
/// mixed shapes take the sum, concave ones the larger. On a slope θ neighbours are farther apart: e_s depends on the
/// longest side of a triangle, the diagonal of a cell, R_x sec θ; e_p depends on the largest distance of a point from
/// its nearest neighbours, R_x √((1 + sec² θ)/2).
/// @param tolerance     mm, positive
/// @param radius        sampling_radius()
/// @param as_published  with the approximation of eq. 2, and without regard to slopes
Spacing spacing_for(double tolerance, double radius, const DesignShape& shape, bool as_published = false);

/// The report of fettle-mill; an infinite radius is null.
json::Value to_json(const Spacing& spacing, const DesignShape& shape);

} // namespace fettle::machining
