#include "machining/part_mesh.h"

#include "compare/reference_mesh.h"
#include "core/error.h"
#include "core/file.h"
#include "job/plausible.h"
#include "machining/tilt.h"
#include "mesh/mesh_file.h"

#include <cmath>
#include <utility>

namespace fettle::machining {
namespace {

/// Requires that an open mesh faces up on the whole. The areas in plan view of a closed one add up to zero.
void require_facing_up(const mesh::Mesh& mesh, const std::string& source)
{
    constexpr double kMinShare = 0.01; // of the area in plan view; smaller sums are rounding, or gaps of a closed mesh
    double up = 0, down = 0;
    for (const auto& t : mesh.triangles.colwise()) {
        const Eigen::Vector2d a = mesh.vertices.col(t[0]).head<2>();
        const Eigen::Vector2d b = mesh.vertices.col(t[1]).head<2>() - a, c = mesh.vertices.col(t[2]).head<2>() - a;
        const double twice_area = b.x() * c.y() - b.y() * c.x();
        (twice_area > 0 ? up : down) += std::abs(twice_area);
    }
    if (up == 0) throw core::InputError(source, "no facet of the design faces up");
    if (down - up > kMinShare * (down + up))
        throw core::InputError(source, "more of the open design faces down than up: is it inside out?");
}

} // namespace

PartMesh read_part_mesh(const std::string& path, const std::optional<units::Units::Length>& unit,
                        const Eigen::Matrix3d& rotation_tilted_machine)
{
    mesh::MeshRepair repair;
    PartMesh part;
    part.mesh = mesh::read_mesh(path, unit.value_or(units::Units::Length::mm), &repair);
    const std::string warning = repair_warning(repair, part.mesh.triangles.cols(), core::display_name(path));
    if (!warning.empty()) part.warnings.push_back(warning);
    part.mesh = rotated(std::move(part.mesh), rotation_tilted_machine);
    return part;
}

PartMesh read_design(const std::string& path, const std::optional<units::Units::Length>& unit,
                     const Eigen::Matrix3d& rotation_tilted_machine)
{
    PartMesh part = read_part_mesh(path, unit, rotation_tilted_machine);
    const std::string name = core::display_name(path);
    compare::ReferenceMesh repaired = compare::reference_mesh(part.mesh);
    if (repaired.repair.flipped_facets > 0) {
        part.warnings.push_back(name + ": " + std::to_string(repaired.repair.flipped_facets) +
                                " facets that were wound inwards are turned over");
        part.mesh = std::move(repaired.mesh);
    }
    part.closed = repaired.closed;
    require_facing_up(part.mesh, name);
    return part;
}

std::string repair_warning(const mesh::MeshRepair& repair, Eigen::Index kept, const std::string& source)
{
    const Eigen::Index dropped = repair.dropped_triangles;
    if (dropped > 0 && dropped >= kept)
        throw core::InputError(source, std::to_string(dropped) + " of " + std::to_string(kept + dropped) +
                                           " facets have NaN or infinite corners");
    const std::string warning = mesh::repair_warning(repair);
    return warning.empty() ? "" : source + ": " + warning;
}

std::string cutter_size_warning(const std::string& part, const Eigen::Vector3d& size, const Cutter& cutter)
{
    // For a cutter of 6 mm: parts from 1.2 mm to 6 m. Metres taken as millimetres, or the other way round, change the
    // ratio by a factor of a thousand.
    constexpr double kMinPartPerCutter = 0.2, kMaxPartPerCutter = 1000;
    return job::scale_warning(part, size, units::Units{},
                              {"the cutter's diameter", 2 * cutter.radius, kMinPartPerCutter, kMaxPartPerCutter});
}

} // namespace fettle::machining
