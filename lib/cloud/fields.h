#pragma once

#include "units/units.h"

#include <string>

namespace fettle {

/// The dimension of a field by its name (docs/conventions.md): error, sigma, clearance, radius, displacement, removed
/// are lengths; force is a force; feed is length per second; pressure is force per area. Any other name is a plain
/// number.
Dimension field_dimension(const std::string& name);

} // namespace fettle
