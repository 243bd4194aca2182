#pragma once

#include "surface/surface.h"
#include "json/document.h"

namespace fettle::surface {

/// JSON object of a shape: its type, then its members (docs/formats.md).
/// @param mm  the file's unit of length in mm
json::Value shape_to_json(const Shape& shape, double mm);
/// Parses such an object. @throws InputError that names the member's path
Shape parse_shape(json::Reader reader, double mm);

} // namespace fettle::surface
