#pragma once

#include "compare/form_element.h"

#include <Eigen/Core>

namespace fettle::compare {

/// Start value of the least squares fit; for a plane, already its solution.
/// @param points   3xN, about their centroid
/// @param section  unit normal of the section plane of a line; zero: the plane of least squares of the points
/// @throws InputError if the points are too few or lie on a line (sphere: in a plane; line: they coincide)
FormElement initial_element(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section);

} // namespace fettle::compare
