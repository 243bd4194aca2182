#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"
#include "units/units.h"

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace fettle::core {
class InputFile;
}

namespace fettle::mesh {

/// Points or triangles of a part, mm.
using MeshOrCloud = std::variant<cloud::Cloud, Mesh>;

struct ShapeFile {
    MeshOrCloud shape;
    units::Units units; ///< units of the file
    MeshRepair repair;  ///< what reading a mesh dropped or repaired
};

/// Reads a mesh or a point cloud; the content decides which.
/// @param path   a file, or "-" for stdin
/// @param units  units of the file; without them those that a PCD states, else mm
/// @throws InputError as read_mesh() and read_cloud()
ShapeFile read_shape(const std::string& path, const std::optional<units::Units>& units);
/// Reads a mesh or a cloud from an open file. @param source  its name for messages
ShapeFile read_shape(const core::InputFile& file, const std::string& source, const std::optional<units::Units>& units);
/// Reads a mesh or a cloud from the bytes of a file.
ShapeFile parse_shape(std::string_view bytes, const std::string& source, const std::optional<units::Units>& units);

/// Units for read_shape(): the length unit stated on the command line with the force unit of `fallback`; `fallback` if
/// none is stated.
std::optional<units::Units> resolve_file_units(const std::optional<units::Units::Length>& stated,
                                               const std::optional<units::Units>& fallback = std::nullopt);

cloud::Frame frame_of(const MeshOrCloud& shape);

/// Coordinates of the points or the vertices, 3xN, mm.
const Eigen::Matrix3Xd& coordinates_of(const MeshOrCloud& shape);

} // namespace fettle::mesh
