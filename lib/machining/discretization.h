#pragma once

#include "machining/cutter.h"
#include "mesh/mesh.h"
#include "json/document.h"

#include <limits>
#include <string>

namespace fettle {

/// What the spacing of a grid over a design depends on.
struct DesignShape {
    double convex_radius = std::numeric_limits<double>::infinity();  ///< smallest radius of curvature of bulges, mm
    double concave_radius = std::numeric_limits<double>::infinity(); ///< of hollows
    double slope = 0;                                                ///< steepest, rad; walls are left out
};

/// Estimates it from the facets that face up, by the angles at their edges. The roundest and steepest hundredth (of the
/// area) are left out, for what a few needles say; so are edges sharper than 30 degrees, which are no curvature, and
/// facets steeper than 80 degrees, whose errors are not known from above.
/// @throws InputError if nothing faces up
DesignShape shape_of(const Mesh& design);

/// How errors are made up of e_s, by which triangles stand off a curved surface, and e_p, by which the cutter stands
/// off it between the points of the grid (Guan & Xiong, figure 3).
enum class ShapeKind { convex, concave, mixed };
std::string to_string(ShapeKind kind);
ShapeKind kind_of(const DesignShape& shape);

struct Spacing {
    double step = 0; ///< R_x, mm
    ShapeKind kind = ShapeKind::mixed;
    double surface_error = 0;   ///< e_s at this step, mm
    double sampling_error = 0;  ///< e_p
    double predicted_error = 0; ///< their sum; concave: the larger
};

/// The radius r of eq. 3: of the cutter's ball or corner; of a flat or pointed one its own.
double sampling_radius(const Cutter& cutter);

/// The widest grid whose predicted error is no more than the tolerance: e_s by eq. 1, e_p = R_x²/(3 r) (eq. 3); convex
/// and mixed shapes take the sum, concave ones the larger. On a slope θ neighbours are farther apart. For e_s the
/// longest side of a triangle counts, a cell's diagonal: R_x sec θ; for e_p how far a place can be from the nearest
/// neighbours: R_x √((1 + sec² θ)/2).
/// @param as_published  with eq. 2's approximation, and without regard to slopes
/// @param tolerance  mm, positive
Spacing spacing_for(double tolerance, double radius, const DesignShape& shape, bool as_published = false);

/// As fettle-mill reports it; a radius that is not there is null.
json::Value to_json(const Spacing& spacing, const DesignShape& shape);

} // namespace fettle
