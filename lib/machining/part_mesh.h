#pragma once

#include "machining/cutter.h"
#include "mesh/mesh.h"
#include "units/units.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace fettle::machining {

/// A mesh of a file, and doubts about it.
struct PartMesh {
    mesh::Mesh mesh;                   ///< mm
    std::vector<std::string> warnings; ///< each begins with the file's name
    bool closed = false;               ///< of a design: no border
};

/// Reads a mesh into the tilted frame (tilt.h). What is left out of it is a warning.
/// @param unit  of the file; nothing: mm
/// @throws InputError as read_mesh(), and if half of the facets or more would be left out
PartMesh read_part_mesh(const std::string& path, const std::optional<units::Units::Length>& unit,
                        const Eigen::Matrix3d& rotation_tilted_machine);

/// Reads a design, whose facets should face out of the material. Facets that are wound the wrong way are turned over,
/// with a warning; so is a closed design that is inside out.
/// @throws InputError as read_part_mesh(), and if an open design faces down, or none of it faces up
PartMesh read_design(const std::string& path, const std::optional<units::Units::Length>& unit,
                     const Eigen::Matrix3d& rotation_tilted_machine);

/// mesh::repair_warning() with the file's name. @param kept  number of facets that were not left out
/// @throws InputError if half of the facets or more are left out: simulation and verdict would be about holes
std::string repair_warning(const mesh::MeshRepair& repair, Eigen::Index kept, const std::string& source);

/// A warning if a part is much smaller or larger than what the cutter is for, else empty: a wrong unit.
/// @param part  "the design"   @param size  along x, y, z, mm
std::string cutter_size_warning(const std::string& part, const Eigen::Vector3d& size, const Cutter& cutter);

} // namespace fettle::machining
