#include "cloud/element.h"
#include "cloud/fields.h"
#include "cloud/pcd.h"
#include "core/text.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <ostream>

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

std::string header_text(const Cloud& cloud, const std::vector<Field>& fields, const Units& units, PcdEncoding encoding)
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

    const auto points = static_cast<std::size_t>(cloud.size());
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

// Whole points, one after the other: field by field, because each field lies together in memory.
std::unique_ptr<char[]> packed(const Eigen::Matrix3Xd& xyz, const std::vector<Field>& fields, std::size_t stride)
{
    const auto points = static_cast<std::size_t>(xyz.cols());
    auto buffer = std::make_unique_for_overwrite<char[]>(points * stride);
    for (std::size_t i = 0; i < points; ++i)
        for (int axis = 0; axis < 3; ++axis)
            store(buffer.get() + i * stride + static_cast<std::size_t>(axis) * sizeof(float),
                  static_cast<float>(xyz(axis, static_cast<Eigen::Index>(i))));
    char* to = buffer.get() + 3 * sizeof(float);
    for (const Field& field : fields) {
        const std::size_t block = field.bytes.size() / std::max<std::size_t>(points, 1);
        if (block == sizeof(float)) // nearly always; the constant size makes the copy one instruction
            for (std::size_t i = 0; i < points; ++i)
                std::memcpy(to + i * stride, field.bytes.data() + i * sizeof(float), sizeof(float));
        else
            for (std::size_t i = 0; i < points; ++i)
                std::memcpy(to + i * stride, field.bytes.data() + i * block, block);
        to += block;
    }
    return buffer;
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

void write_pcd(std::ostream& out, const Cloud& cloud, const Units& units, PcdEncoding encoding)
{
    const Eigen::Matrix3Xd xyz = cloud.xyz / units.mm();
    std::vector<Field> fields = cloud.fields;
    std::size_t stride = 3 * sizeof(float);
    for (Field& field : fields) {
        if (const double factor = to_base(units, field_dimension(field.name)); factor != 1) scale(field, 1, factor);
        stride += static_cast<std::size_t>(field.size) * static_cast<std::size_t>(field.count);
    }
    out << header_text(cloud, fields, units, encoding);
    if (encoding == PcdEncoding::ascii)
        out << rows(xyz, fields, encoding);
    else
        out.write(packed(xyz, fields, stride).get(), static_cast<std::streamsize>(stride) * cloud.size());
}

} // namespace fettle
