#include "compare/test_points.h"

#include "cloud/pcd_header.h"
#include "core/file.h"
#include "job/frame.h"
#include "mesh/stl.h"

#include <algorithm>
#include <memory>

namespace fettle::compare {

namespace {

std::string read_head(const core::InputFile& file)
{
    constexpr std::size_t kHeadBytes = 1 << 12; // enough to recognise a PCD or a binary STL
    std::string head(std::min(file.size(), kHeadBytes), '\0');
    file.read(0, head.data(), head.size());
    return head;
}

} // namespace

TestPoints test_points(const mesh::MeshOrCloud& shape, const units::Units& units)
{
    TestPoints test;
    test.units = units;
    auto cloud = std::make_shared<cloud::Cloud>();
    test.frame = mesh::frame_of(shape);
    if (const mesh::Mesh* mesh = std::get_if<mesh::Mesh>(&shape)) {
        test.mesh = *mesh;
        cloud->xyz = mesh->vertices;
        cloud->frame = mesh->frame;
    } else {
        *cloud = std::get<cloud::Cloud>(shape);
    }
    test.points = cloud::make_point_source(cloud);
    test.slice = [cloud](std::size_t first, std::size_t count) { return cloud::slice(*cloud, first, count); };
    return test;
}

TestPoints open_test_points(const std::string& path, const std::optional<units::Units>& units,
                            const std::optional<job::Job>& job)
{
    const auto file = std::make_shared<const core::InputFile>(path);
    const std::string head = read_head(*file);
    if (cloud::looks_like_pcd(head) && !mesh::is_binary_stl(head, file->size())) {
        const auto stream = std::make_shared<const cloud::CloudStream>(file, core::display_name(path), units);
        if (job && job::must_be_moved(stream->frame(), *job)) {
            cloud::Cloud moved = *stream->read_all();
            job::move_to_job_frame(moved, *job);
            return test_points(std::move(moved), stream->units());
        }
        TestPoints test;
        test.frame = stream->frame();
        test.points = stream->points();
        test.slice = [stream](std::size_t first, std::size_t count) { return stream->slice(first, count); };
        test.units = stream->units();
        return test;
    }
    mesh::ShapeFile shape = mesh::read_shape(*file, core::display_name(path), units);
    if (job) job::move_to_job_frame(shape.shape, *job);
    TestPoints test = test_points(shape.shape, shape.units);
    test.repair = shape.repair;
    return test;
}

} // namespace fettle::compare
