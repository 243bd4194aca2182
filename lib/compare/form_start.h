#pragma once

#include "compare/form_element.h"

#include <Eigen/Core>

namespace fettle {

/// An element near the points to start least squares from. Plane: already that of least squares.
/// @param points  3xN, about their centroid
/// @throws InputError if the points are too few or lie on a line (sphere: in a plane)
FormElement form_start(FormKind kind, const Eigen::Matrix3Xd& points);

} // namespace fettle
