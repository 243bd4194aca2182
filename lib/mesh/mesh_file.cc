#include "mesh/mesh_file.h"

#include "cloud/e57.h"
#include "cloud/pcd_header.h"
#include "cloud/ply.h"
#include "cloud/reach.h"
#include "cloud/xyz.h"
#include "core/content.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/wrong_kind.h"
#include "mesh/mesh_checks.h"
#include "mesh/obj_off.h"
#include "mesh/polygons.h"
#include "mesh/stl.h"
#include "mesh/three_mf.h"

namespace fettle::mesh {

namespace {

Mesh parse_ply_mesh(std::string_view bytes, const std::string& source)
{
    cloud::Ply ply = cloud::parse_ply(bytes, source);
    Mesh mesh;
    mesh.triangles = triangulate_faces(ply, source);
    mesh.vertices = std::move(ply.vertices.xyz);
    mesh.frame = ply.vertices.frame;
    return mesh;
}

/// @param mm  millimetres in the unit of the file; set where the file states it
Mesh parse_unscaled(std::string_view bytes, const std::string& source, MeshRepair& repair, double& mm)
{
    if (is_binary_stl(bytes)) return parse_stl(bytes, source, repair);
    if (looks_like_three_mf(bytes)) {
        ThreeMf file = parse_three_mf(bytes, source);
        mm = file.unit_mm;
        return std::move(file.mesh);
    }
    bytes = core::strip_byte_order_mark(bytes, source);
    if (cloud::looks_like_ply(bytes)) return parse_ply_mesh(bytes, source);
    if (looks_like_off(bytes)) return parse_off(bytes, source);
    if (looks_like_ascii_stl(bytes)) return parse_stl(bytes, source, repair);
    if (looks_like_obj(bytes)) return parse_obj(bytes, source);
    if (looks_like_cloud(bytes)) throw core::WrongFileType(source, "points, expected a mesh");
    if (bytes.starts_with('{')) throw core::WrongFileType(source, "JSON, expected a mesh");
    if (!looks_like_damaged_stl(bytes)) core::refuse_other_content(bytes, source, "a mesh");
    if (bytes.find('\0') == std::string_view::npos)
        throw core::InputError(source, "neither STL, PLY, OBJ, OFF nor 3MF");
    return parse_stl(bytes, source, repair); // throws with the reason
}

/// Drops triangles that are not finite and converts the mesh to mm.
/// @param mm  millimetres in the unit of the mesh
/// @param repaired  what reading repaired so far   @param repair  receives it together with the triangles dropped here
/// @throws InputError if few or no triangles are left, or coordinates are out of range
Mesh checked_and_scaled(Mesh mesh, MeshRepair repaired, const std::string& source, double mm, MeshRepair* repair)
{
    const Eigen::Index nonfinite = drop_nonfinite(mesh);
    if (nonfinite > 0) drop_unused_vertices(mesh); // the finite corners of those triangles
    repaired.dropped_triangles += nonfinite;
    check_triangles_left(mesh.triangles.cols(), repaired.dropped_triangles, source);
    if (mm != 1) mesh.vertices *= mm;
    cloud::check_coordinate_range(mesh.vertices, source);
    if (repair != nullptr) *repair = repaired;
    return mesh;
}

} // namespace

Eigen::Matrix3Xi triangulate_faces(const cloud::Ply& ply, const std::string& source)
{
    std::size_t begin = 0;
    for (std::size_t f = 0; f < ply.ends.size(); begin = ply.ends[f++])
        if (const std::size_t corners = ply.ends[f] - begin; corners > kMaxPolygonCorners)
            throw core::InputError(source, "face " + std::to_string(f) + ": " + std::to_string(corners) +
                                               " corners, at most " + std::to_string(kMaxPolygonCorners));
    return triangulate_polygons(ply.vertices.xyz, ply.corners, ply.ends);
}

void check_triangles_left(Eigen::Index left, Eigen::Index dropped, const std::string& source)
{
    if (left == 0)
        throw core::InputError(source, dropped == 0 ? "no triangles"
                                                    : "no triangles but " + std::to_string(dropped) +
                                                          " with NaN or infinite corners");
    constexpr Eigen::Index kMaxDroppedToLeft = 9; // a tenth of the facets are the remains of a file, and no part
    if (dropped > kMaxDroppedToLeft * left)
        throw core::InputError(source, std::to_string(dropped) + " of " + std::to_string(dropped + left) +
                                           " triangles have NaN or infinite corners");
}

Mesh read_mesh(const std::string& path, units::Units::Length unit, MeshRepair* repair)
{
    return read_mesh(core::InputFile(path), core::display_name(path), unit, repair);
}

Mesh read_mesh(const core::InputFile& file, const std::string& source, units::Units::Length unit, MeshRepair* repair)
{
    const std::string header = read_binary_stl_header(file);
    if (header.empty()) return parse_mesh(file.read_all(), source, unit, repair);
    MeshRepair repaired;
    const auto read = [&](std::size_t offset, char* to, std::size_t count) { file.read(offset, to, count); };
    Mesh mesh = read_binary_stl(header, read, source, repaired);
    return checked_and_scaled(std::move(mesh), repaired, source, units::mm_per(unit), repair);
}

Mesh parse_mesh(std::string_view bytes, const std::string& source, units::Units::Length unit, MeshRepair* repair)
{
    MeshRepair repaired;
    double mm = units::mm_per(unit);
    Mesh mesh = parse_unscaled(bytes, source, repaired, mm);
    repaired.unused_vertices = drop_unused_vertices(mesh);
    return checked_and_scaled(std::move(mesh), repaired, source, mm, repair);
}

bool looks_like_cloud(std::string_view bytes)
{
    if (is_binary_stl(bytes)) return false;
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    if (cloud::looks_like_ply(bytes)) return !cloud::ply_has_faces(bytes);
    return cloud::looks_like_pcd(bytes) || cloud::looks_like_e57(bytes) ||
           (cloud::looks_like_xyz(bytes) && !looks_like_obj(bytes));
}

} // namespace fettle::mesh
