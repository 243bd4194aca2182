#pragma once

namespace fettle::mesh {

/// What read_cloud_mesh() reads, for the help of the tools that call it.
inline constexpr const char* kReadFormats = "A cloud (PCD, PLY, E57, PTX, XYZ) or a mesh (STL, PLY, OBJ, OFF, 3MF)";

} // namespace fettle::mesh
