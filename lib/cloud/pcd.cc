#include "cloud/pcd.h"

#include "cloud/e57.h"
#include "cloud/element.h"
#include "cloud/fields.h"
#include "cloud/pcd_header.h"
#include "cloud/ply.h"
#include "cloud/ptx.h"
#include "cloud/reach.h"
#include "cloud/xyz.h"
#include "core/content.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"
#include "core/wrong_kind.h"

#include <liblzf/lzf.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace fettle::cloud {

namespace {

/// Copies the elements of a body into x y z and the fields of a cloud.
/// @param by_column  the body is sorted by column, not by point
Cloud gather(const PcdHeader& header, const char* body, bool by_column = false)
{
    Cloud cloud;
    cloud.xyz.setConstant(3, static_cast<Eigen::Index>(header.points), std::numeric_limits<double>::quiet_NaN());
    const char* start = body;
    for (const PcdColumn& column : header.columns) {
        const std::size_t block = column.bytes(), step = by_column ? block : header.stride();
        const std::size_t axis = std::string_view("xyz").find(column.name);
        if (column.name.size() == 1 && axis != std::string_view::npos) {
            visit_element(column.type, column.size, [&](auto zero) {
                for (std::size_t i = 0; i < header.points; ++i)
                    cloud.xyz(axis, i) = static_cast<double>(load<decltype(zero)>(start + i * step));
            });
        } else {
            Field& field = cloud.fields.emplace_back(Field{column.name, column.type, column.size, column.count, {}});
            field.bytes.resize(header.points * block);
            for (std::size_t i = 0; i < header.points; ++i)
                std::memcpy(field.bytes.data() + i * block, start + i * step, block);
        }
        start += by_column ? block * header.points : block;
    }
    return cloud;
}

Cloud read_binary(const PcdHeader& header, std::string_view body, const std::string& source)
{
    check_binary_size(header, body.size(), body.substr(std::min(header.points * header.stride(), body.size())), source);
    return gather(header, body.data());
}

/// Reads a compressed body: two 32-bit sizes, compressed and uncompressed, then the fields one after the other in LZF.
Cloud read_compressed(const PcdHeader& header, std::string_view body, const std::string& source)
{
    constexpr std::size_t kSizesBytes = 2 * sizeof(std::uint32_t);
    constexpr std::size_t kMaxPaddingBytes = 1 << 16; // PCL pads its file to a page, of at most 64 KiB, with zeros
    constexpr std::size_t kMaxCompressionRatio = 88;  // an LZF back reference of three bytes yields at most 264 bytes

    if (body.size() < kSizesBytes)
        throw core::InputError(source,
                               "compressed body of " + std::to_string(body.size()) + " bytes, expected at least 8");
    const std::size_t packed = load<std::uint32_t>(body.data());
    const std::size_t unpacked = load<std::uint32_t>(body.data() + sizeof(std::uint32_t));
    body.remove_prefix(kSizesBytes);
    const std::size_t needed = header.points * header.stride();
    if (unpacked != needed)
        throw core::InputError(source, "POINTS " + std::to_string(header.points) + " need " + std::to_string(needed) +
                                           " bytes, the compressed body says " + std::to_string(unpacked));
    if (packed > body.size())
        throw core::InputError(source, "compressed body of " + std::to_string(packed) + " bytes, there are " +
                                           std::to_string(body.size()));
    std::string_view padding = body.substr(packed);
    if (padding.size() > 1 && padding.ends_with('\n')) padding.remove_suffix(1); // some editors end each file with one
    if (padding.size() > kMaxPaddingBytes || padding.find_first_not_of('\0') != std::string_view::npos)
        throw core::InputError(source, std::to_string(padding.size()) + " bytes after the compressed body");
    if (unpacked > kMaxCompressionRatio * packed)
        throw core::InputError(source, "compressed body of " + std::to_string(packed) + " bytes cannot hold " +
                                           std::to_string(unpacked));
    const auto buffer = std::make_unique_for_overwrite<char[]>(unpacked);
    const bool complete = unpacked == 0 ? packed == 0 // lzf_decompress() needs at least one byte
                                        : lzf_decompress(body.data(), packed, buffer.get(), unpacked) == unpacked;
    if (!complete) throw core::InputError(source, "the compressed body is corrupt");
    return gather(header, buffer.get(), true);
}

/// Parses a row of an ascii body into the bytes of a point.
void parse_row(const PcdHeader& header, const core::FileLines& lines, char* to)
{
    std::string_view line = lines.line();
    std::size_t found = 0;
    for (const PcdColumn& column : header.columns)
        for (int k = 0; k < column.count; ++k, to += column.size, ++found) {
            const std::string_view word = core::next_word(line);
            if (word.empty())
                lines.refuse("expected " + std::to_string(header.values_per_row()) + " numbers, got " +
                             std::to_string(found));
            const bool fits = visit_element(column.type, column.size,
                                            [&](auto zero) { return parse_element<decltype(zero)>(word, to); });
            if (!fits)
                lines.refuse("field '" + column.name + "': " + core::in_quotes(word) + " is not a number of type " +
                             element_name(column.type, column.size));
        }
    if (const std::size_t more = core::words(line).size(); more > 0)
        lines.refuse("expected " + std::to_string(found) + " numbers, got " + std::to_string(found + more));
}

Cloud read_ascii(const PcdHeader& header, std::string_view body, const std::string& source)
{
    const std::size_t min_row_bytes = 2 * header.values_per_row(); // "0 0 0\n"
    if (header.points > 0 && header.points > (body.size() + 1) / min_row_bytes)
        throw core::InputError(source, "POINTS " + std::to_string(header.points) + ", but only " +
                                           std::to_string(body.size()) + " bytes of rows");
    const std::size_t stride = header.stride();
    const auto buffer = std::make_unique_for_overwrite<char[]>(header.points * stride);
    std::size_t rows = 0;
    core::FileLines lines(body, source, header.lines);
    while (lines.next()) {
        if (core::is_blank_line(lines.line())) continue;
        if (rows == header.points)
            lines.refuse(looks_like_pcd(lines.line()) ? "another PCD follows"
                                                      : "more rows than POINTS " + std::to_string(rows));
        parse_row(header, lines, buffer.get() + rows * stride);
        ++rows;
    }
    if (rows < header.points)
        throw core::InputError(source, "POINTS " + std::to_string(header.points) + ", but only " +
                                           std::to_string(rows) + " rows");
    return gather(header, buffer.get());
}

void set_header_data(Cloud& cloud, const PcdHeader& header)
{
    cloud.width = header.height > 1 ? header.width : 0;
    cloud.frame = header.frame;
    cloud.comment = header.stamp;
    cloud.view_origin = header.view_origin;
    cloud.view_orientation = header.view_orientation;
}

// pcl_io is not used: it loads sixty other libraries, which takes longer than the 20 ms allowed for the start of a
// tool, and it allocates memory for POINTS before it checks the size of the file.
CloudFile parse_pcd(std::string_view bytes, const std::string& source, const std::optional<units::Units>& requested)
{
    const PcdHeader header = parse_pcd_header(bytes, source);
    const units::Units units = resolve_units(header.units, requested, source);
    const std::string_view body = bytes.substr(header.body);
    Cloud cloud = header.data == PcdHeader::Data::ascii    ? read_ascii(header, body, source)
                  : header.data == PcdHeader::Data::binary ? read_binary(header, body, source)
                                                           : read_compressed(header, body, source);
    set_header_data(cloud, header);
    return {std::move(cloud), units};
}

} // namespace

