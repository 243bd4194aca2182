#pragma once

#include "compare/form_element.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace fettle {

/// A form error: the width of the zone between two elements, parallel or coaxial or concentric, that holds all points.
struct FormZone {
    double width = 0;                   ///< mm
    FormElement element;                ///< least squares: the fitted one; minimum zone: the middle of the zone
    std::vector<Eigen::Index> contacts; ///< minimum zone: columns of the points that hold it, touching either side
    double peak = 0;                    ///< mm: how far points lie above (outside) the element,
    double valley = 0;                  ///< and how far below (inside)
    double rms = 0;                     ///< mm, about the element
    bool converged = false;
};

struct Form {
    FormZone least_squares; ///< zone about the element of least squares of the orthogonal distances
    FormZone minimum_zone;  ///< the narrowest zone near it
};

/// Flatness (ISO 12781), cylindricity (ISO 12180), sphericity, or straightness in a section (ISO 12780); Wang
/// 2007, 6.2. No filter is applied and every point counts. The minimum zone follows from the least squares element by a
/// sequence of linear programmes; it is a zone that no small motion makes narrower.
/// @param points   3xN, mm, finite
/// @param section  straightness: unit normal of the section plane, in which distances are taken; zero: the plane that
/// the points lie in best
/// @throws InputError if the points do not determine the element: too few, on a line, or without curvature
Form form(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section = Eigen::Vector3d::Zero());

/// Columns of the points that are no outliers: within `sigmas` robust standard deviations (1.4826 median |deviation|)
/// of the least squares element of all points that are, found by repetition.
/// @throws InputError as form()
std::vector<Eigen::Index> without_outliers(FormKind kind, const Eigen::Matrix3Xd& points, double sigmas,
                                           const Eigen::Vector3d& section = Eigen::Vector3d::Zero());

/// "least_squares", "minimum_zone" and the elements, in `units`.
json::Value to_json(const Form& form, const Eigen::Matrix3Xd& points, const Units& units);

} // namespace fettle
