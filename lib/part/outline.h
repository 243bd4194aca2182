#pragma once

#include "json/document.h"

#include <Eigen/Core>

namespace fettle::part {

/// Reads the outline of an anomaly's foot, 2xN, counter-clockwise, mm. The formats are
///   {"polygon": [[x, y], …]}   {"ellipse": {"centre": [x, y], "semi_axes": [a, b], "angle_deg": 0}}
///   {"letter_h": {"centre": [x, y], "size": [width, height], "stroke": s, "angle_deg": 0}}
///   {"moon": {"centre": [x, y], "radius": r, "bite": {"centre": [x, y], "radius": q}}}
/// Curves become polygons with a chord error of a few micrometres.
/// @param mm  mm per unit of the file   @throws InputError with the key's path
Eigen::Matrix2Xd read_outline(json::Reader reader, double mm);

} // namespace fettle::part
