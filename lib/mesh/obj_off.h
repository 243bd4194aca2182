#pragma once

#include "mesh/mesh.h"

#include <string>
#include <string_view>

namespace fettle::mesh {

/// Parses Wavefront OBJ: the statements `v` and `f`, also with relative indices; other statements, and
/// a first line of two counts, are skipped. The mesh is in the units of the file and keeps NaN vertices.
/// @throws InputError with the line
Mesh parse_obj(std::string_view text, const std::string& source);
/// True if the first line, or the one after a line of two counts, is a statement of OBJ.
bool looks_like_obj(std::string_view text);

/// Parses OFF and COFF in text form. The mesh is in the units of the file and keeps NaN vertices.
/// @throws InputError with the line
Mesh parse_off(std::string_view text, const std::string& source);
/// True if the first word is the name of an OFF variant; parse_off() rejects most of them with a message.
bool looks_like_off(std::string_view text);

} // namespace fettle::mesh
