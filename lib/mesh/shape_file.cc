#include "mesh/shape_file.h"

#include "cloud/pcd.h"
#include "cloud/stated_units.h"
#include "core/content.h"
#include "core/file.h"
#include "core/wrong_kind.h"
#include "mesh/mesh_file.h"
#include "mesh/stl.h"
#include "mesh/three_mf.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

namespace fettle::mesh {

namespace {

/// Reads a file with several threads.
std::vector<char> read_in_parallel(const core::InputFile& file)
{
    constexpr std::size_t kPieceBytes = 1 << 22;
    std::vector<char> bytes(file.size());
    tbb::parallel_for(std::size_t{0}, (bytes.size() + kPieceBytes - 1) / kPieceBytes, [&](std::size_t i) {
        const std::size_t first = i * kPieceBytes;
        file.read(first, bytes.data() + first, std::min(kPieceBytes, bytes.size() - first));
    });
    return bytes;
}

/// Units of a 3MF file by what it states; in a unit that no other file is in (micron, foot) it counts as mm.
/// @throws InputError if others are requested
units::Units resolve_three_mf_units(std::string_view bytes, const std::string& source,
                                    const std::optional<units::Units>& requested)
{
    using Length = units::Units::Length;
    const double mm = three_mf_unit(bytes, source);
    for (const Length length : {Length::mm, Length::in, Length::m})
        if (units::mm_per(length) == mm) return cloud::resolve_units({{length, std::nullopt}}, requested, source);
    return requested.value_or(units::Units{});
}

} // namespace

ShapeFile read_shape(const std::string& path, const std::optional<units::Units>& units)
{
    return read_shape(core::InputFile(path), core::display_name(path), units);
}

ShapeFile read_shape(const core::InputFile& file, const std::string& source, const std::optional<units::Units>& units)
{
    if (read_binary_stl_header(file).empty()) {
        const std::vector<char> bytes = read_in_parallel(file);
        return parse_shape({bytes.data(), bytes.size()}, source, units);
    }
    ShapeFile shape{Mesh(), units.value_or(units::Units{}), {}};
    shape.shape = read_mesh(file, source, shape.units.length, &shape.repair);
    return shape;
}

ShapeFile parse_shape(std::string_view bytes, const std::string& source, const std::optional<units::Units>& units)
{
    if (bytes.starts_with('{') && !is_binary_stl(bytes))
        throw core::WrongFileType(source, "JSON, expected points or a mesh");
    if (looks_like_cloud(bytes)) {
        cloud::CloudFile file = cloud::parse_cloud(bytes, source, units);
        return {std::move(file.cloud), file.units, {}};
    }
    if (!is_binary_stl(bytes) && !looks_like_damaged_stl(bytes) && !looks_like_three_mf(bytes))
        core::refuse_other_content(bytes, source, "points or a mesh");
    ShapeFile shape{Mesh(), units.value_or(units::Units{}), {}};
    if (looks_like_three_mf(bytes)) shape.units = resolve_three_mf_units(bytes, source, units);
    shape.shape = parse_mesh(bytes, source, shape.units.length, &shape.repair);
    return shape;
}

std::optional<units::Units> resolve_file_units(const std::optional<units::Units::Length>& stated,
                                               const std::optional<units::Units>& fallback)
{
    if (!stated) return fallback;
    return units::Units{*stated, fallback.value_or(units::Units{}).force};
}

cloud::Frame frame_of(const MeshOrCloud& shape)
{
    return std::visit([](const auto& either) { return either.frame; }, shape);
}

const Eigen::Matrix3Xd& coordinates_of(const MeshOrCloud& shape)
{
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) return mesh->vertices;
    return std::get<cloud::Cloud>(shape).xyz;
}

} // namespace fettle::mesh
