#pragma once

#include "compare/form_element.h"

#include <Eigen/Core>

namespace fettle {

/// An element near the points to start least squares from. Plane: already that of least squares.
/// @param points   3xN, about their centroid
/// @param section  unit normal of the section plane of a line; zero: the plane that the points lie in best
/// @throws InputError if the points are too few or lie on a line (sphere: in a plane; line: in one place)
FormElement form_start(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section);

} // namespace fettle
