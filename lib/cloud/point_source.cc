#include "cloud/point_source.h"

#include "cloud/element.h"
#include "cloud/pcd_header.h"
#include "cloud/ply.h"
#include "cloud/xyz.h"
#include "core/lines.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace fettle::cloud {

namespace {

// Largest block: small enough for the processor's cache, large enough to keep calls few.
constexpr std::size_t kMaxBlockPoints = 8192;
constexpr std::size_t kMaxBlockBytes = 1 << 18;

/// Location of a scalar field in the bytes of a point.
struct FieldLayout {
    std::size_t offset = 0;
    char type = 'F';
    int size = 4;
};

std::optional<FieldLayout> find_layout(const PcdHeader& header, std::string_view name)
{
    std::size_t offset = 0;
    for (const PcdColumn& column : header.columns) {
        if (column.name == name && column.count == 1) return FieldLayout{offset, column.type, column.size};
        offset += column.bytes();
    }
    return std::nullopt;
}

/// Decodes one field of `count` points, multiplied by `factor`, into every `step`-th double.
/// @param stride  bytes of a point
void decode(const char* bytes, std::size_t stride, std::size_t count, const FieldLayout& layout, double factor,
            double* to, std::size_t step)
{
    visit_element(layout.type, layout.size, [&](auto zero) {
        const char* from = bytes + layout.offset;
        for (std::size_t i = 0; i < count; ++i, from += stride, to += step)
            *to = static_cast<double>(load<decltype(zero)>(from)) * factor;
    });
}

/// z of the normals made unit; NaN for a normal without length.
Eigen::VectorXd unit_z(const Eigen::Matrix3Xd& normals)
{
    return normals.row(2).transpose().cwiseQuotient(normals.colwise().norm().transpose());
}

PointSource make_binary_source(const PcdHeader& header, std::shared_ptr<const core::InputFile> file, std::size_t body,
                               double mm)
{
    PointSource source;
    source.points = header.points;
    const std::size_t stride = header.stride();
    source.block_size = std::clamp<std::size_t>(kMaxBlockBytes / stride, 1, kMaxBlockPoints);
    const std::array<FieldLayout, 3> axes = {*find_layout(header, "x"), *find_layout(header, "y"),
                                             *find_layout(header, "z")};
    const std::optional<FieldLayout> role = find_layout(header, "role");
    source.has_roles = role.has_value();
    const std::array<std::optional<FieldLayout>, 3> normal = {
        find_layout(header, "normal_x"), find_layout(header, "normal_y"), find_layout(header, "normal_z")};
    source.has_normals = normal[0] && normal[1] && normal[2];
    source.read = [=, has_normals = source.has_normals](std::size_t first, std::size_t count, PointBlock& into) {
        const auto bytes = std::make_unique_for_overwrite<char[]>(count * stride);
        file->read(body + first * stride, bytes.get(), count * stride);
        into.xyz.resize(3, count);
        for (std::size_t axis = 0; axis < axes.size(); ++axis)
            decode(bytes.get(), stride, count, axes[axis], mm, into.xyz.data() + axis, axes.size());
        if (has_normals) {
            Eigen::Matrix3Xd normals(3, count);
            for (std::size_t axis = 0; axis < normal.size(); ++axis)
                decode(bytes.get(), stride, count, *normal[axis], 1, normals.data() + axis, normal.size());
            into.normal_z = unit_z(normals);
        }
        if (!role) return;
        into.roles.resize(count);
        decode(bytes.get(), stride, count, *role, 1, into.roles.data(), 1);
    };
    return source;
}

} // namespace

void for_each_block(const PointSource& points, const std::function<void(std::size_t, const PointBlock&)>& use)
{
    tbb::enumerable_thread_specific<PointBlock> thread_blocks;
    tbb::parallel_for(std::size_t{0}, points.block_count(), [&](std::size_t b) {
        PointBlock& block = thread_blocks.local();
        const std::size_t first = b * points.block_size;
        points.read(first, std::min(points.block_size, points.points - first), block);
        use(b, block);
    });
}

PointSource make_point_source(std::shared_ptr<const Cloud> cloud)
{
    PointSource source;
    source.points = cloud->size();
    source.block_size = kMaxBlockPoints;
    source.has_roles = has_field(*cloud, "role");
    const auto roles = std::make_shared<Eigen::VectorXd>();
    if (source.has_roles) *roles = field(*cloud, "role");
    source.has_normals = has_normals(*cloud);
    const auto normal_z = std::make_shared<Eigen::VectorXd>();
    if (source.has_normals) *normal_z = unit_z(normals(*cloud));
    source.read = [cloud = std::move(cloud), roles, normal_z](std::size_t first, std::size_t count, PointBlock& into) {
        into.xyz = cloud->xyz.middleCols(first, count);
        if (roles->size() > 0) into.roles = roles->segment(first, count);
        if (normal_z->size() > 0) into.normal_z = normal_z->segment(first, count);
    };
    return source;
}

CloudStream::CloudStream(const std::string& path, std::optional<units::Units> units)
    : CloudStream(std::make_shared<const core::InputFile>(path), core::display_name(path), units)
{
}

CloudStream::CloudStream(std::shared_ptr<const core::InputFile> file, const std::string& name,
                         std::optional<units::Units> units)
{
    const auto read_all = [file, name, units] { return parse_cloud(file->read_all(), name, units); };
    constexpr std::size_t kMaxHeaderBytes = 1 << 20; // files that are not longer are read entirely
    std::string head(std::min(file->size(), kMaxHeaderBytes), '\0');
    file->read(0, head.data(), head.size());
    const std::string_view text = core::strip_byte_order_mark(head, name);
    std::optional<PcdHeader> header;
    if (file->size() > kMaxHeaderBytes && !looks_like_ply(text) && !looks_like_xyz(text) &&
        text.find("\nDATA ") != std::string_view::npos)
        header = parse_pcd_header(text, name);
    if (!header || header->data != PcdHeader::Data::binary) {
        CloudFile read = read_all();
        const auto cloud = std::make_shared<const Cloud>(std::move(read.cloud));
        units_ = read.units;
        frame_ = cloud->frame;
        load_ = [cloud] { return cloud; };
        part_ = [cloud](std::size_t first, std::size_t count) { return cloud::slice(*cloud, first, count); };
        points_ = make_point_source(cloud);
        return;
    }
    const std::size_t body = head.size() - text.size() + header->body;
    const std::size_t available = file->size() - body;
    const std::size_t needed = header->points * header->stride();
    std::string next(available > needed ? std::min(available - needed, kMaxHeaderBytes) : 0, '\0');
    file->read(body + needed, next.data(), next.size());
    check_binary_size(*header, available, next, name);
    units_ = resolve_units(header->units, units, name);
    frame_ = header->frame;
    load_ = [read_all] { return std::make_shared<const Cloud>(read_all().cloud); };
    part_ = [file, body, h = *header, in = units_](std::size_t first, std::size_t count) {
        std::string records(count * h.stride(), '\0');
        file->read(body + first * h.stride(), records.data(), records.size());
        return parse_pcd_records(h, records, in);
    };
    points_ = make_binary_source(*header, file, body, units_.mm());
}

std::shared_ptr<const Cloud> CloudStream::read_all() const { return load_(); }

} // namespace fettle::cloud
