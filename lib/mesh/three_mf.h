#pragma once

#include "mesh/mesh.h"

#include <string>
#include <string_view>

namespace fettle::mesh {

/// A mesh of a 3MF file.
struct ThreeMf {
    Mesh mesh;          ///< in the unit of the file
    double unit_mm = 1; ///< millimetres in that unit
};

/// Parses 3MF (3MF Consortium, core specification 1.3): a ZIP archive whose model, in XML, states the unit, the meshes,
/// and which of them are built where. All items of the build are joined, components with their transforms; a transform
/// that mirrors turns its triangles over. Colours, materials and pictures are left out; a file that requires an
/// extension, such as the production extension, is refused.
///
/// lib3mf, 1.8.1 in Debian 12, takes 4 ms to load, which every tool that reads a mesh would pay at each start; minizip
/// and expat, which E57 needs anyway, take 1 ms.
/// @throws InputError with what is wrong and the line
ThreeMf parse_three_mf(std::string_view bytes, const std::string& source);

/// Millimetres in the unit that the model states. @throws InputError as parse_three_mf()
double three_mf_unit(std::string_view bytes, const std::string& source);

/// True if the file begins as a ZIP archive; which has a 3MF model in it, or is refused.
bool looks_like_three_mf(std::string_view bytes);

} // namespace fettle::mesh
