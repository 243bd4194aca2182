#include "mesh/cloud_mesh.h"

#include "cli/output_format.h"
#include "cloud/cloud_encoder.h"
#include "cloud/cloud_writer.h"
#include "cloud/fields.h"
#include "cloud/pcd_header.h"
#include "cloud/ply.h"
#include "cloud/reach.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "mesh/mesh_checks.h"
#include "mesh/mesh_file.h"
#include "mesh/shape_file.h"
#include "mesh/stl.h"

#include <algorithm>
#include <array>
#include <ostream>
#include <utility>

namespace fettle::mesh {
namespace {

constexpr std::array<std::pair<const char*, PartFormat>, 5> kFormats = {{{"pcd", PartFormat::pcd},
                                                                         {"ply", PartFormat::ply},
                                                                         {"csv", PartFormat::csv},
                                                                         {"vtk", PartFormat::vtk},
                                                                         {"stl", PartFormat::stl}}};

bool begins_as_ply(const core::InputFile& file, const std::string& source)
{
    std::array<char, 16> head; // a byte order mark, "ply" and the end of the line
    const std::size_t count = std::min(head.size(), file.size());
    file.read(0, head.data(), count);
    return cloud::looks_like_ply(core::strip_byte_order_mark({head.data(), count}, source));
}

/// The part of a PLY file with faces. Triangles that are not finite and vertices of no triangle are dropped.
CloudMeshFile parse_ply_part(std::string_view bytes, const std::string& source, const units::Units& units)
{
    cloud::Ply ply = cloud::parse_ply(bytes, source);
    CloudMesh whole;
    whole.triangles = triangulate_faces(ply, source);
    whole.points = std::move(ply.vertices);
    cloud::check_field_names(whole.points.fields, source);
    const Eigen::Matrix<bool, 1, Eigen::Dynamic> is_finite = whole.points.xyz.array().isFinite().colwise().all();
    std::vector<Eigen::Index> finite;
    for (Eigen::Index t = 0; t < whole.triangles.cols(); ++t)
        if (std::ranges::all_of(whole.triangles.col(t), [&](int corner) { return is_finite[corner]; }))
            finite.push_back(t);
    CloudMeshFile file{select_triangles(whole, finite), units, {}};
    file.repair.dropped_triangles = whole.triangles.cols() - file.part.triangles.cols();
    file.repair.unused_vertices = is_finite.count() - file.part.points.size();
    check_triangles_left(file.part.triangles.cols(), file.repair.dropped_triangles, source);
    cloud::to_base_units(file.part.points, units);
    cloud::check_coordinate_range(file.part.points.xyz, source);
    return file;
}

} // namespace

CloudMesh select_triangles(const CloudMesh& part, const std::vector<Eigen::Index>& indices)
{
    CloudMesh result;
    result.triangles = part.triangles(Eigen::all, indices);
    std::vector<int> new_index(part.points.size(), -1);
    for (const int corner : result.triangles.reshaped()) new_index[corner] = 0;
    std::vector<Eigen::Index> used;
    for (std::size_t i = 0; i < new_index.size(); ++i)
        if (new_index[i] == 0) {
            new_index[i] = static_cast<int>(used.size());
            used.push_back(static_cast<Eigen::Index>(i));
        }
    result.points = cloud::select_points(part.points, used);
    for (int& corner : result.triangles.reshaped()) corner = new_index[corner];
    return result;
}

CloudMesh as_cloud_mesh(MeshOrCloud shape)
{
    Mesh* mesh = std::get_if<Mesh>(&shape);
    if (mesh == nullptr) return {std::move(std::get<cloud::Cloud>(shape)), {}};
    CloudMesh part{{}, std::move(mesh->triangles)};
    part.points.xyz = std::move(mesh->vertices);
    part.points.frame = mesh->frame;
    return part;
}

CloudMesh select_points(const CloudMesh& part, const std::vector<Eigen::Index>& indices)
{
    if (!part.is_mesh()) return {cloud::select_points(part.points, indices), {}};
    std::vector<char> is_kept(part.points.size(), 0);
    for (const Eigen::Index i : indices) is_kept[i] = 1;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index t = 0; t < part.triangles.cols(); ++t)
        if (std::ranges::all_of(part.triangles.col(t), [&](int corner) { return is_kept[std::size_t(corner)] != 0; }))
            kept.push_back(t);
    return select_triangles(part, kept);
}

CloudMeshFile read_cloud_mesh(const std::string& path, const std::optional<units::Units>& units)
{
    const core::InputFile file(path);
    const std::string source = core::display_name(path);
    if (begins_as_ply(file, source)) {
        const std::string all = file.read_all();
        const std::string_view bytes = core::strip_byte_order_mark(all, source);
        if (cloud::ply_has_faces(bytes)) return parse_ply_part(bytes, source, units.value_or(units::Units{}));
    }
    ShapeFile shape = read_shape(file, source, units);
    return {as_cloud_mesh(std::move(shape.shape)), shape.units, shape.repair};
}

PartFormat part_format(const std::string& path, const std::string& stated, bool is_mesh)
{
    const std::string suffix = cli::suffix_of(path), word = stated.empty() ? suffix : stated;
    const auto* found = std::ranges::find(kFormats, word, &std::pair<const char*, PartFormat>::first);
    if (found == kFormats.end()) return is_mesh ? PartFormat::stl : PartFormat::pcd;
    const std::string asked_by = suffix == word ? path : "--format";
    const bool holds_triangles = found->second == PartFormat::stl || found->second == PartFormat::ply;
    if (is_mesh && !holds_triangles)
        throw core::InputError(asked_by, "a mesh is written as STL or PLY, not as " + word);
    if (!is_mesh && found->second == PartFormat::stl)
        throw core::InputError(asked_by, "a cloud is written as PCD, PLY, CSV or VTK, not as stl");
    return found->second;
}

void write_cloud_mesh(std::ostream& out, const CloudMesh& part, PartFormat format, const units::Units& units)
{
    if (format == PartFormat::stl) {
        write_stl(out, {part.points.xyz, part.triangles, part.points.frame}, units.length);
    } else if (part.is_mesh()) {
        const auto encoder = cloud::ply_encoder(out, units, static_cast<std::size_t>(part.points.size()),
                                                static_cast<std::size_t>(part.triangles.cols()));
        encoder->begin(part.points);
        encoder->write(part.points);
        cloud::write_ply_faces(out, part.triangles);
    } else {
        constexpr std::array kCloudFormats = {cloud::CloudFormat::pcd, cloud::CloudFormat::pcd_ascii,
                                              cloud::CloudFormat::ply, cloud::CloudFormat::csv,
                                              cloud::CloudFormat::vtk}; // in the order of PartFormat
        cloud::CloudWriter writer(out, kCloudFormats[static_cast<std::size_t>(format)], units,
                                  static_cast<std::size_t>(part.points.size()));
        writer.write(part.points);
        writer.finish();
    }
}

} // namespace fettle::mesh
