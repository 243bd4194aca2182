#pragma once

#include "cloud/cloud.h"
#include "units/units.h"

#include <string>

namespace fettle {

/// The dimension of a field by its name (docs/conventions.md): error, sigma, clearance, clearance_between, radius,
/// displacement, removed, deflection, gap, indentation, depth, foot_x, foot_y, foot_z and joint7 (a robot's track) are
/// lengths; force, peak_force are forces; feed is length per second; pressure is force per area. Any other name is a
/// plain number.
Dimension field_dimension(const std::string& name);

/// A scalar field of whole numbers from 0 (curve, role); -1 for what is none of them (NaN).
/// @throws InputError as field()
Eigen::VectorXi whole_numbers(const Cloud& cloud, const std::string& name);

/// Element `index` of all elements of all points, taken as a number of `type`, usually the field's own.
double element(const Field& field, char type, std::size_t index);

/// Multiplies all elements of a field by `times` and divides them by `over`. One of whole numbers becomes F8: 1 in is
/// no whole number of mm.
void scale(Field& field, double times, double over = 1);

} // namespace fettle
