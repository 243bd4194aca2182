#include "cloud/element.h"
#include "cloud/fields.h"
#include "cloud/pcd.h"
#include "core/text.h"

#include <algorithm>
#include <charconv>
#include <ostream>
#include <type_traits>

namespace fettle {

namespace {

constexpr std::string_view kAxes[] = {"x", "y", "z"};

/// What stands in the header of a written field: colours in ascii are written as whole numbers, as PCL does, because
/// as floats they may be NaN and lose their bits.
char written_type(const Field& field, PcdEncoding encoding)
{
    const bool colour = (field.name == "rgb" || field.name == "rgba") && field.size == 4;
    return encoding == PcdEncoding::ascii && colour && field.type == 'F' ? 'U' : field.type;
}

bool any_force(const Cloud& cloud)
{
    return std::any_of(cloud.fields.begin(), cloud.fields.end(),
                       [](const Field& field) { return field_dimension(field.name).force_power != 0; });
}

std::string header_text(const Cloud& cloud, std::size_t points, const std::vector<Field>& fields, const Units& units,
                        PcdEncoding encoding)
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
    std::string text = "# .PCD v0.7 - Point Cloud Data file format\n# units " + to_string(units.length) +
                       (any_force(cloud) ? ' ' + to_string(units.force) : "") + '\n';
    if (!cloud.comment.empty()) text += "# " + cloud.comment + '\n';
    text += "VERSION 0.7\n" + names + '\n' + sizes + '\n' + types + '\n' + counts + "\nWIDTH " + std::to_string(width) +
            "\nHEIGHT " + std::to_string(organised ? points / width : 1) + "\nVIEWPOINT";
    for (int axis = 0; axis < 3; ++axis) text += ' ' + to_text(cloud.view_origin[axis] / units.mm());
    const Eigen::Quaterniond& q = cloud.view_orientation;
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) text += ' ' + to_text(part);
    return text + "\nPOINTS " + std::to_string(points) + "\nDATA " +
           (encoding == PcdEncoding::ascii ? "ascii\n" : "binary\n");
}

/// A field in the unit of the file, of `count` points from `first`.
Field in_file_units(const Field& field, const Units& units, Eigen::Index first, Eigen::Index count)
{
    const std::size_t bytes = static_cast<std::size_t>(field.size) * static_cast<std::size_t>(field.count);
    const auto from = field.bytes.begin() + first * static_cast<std::ptrdiff_t>(bytes);
    Field part{field.name, field.type, field.size, field.count,
               std::vector<std::byte>(from, from + count * static_cast<std::ptrdiff_t>(bytes))};
    if (const double factor = to_base(units, field_dimension(field.name)); factor != 1) scale(part, 1, factor);
    return part;
}

/// Points that are packed at once: what they take stays in the cache.
constexpr Eigen::Index kBlock = 1 << 12;

/// Whole points, one after the other, but field by field, because each field lies together in memory.
void write_packed(std::ostream& out, const Cloud& cloud, const Units& units)
{
    std::vector<char> buffer;
    for (Eigen::Index first = 0; first < cloud.size(); first += kBlock) {
        const Eigen::Index count = std::min(kBlock, cloud.size() - first);
        const auto points = static_cast<std::size_t>(count);
        std::vector<Field> fields;
        std::size_t stride = 3 * sizeof(float);
        for (const Field& field : cloud.fields) {
            fields.push_back(in_file_units(field, units, first, count));
            stride += fields.back().bytes.size() / points;
        }
        buffer.resize(points * stride);
        const auto pack = [&](std::size_t offset, const void* from, auto block) {
            for (std::size_t i = 0; i < points; ++i)
                std::memcpy(buffer.data() + i * stride + offset, static_cast<const char*>(from) + i * block, block);
        };
        const Eigen::Matrix3Xf places = (cloud.xyz.middleCols(first, count) / units.mm()).cast<float>();
        std::size_t offset = 3 * sizeof(float);
        pack(0, places.data(), std::integral_constant<std::size_t, 3 * sizeof(float)>{});
        for (const Field& field : fields) {
            const std::size_t block = field.bytes.size() / points;
            if (block == sizeof(float)) // nearly always; the constant makes the copy one instruction
                pack(offset, field.bytes.data(), std::integral_constant<std::size_t, sizeof(float)>{});
            else
                pack(offset, field.bytes.data(), block);
            offset += block;
        }
        out.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    }
}

template <typename T>
void append(std::string& text, T value)
{
    if constexpr (std::is_floating_point_v<T>) {
        text += to_text(value);
    } else {
        char digits[24]; // of 64 bits, with a sign
        text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    }
}

std::string rows(const Eigen::Matrix3Xd& xyz, const std::vector<Field>& fields, PcdEncoding encoding)
{
    std::string text;
    for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            if (axis > 0) text += ' ';
            append(text, static_cast<float>(xyz(axis, i)));
        }
        for (const Field& field : fields) {
            const std::size_t first = static_cast<std::size_t>(i) * static_cast<std::size_t>(field.count);
            for (std::size_t k = first; k < first + static_cast<std::size_t>(field.count); ++k)
                visit_element(written_type(field, encoding), field.size, [&](auto zero) {
                    text += ' ';
                    append(text, load<decltype(zero)>(field.bytes.data() + k * sizeof zero));
                });
        }
        text += '\n';
    }
    return text;
}

} // namespace

void write_pcd_header(std::ostream& out, const Cloud& some, std::size_t points, const Units& units,
                      PcdEncoding encoding)
{
    std::vector<Field> fields; // empty, but of the types that are written
    for (const Field& field : some.fields) fields.push_back(in_file_units(field, units, 0, 0));
    out << header_text(some, points, fields, units, encoding);
}

void write_pcd_points(std::ostream& out, const Cloud& part, const Units& units, PcdEncoding encoding)
{
    if (encoding == PcdEncoding::binary) {
        write_packed(out, part, units);
        return;
    }
    std::vector<Field> fields;
    for (const Field& field : part.fields) fields.push_back(in_file_units(field, units, 0, part.size()));
    out << rows(part.xyz / units.mm(), fields, encoding);
}

void write_pcd(std::ostream& out, const Cloud& cloud, const Units& units, PcdEncoding encoding)
{
    write_pcd_header(out, cloud, static_cast<std::size_t>(cloud.size()), units, encoding);
    write_pcd_points(out, cloud, units, encoding);
}

} // namespace fettle
