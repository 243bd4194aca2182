#pragma once

#include "compare/form_element.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace fettle::compare {

/// A form error: the width of the zone between two elements, parallel or coaxial or concentric, that holds all points.
struct FormZone {
    double width = 0;                   ///< mm
    FormElement element;                ///< least squares: the fitted element; minimum zone: the middle of the zone
    std::vector<Eigen::Index> contacts; ///< minimum zone: columns of the points that touch either side and determine it
    double peak = 0;                    ///< largest deviation above (outside) the element, mm
    double valley = 0;                  ///< largest deviation below (inside) it, positive, mm
    double rms = 0;                     ///< of the deviations, mm
    bool converged = false;
};

struct Form {
    FormZone least_squares; ///< zone about the least squares element of the orthogonal distances
    FormZone minimum_zone;  ///< the narrowest zone near it
};

/// Flatness (ISO 12781), cylindricity (ISO 12180), sphericity, or straightness in a section (ISO 12780); Wang
/// 2007, 6.2. No filter is applied and every point counts. The minimum zone is found from the least squares element by
/// a sequence of linear programmes; it is a local minimum: no small motion makes it narrower.
/// @param points   3xN, mm, finite
/// @param section  straightness: unit normal of the section plane, in which distances are taken; zero: the plane of
/// least squares of the points
/// @throws InputError if the points do not determine the element: too few, on a line, or without curvature
Form evaluate_form(FormKind kind, const Eigen::Matrix3Xd& points,
                   const Eigen::Vector3d& section = Eigen::Vector3d::Zero());

/// Columns of the points that are not outliers, by iteration: their deviation from the least squares element of these
/// same points is within `sigmas` robust standard deviations (1.4826 median |deviation|).
/// @throws InputError as form()
std::vector<Eigen::Index> without_outliers(FormKind kind, const Eigen::Matrix3Xd& points, double sigmas,
                                           const Eigen::Vector3d& section = Eigen::Vector3d::Zero());

/// "least_squares", "minimum_zone" and the elements, in `units`.
json::Value to_json(const Form& form, const Eigen::Matrix3Xd& points, const units::Units& units);

} // namespace fettle::compare
