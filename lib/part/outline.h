#pragma once

#include "json/document.h"

#include <Eigen/Core>

namespace fettle {

/// The foot of an anomaly, 2xN, counter-clockwise, mm. Reads one of
///   {"polygon": [[x, y], …]}   {"ellipse": {"centre": [x, y], "semi_axes": [a, b], "angle_deg": 0}}
///   {"letter_h": {"centre": [x, y], "size": [width, height], "stroke": s, "angle_deg": 0}}
///   {"moon": {"centre": [x, y], "radius": r, "bite": {"centre": [x, y], "radius": q}}}
/// Round ones become polygons with a chord error of a few micrometres.
/// @param mm  in one unit of the file   @throws InputError
Eigen::Matrix2Xd read_outline(json::Reader reader, double mm);

} // namespace fettle
