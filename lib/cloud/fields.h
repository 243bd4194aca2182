#pragma once

#include "cloud/cloud.h"
#include "units/units.h"

#include <string>
#include <vector>

namespace fettle::cloud {

/// The dimension of a field by its name (docs/conventions.md): error, sigma, clearance, clearance_between, radius,
/// displacement, removed, deflection, gap, indentation, depth, retreat, height, foot_x, foot_y, foot_z and joint7 (a
/// robot's track) are lengths; area and removed_volume are powers of lengths; force, peak_force are forces; feed is
/// length per second; pressure is force per area. Any other name is a plain number.
units::Dimension field_dimension(const std::string& name);

/// Values of a scalar field of integers from 0 (curve, role); -1 for other values (NaN).
/// @throws InputError as field()
Eigen::VectorXi integer_field(const Cloud& cloud, const std::string& name);

/// Element `index` among all elements of all points. @param type  of the element, usually field.type
double element(const Field& field, char type, std::size_t index);
/// Appends element `index` as text: an integer, or the shortest text of a float.
void append_element(std::string& text, const Field& field, char type, std::size_t index);

/// Rows of text, a point each: its coordinates and the elements of its fields.
/// @param type_of  returns the type of a field's elements, usually field.type
std::string text_rows(const Eigen::Matrix3Xf& xyz, const std::vector<Field>& fields, char separator,
                      char (*type_of)(const Field&));

/// Scales all elements of a field to value * times / over. An integer field becomes F8: 1 in is not an integer in mm.
void scale_field(Field& field, double times, double over = 1);
/// Converts a cloud with its fields, in place, to base units. @param units  of its numbers
void to_base_units(Cloud& cloud, const units::Units& units);
/// Converts fields from base units.
/// @return  the fields in `units`
std::vector<Field> to_file_units(std::vector<Field> fields, const units::Units& units);

} // namespace fettle::cloud
