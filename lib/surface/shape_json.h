#pragma once

#include "surface/surface.h"
#include "json/document.h"

namespace fettle {

/// A shape by itself: its type, then its members (docs/formats.md).
/// @param mm  the file's unit of length
json::Value shape_to_json(const Shape& shape, double mm);
/// @throws InputError with the member's path
Shape parse_shape(json::Reader reader, double mm);

} // namespace fettle
