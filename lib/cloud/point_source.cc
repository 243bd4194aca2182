#include "cloud/point_source.h"

#include "cloud/element.h"
#include "cloud/pcd_header.h"
#include "cloud/ply.h"
#include "cloud/xyz.h"
#include "core/file.h"
#include "core/lines.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace fettle {

namespace {

// Of a block: small enough for the processor's cache, large enough to make the calls few.
constexpr std::size_t kBlockPoints = 8192;
constexpr std::size_t kBlockBytes = 1 << 18;

/// Where a field lies in a point's bytes.
struct Place {
    std::size_t offset = 0;
    char type = 'F';
    int size = 4;
};

std::optional<Place> place_of(const PcdHeader& header, std::string_view name)
{
    std::size_t offset = 0;
    for (const PcdColumn& column : header.columns) {
        if (column.name == name && column.count == 1) return Place{offset, column.type, column.size};
        offset += column.bytes();
    }
    return std::nullopt;
}

/// Numbers of one field, each times `factor`, to every `step`-th double.
void decode(const char* bytes, std::size_t stride, std::size_t count, const Place& place, double factor, double* to,
            std::size_t step)
{
    visit_element(place.type, place.size, [&](auto zero) {
        const char* from = bytes + place.offset;
        for (std::size_t i = 0; i < count; ++i, from += stride, to += step)
            *to = static_cast<double>(load<decltype(zero)>(from)) * factor;
    });
}

PointSource binary_source(const PcdHeader& header, std::shared_ptr<const InputFile> file, std::size_t body, double mm)
{
    PointSource source;
    source.points = header.points;
    const std::size_t stride = header.stride();
    source.block = std::clamp<std::size_t>(kBlockBytes / stride, 1, kBlockPoints);
    const std::array<Place, 3> axes = {*place_of(header, "x"), *place_of(header, "y"), *place_of(header, "z")};
    const std::optional<Place> role = place_of(header, "role");
    source.has_roles = role.has_value();
    source.read = [=](std::size_t first, std::size_t count, PointBlock& into) {
        const auto bytes = std::make_unique_for_overwrite<char[]>(count * stride);
        file->read(body + first * stride, bytes.get(), count * stride);
        into.xyz.resize(3, static_cast<Eigen::Index>(count));
        for (std::size_t axis = 0; axis < axes.size(); ++axis)
            decode(bytes.get(), stride, count, axes[axis], mm, into.xyz.data() + axis, axes.size());
        if (!role) return;
        into.roles.resize(static_cast<Eigen::Index>(count));
        decode(bytes.get(), stride, count, *role, 1, into.roles.data(), 1);
    };
    return source;
}

} // namespace

void for_each_block(const PointSource& points, const std::function<void(std::size_t, const PointBlock&)>& use)
{
    tbb::enumerable_thread_specific<PointBlock> rooms;
    tbb::parallel_for(std::size_t{0}, points.blocks(), [&](std::size_t b) {
        PointBlock& block = rooms.local();
        const std::size_t first = b * points.block;
        points.read(first, std::min(points.block, points.points - first), block);
        use(b, block);
    });
}

PointSource point_source(std::shared_ptr<const Cloud> cloud)
{
    PointSource source;
    source.points = static_cast<std::size_t>(cloud->size());
    source.block = kBlockPoints;
    source.has_roles = has_field(*cloud, "role");
    const auto roles = std::make_shared<Eigen::VectorXd>();
    if (source.has_roles) *roles = field(*cloud, "role");
    source.read = [cloud = std::move(cloud), roles](std::size_t first, std::size_t count, PointBlock& into) {
        const auto from = static_cast<Eigen::Index>(first), size = static_cast<Eigen::Index>(count);
        into.xyz = cloud->xyz.middleCols(from, size);
        if (roles->size() > 0) into.roles = roles->segment(from, size);
    };
    return source;
}

CloudStream::CloudStream(const std::string& path, std::optional<Units> units)
    : CloudStream(std::make_shared<const InputFile>(path), display_name(path), units)
{
}

CloudStream::CloudStream(std::shared_ptr<const InputFile> file, const std::string& name, std::optional<Units> units)
{
    const auto all = [file, name, units] {
        std::string bytes(file->size(), '\0');
        file->read(0, bytes.data(), bytes.size());
        return parse_cloud(bytes, name, units);
    };
    constexpr std::size_t kHead = 1 << 20; // longer than any real header; a file that fits is read whole
    std::string head(std::min(file->size(), kHead), '\0');
    file->read(0, head.data(), head.size());
    const std::string_view text = without_mark(head, name);
    std::optional<PcdHeader> header;
    if (file->size() > kHead && !looks_like_ply(text) && !looks_like_xyz(text) &&
        text.find("\nDATA ") != std::string_view::npos)
        header = parse_pcd_header(text, name);
    if (!header || header->data != PcdHeader::Data::binary) {
        CloudFile read = all();
        const auto cloud = std::make_shared<const Cloud>(std::move(read.cloud));
        units_ = read.units;
        whole_ = [cloud] { return cloud; };
        part_ = [cloud](std::size_t first, std::size_t count) {
            return fettle::part(*cloud, static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count));
        };
        points_ = point_source(cloud);
        return;
    }
    const std::size_t body = head.size() - text.size() + header->body;
    const std::size_t there = file->size() - body;
    const std::size_t needed = header->points * header->stride();
    std::string next(there > needed ? std::min(there - needed, kHead) : 0, '\0');
    file->read(body + needed, next.data(), next.size());
    check_binary_size(*header, there, next, name);
    units_ = agreed_units(header->units, units, name);
    whole_ = [all] { return std::make_shared<const Cloud>(all().cloud); };
    part_ = [file, body, h = *header, in = units_](std::size_t first, std::size_t count) {
        std::string records(count * h.stride(), '\0');
        file->read(body + first * h.stride(), records.data(), records.size());
        return parse_pcd_records(h, records, in);
    };
    points_ = binary_source(*header, file, body, units_.mm());
}

std::shared_ptr<const Cloud> CloudStream::cloud() const { return whole_(); }

} // namespace fettle
