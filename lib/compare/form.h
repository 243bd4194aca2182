#pragma once

#include "compare/form_element.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// A form error: the width of the zone between two elements, parallel or coaxial or concentric, that holds all points.
struct FormZone {
    double width = 0;                   ///< mm
    FormElement element;                ///< least squares: the fitted one; minimum zone: the middle of the zone
    std::vector<Eigen::Index> contacts; ///< minimum zone: columns of the points that hold it
    bool converged = false;
};

struct Form {
    FormZone least_squares; ///< zone about the element of least squares of the orthogonal distances
    FormZone minimum_zone;  ///< the narrowest zone near it
};

/// Flatness, cylindricity or sphericity (ISO 1101; W 2007, 6.2). The minimum zone follows from the least squares
/// element by a sequence of linear programmes; it is a zone that no small motion makes narrower.
/// @param points  3xN, mm, finite
/// @throws InputError if the points do not determine the element: too few, on a line, or without curvature
Form form(FormKind kind, const Eigen::Matrix3Xd& points);

/// "least_squares", "minimum_zone" and the elements, in `units`.
json::Value to_json(const Form& form, const Eigen::Matrix3Xd& points, const Units& units);

} // namespace fettle
