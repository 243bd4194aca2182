#include "mesh/shape_file.h"

#include "cloud/pcd.h"
#include "core/file.h"
#include "core/wrong_kind.h"
#include "mesh/mesh_file.h"
#include "mesh/stl.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

namespace fettle {

namespace {

/// All bytes of a file: read by several threads, into memory that nobody has touched before.
struct FileBytes {
    explicit FileBytes(const InputFile& file)
        : bytes(std::make_unique_for_overwrite<char[]>(file.size())), size(file.size())
    {
        constexpr std::size_t kPiece = 1 << 22;
        tbb::parallel_for(std::size_t{0}, (size + kPiece - 1) / kPiece, [&](std::size_t i) {
            file.read(i * kPiece, bytes.get() + i * kPiece, std::min(kPiece, size - i * kPiece));
        });
    }
    std::string_view view() const { return {bytes.get(), size}; }

    std::unique_ptr<char[]> bytes;
    std::size_t size;
};

} // namespace

ShapeFile read_shape(const std::string& path, const std::optional<Units>& units)
{
    return read_shape(InputFile(path), display_name(path), units);
}

ShapeFile read_shape(const InputFile& file, const std::string& source, const std::optional<Units>& units)
{
    std::string head(std::min(file.size(), kStlHead), '\0');
    file.read(0, head.data(), head.size());
    if (!is_binary_stl(head, file.size())) return parse_shape(FileBytes(file).view(), source, units);
    ShapeFile shape{Mesh(), units.value_or(Units{}), {}};
    shape.shape = read_mesh(file, source, shape.units.length, &shape.repair);
    return shape;
}

ShapeFile parse_shape(std::string_view bytes, const std::string& source, const std::optional<Units>& units)
{
    if (bytes.empty()) throw InputError(source, "empty, expected points or a mesh");
    if (bytes.front() == '{' && !is_binary_stl(bytes)) throw WrongKind(source, "JSON, expected points or a mesh");
    if (looks_like_cloud(bytes)) {
        CloudFile file = parse_cloud(bytes, source, units);
        return {std::move(file.cloud), file.units, {}};
    }
    ShapeFile shape{Mesh(), units.value_or(Units{}), {}};
    shape.shape = parse_mesh(bytes, source, shape.units.length, &shape.repair);
    return shape;
}

std::optional<Units> units_of(const std::optional<Units::Length>& stated, const std::optional<Units>& otherwise)
{
    if (!stated) return otherwise;
    return Units{*stated, otherwise.value_or(Units{}).force};
}

const Eigen::Matrix3Xd& places_of(const MeshOrCloud& shape)
{
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) return mesh->vertices;
    return std::get<Cloud>(shape).xyz;
}

} // namespace fettle
