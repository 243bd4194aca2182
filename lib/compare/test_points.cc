#include "compare/test_points.h"

#include "cloud/pcd_header.h"
#include "core/file.h"
#include "mesh/stl.h"

#include <algorithm>
#include <memory>

namespace fettle {

namespace {

std::string head_of(const InputFile& file)
{
    constexpr std::size_t kHead = 1 << 12; // enough to tell a PCD or a binary STL
    std::string head(std::min(file.size(), kHead), '\0');
    file.read(0, head.data(), head.size());
    return head;
}

} // namespace

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
