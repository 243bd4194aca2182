#include "compare/shape_file.h"

#include "cloud/pcd.h"
#include "cloud/pcd_header.h"
#include "core/error.h"
#include "core/file.h"
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

std::string head_of(const InputFile& file)
{
    constexpr std::size_t kHead = 1 << 12; // enough to tell a PCD or a binary STL
    std::string head(std::min(file.size(), kHead), '\0');
    file.read(0, head.data(), head.size());
    return head;
}

ShapeFile read_shape(const InputFile& file, const std::string& name, const std::optional<Units>& units)
{
    ShapeFile shape{Mesh(), units.value_or(Units{}), {}};
    if (is_binary_stl(head_of(file), file.size())) {
        shape.shape = read_mesh(file, name, shape.units.length, &shape.repair);
        return shape;
    }
    const FileBytes bytes(file);
    if (bytes.view().empty()) throw InputError(name, "empty, expected points or a mesh");
    if (looks_like_cloud(bytes.view())) {
        CloudFile cloud = parse_cloud(bytes.view(), name, units);
        return {std::move(cloud.cloud), cloud.units, {}};
    }
    shape.shape = parse_mesh(bytes.view(), name, shape.units.length, &shape.repair);
    return shape;
}

} // namespace

ShapeFile read_shape(const std::string& path, const std::optional<Units>& units)
{
    return read_shape(InputFile(path), display_name(path), units);
}

const Eigen::Matrix3Xd& places_of(const MeshOrCloud& shape)
{
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) return mesh->vertices;
    return std::get<Cloud>(shape).xyz;
}

TestPoints test_points(const MeshOrCloud& shape, const Units& units)
{
    TestPoints test;
    test.units = units;
    auto cloud = std::make_shared<Cloud>();
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) {
        test.mesh = *mesh;
        cloud->xyz = mesh->vertices;
    } else {
        *cloud = std::get<Cloud>(shape);
    }
    test.points = point_source(cloud);
    test.part = [cloud](std::size_t first, std::size_t count) {
        return part(*cloud, static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count));
    };
    return test;
}

TestPoints open_test_points(const std::string& path, const std::optional<Units>& units)
{
    const auto file = std::make_shared<const InputFile>(path);
    const std::string head = head_of(*file);
    if (looks_like_pcd(head) && !is_binary_stl(head, file->size())) {
        const auto stream = std::make_shared<const CloudStream>(file, display_name(path), units);
        TestPoints test;
        test.points = stream->points();
        test.part = [stream](std::size_t first, std::size_t count) { return stream->part(first, count); };
        test.units = stream->units();
        return test;
    }
    const ShapeFile shape = read_shape(*file, display_name(path), units);
    return test_points(shape.shape, shape.units);
}

} // namespace fettle
