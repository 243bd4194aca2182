#pragma once

#include "mesh/mesh.h"

#include <string>
#include <string_view>

namespace fettle {

/// Wavefront OBJ: `v` and `f` are read, the other statements are skipped. Indices may be relative. In the units of the
/// file; NaN vertices stay.
/// @throws InputError with the line
Mesh parse_obj(std::string_view text, const std::string& source);
bool looks_like_obj(std::string_view text);

/// OFF and COFF, in text. In the units of the file; NaN vertices stay.
/// @throws InputError with the line
Mesh parse_off(std::string_view text, const std::string& source);
bool looks_like_off(std::string_view text);

} // namespace fettle