Cloud parse_pcd_records(const PcdHeader& header, std::string_view records, const units::Units& units)
{
    PcdHeader part_header = header;
    part_header.points = records.size() / header.stride();
    Cloud cloud = gather(part_header, records.data());
    set_header_data(cloud, header);
    to_base_units(cloud, units);
    return cloud;
}

CloudFile parse_cloud(std::string_view bytes, const std::string& source, std::optional<units::Units> units)
{
    bytes = core::strip_byte_order_mark(bytes, source);
    if (bytes.starts_with('{')) throw core::WrongFileType(source, "JSON, expected points");
    CloudFile file;
    if (looks_like_e57(bytes)) {
        const DeclaredUnits metres{units::Units::Length::m, std::nullopt};
        file.units = resolve_units(metres, units, source);
        file.cloud = parse_e57(bytes, source);
        to_base_units(file.cloud, file.units);
        check_coordinate_range(file.cloud.xyz, source);
        return file;
    }
    const bool is_ply = looks_like_ply(bytes);
    if (is_ply || looks_like_xyz(bytes)) {
        file = {is_ply                  ? parse_ply(bytes, source).vertices
                : looks_like_ptx(bytes) ? parse_ptx(bytes, source)
                                        : parse_xyz(bytes, source),
                units.value_or(units::Units{})};
        check_field_names(file.cloud.fields, source);
    } else {
        if (bytes.starts_with("solid ") || bytes.starts_with("OFF"))
            throw core::WrongFileType(source, "a mesh, expected points");
        if (!looks_like_pcd(bytes)) core::refuse_other_content(bytes, source, "points");
        file = parse_pcd(bytes, source, units);
    }
    to_base_units(file.cloud, file.units);
    check_coordinate_range(file.cloud.xyz, source);
    return file;
}

CloudFile read_cloud(const std::string& path, std::optional<units::Units> units)
{
    return parse_cloud(core::read_file(path), core::display_name(path), units);
}

} // namespace fettle::cloud
