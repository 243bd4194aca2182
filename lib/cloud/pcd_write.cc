#include "cloud/cloud_encoder.h"
#include "cloud/pcd.h"
#include "core/text.h"

#include <algorithm>
#include <cstring>
#include <ostream>
#include <type_traits>

namespace fettle::cloud {

namespace {

constexpr std::string_view kAxes[] = {"x", "y", "z"};

/// Type of a field in the file. In ascii, colours are written as integers, as in PCL, because as floats they may be NaN
/// and lose their bits.
char written_type(const Field& field, PcdEncoding encoding)
{
    const bool colour = (field.name == "rgb" || field.name == "rgba") && field.size == 4;
    return encoding == PcdEncoding::ascii && colour && field.type == 'F' ? 'U' : field.type;
}

bool has_force(const Cloud& cloud)
{
    return std::any_of(cloud.fields.begin(), cloud.fields.end(),
                       [](const Field& field) { return field_dimension(field.name).force_power != 0; });
}

std::string header_text(const Cloud& cloud, std::size_t points, const std::vector<Field>& fields,
                        const units::Units& units, PcdEncoding encoding)
{
    std::string names = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
    const auto add = [&](std::string_view name, char type, int size, int count) {
        names += ' ' + std::string(name);
        sizes += ' ' + std::to_string(size);
        types += std::string(" ") + type;
        counts += ' ' + std::to_string(count);
    };
    for (const std::string_view axis : kAxes) add(axis, 'F', sizeof(float), 1);
    for (const Field& field : fields) add(field.name, written_type(field, encoding), field.size, field.count);

    const bool organised = cloud.width > 0 && points % cloud.width == 0 && points > 0;
    const std::size_t width = organised ? cloud.width : points;
    std::string text = "# .PCD v0.7 - Point Cloud Data file format\n# units " + units::to_string(units.length) +
                       (has_force(cloud) ? ' ' + units::to_string(units.force) : "") + '\n';
    if (cloud.frame == Frame::job) text += "# frame job\n";
    if (!cloud.comment.empty()) text += "# " + cloud.comment + '\n';
    text += "VERSION 0.7\n" + names + '\n' + sizes + '\n' + types + '\n' + counts + "\nWIDTH " + std::to_string(width) +
            "\nHEIGHT " + std::to_string(organised ? points / width : 1) + "\nVIEWPOINT";
    for (int axis = 0; axis < 3; ++axis) text += ' ' + core::to_text(cloud.view_origin[axis] / units.mm());
    const Eigen::Quaterniond& q = cloud.view_orientation;
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) text += ' ' + core::to_text(part);
    return text + "\nPOINTS " + std::to_string(points) + "\nDATA " +
           (encoding == PcdEncoding::ascii ? "ascii\n" : "binary\n");
}

constexpr Eigen::Index kPackedPoints = 1 << 12; // packed at once: their bytes fit the processor's cache

/// Writes points in binary, one after the other. Each block is packed field by field, as the fields lie in memory.
void write_packed(std::ostream& out, const Cloud& cloud, const units::Units& units)
{
    std::vector<char> buffer;
    for (Eigen::Index first = 0; first < cloud.size(); first += kPackedPoints) {
        Cloud some = slice(cloud, first, std::min(kPackedPoints, cloud.size() - first));
        const std::size_t points = some.size();
        const std::vector<Field> fields = to_file_units(std::move(some.fields), units);
        std::size_t stride = 3 * sizeof(float);
        for (const Field& field : fields) stride += field.stride();
        buffer.resize(points * stride);
        const auto pack = [&](std::size_t offset, const void* from, auto block) {
            for (std::size_t i = 0; i < points; ++i)
                std::memcpy(buffer.data() + i * stride + offset, static_cast<const char*>(from) + i * block, block);
        };
        const Eigen::Matrix3Xf xyz = to_file_coordinates(some, units);
        std::size_t offset = 3 * sizeof(float);
        pack(0, xyz.data(), std::integral_constant<std::size_t, 3 * sizeof(float)>{});
        for (const Field& field : fields) {
            const std::size_t block = field.stride();
            if (block == sizeof(float)) // nearly always: then the constant makes the copy one instruction
                pack(offset, field.bytes.data(), std::integral_constant<std::size_t, sizeof(float)>{});
            else
                pack(offset, field.bytes.data(), block);
            offset += block;
        }
        out.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    }
}

} // namespace

void write_pcd_header(std::ostream& out, const Cloud& some, std::size_t points, const units::Units& units,
                      PcdEncoding encoding)
{
    // The types of the fields may change with the units.
    out << header_text(some, points, to_file_units(slice(some, 0, 0).fields, units), units, encoding);
}

void write_pcd_points(std::ostream& out, const Cloud& part, const units::Units& units, PcdEncoding encoding)
{
    if (encoding == PcdEncoding::binary)
        write_packed(out, part, units);
    else
        out << text_rows(to_file_coordinates(part, units), to_file_units(part.fields, units), ' ',
                         [](const Field& field) { return written_type(field, PcdEncoding::ascii); });
}

void write_pcd(std::ostream& out, const Cloud& cloud, const units::Units& units, PcdEncoding encoding)
{
    write_pcd_header(out, cloud, cloud.size(), units, encoding);
    write_pcd_points(out, cloud, units, encoding);
}

} // namespace fettle::cloud
