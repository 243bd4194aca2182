#include "mesh/mesh_file.h"

#include "cloud/pcd_header.h"
#include "cloud/ply.h"
#include "cloud/reach.h"
#include "cloud/xyz.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/wrong_kind.h"
#include "mesh/obj_off.h"
#include "mesh/polygons.h"
#include "mesh/stl.h"

namespace fettle {

namespace {

Mesh parse_ply_mesh(std::string_view bytes, const std::string& source)
{
    Ply ply = parse_ply(bytes, source);
    std::size_t begin = 0;
    for (std::size_t f = 0; f < ply.ends.size(); ++f) {
        if (ply.ends[f] - begin > kMostCorners)
            throw InputError(source, "face " + std::to_string(f) + ": " + std::to_string(ply.ends[f] - begin) +
                                         " corners, at most " + std::to_string(kMostCorners));
        begin = ply.ends[f];
    }
    Mesh mesh;
    mesh.vertices = std::move(ply.vertices.xyz);
    mesh.triangles = cut_polygons(mesh.vertices, ply.corners, ply.ends);
    return mesh;
}

Mesh parse_any(std::string_view bytes, const std::string& source, MeshRepair& repair)
{
    if (is_binary_stl(bytes)) return parse_stl(bytes, source, repair);
    bytes = without_mark(bytes, source);
    if (bytes.empty()) throw InputError(source, "empty, expected a mesh");
    if (looks_like_ply(bytes)) return parse_ply_mesh(bytes, source);
    if (looks_like_off(bytes)) return parse_off(bytes, source);
    if (looks_like_ascii_stl(bytes)) return parse_stl(bytes, source, repair);
    if (looks_like_obj(bytes)) return parse_obj(bytes, source);
    if (looks_like_cloud(bytes)) throw WrongKind(source, "points, expected a mesh");
    if (bytes.front() == '{') throw WrongKind(source, "JSON, expected a mesh");
    if (bytes.find('\0') == std::string_view::npos) throw InputError(source, "neither STL, PLY, OBJ nor OFF");
    return parse_stl(bytes, source, repair); // says why it is none
}

/// The mesh in mm.
/// @throws InputError if it has no triangles or reaches too far
Mesh checked(Mesh mesh, MeshRepair done, const std::string& source, Units::Length unit, MeshRepair* repair)
{
    done.dropped_triangles += drop_undefined(mesh);
    if (mesh.triangles.cols() == 0)
        throw InputError(source, done.dropped_triangles == 0
                                     ? "no triangles"
                                     : "no triangles but " + std::to_string(done.dropped_triangles) +
                                           " with NaN or infinite corners");
    if (unit != Units::Length::mm) mesh.vertices *= mm_per(unit);
    check_reach(mesh.vertices, source);
    if (repair != nullptr) *repair = done;
    return mesh;
}

} // namespace

Mesh read_mesh(const std::string& path, Units::Length unit, MeshRepair* repair)
{
    return read_mesh(InputFile(path), display_name(path), unit, repair);
}

Mesh read_mesh(const InputFile& file, const std::string& source, Units::Length unit, MeshRepair* repair)
{
    std::string head(std::min(file.size(), kStlHead), '\0');
    file.read(0, head.data(), head.size());
    if (!is_binary_stl(head, file.size())) {
        std::string bytes(file.size(), '\0');
        file.read(0, bytes.data(), bytes.size());
        return parse_mesh(bytes, source, unit, repair);
    }
    MeshRepair done;
    const auto read = [&](std::size_t offset, char* to, std::size_t count) { file.read(offset, to, count); };
    Mesh mesh = read_binary_stl(head, read, source, done);
    return checked(std::move(mesh), done, source, unit, repair);
}

Mesh parse_mesh(std::string_view bytes, const std::string& source, Units::Length unit, MeshRepair* repair)
{
    MeshRepair done;
    Mesh mesh = parse_any(bytes, source, done);
    return checked(std::move(mesh), done, source, unit, repair);
}

bool looks_like_cloud(std::string_view bytes)
{
    if (is_binary_stl(bytes)) return false;
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    if (looks_like_ply(bytes)) return !ply_has_faces(bytes);
    return looks_like_pcd(bytes) || looks_like_xyz(bytes);
}

} // namespace fettle
