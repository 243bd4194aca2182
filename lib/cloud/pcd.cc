#include "cloud/pcd.h"

#include "cloud/element.h"
#include "cloud/fields.h"
#include "cloud/pcd_header.h"
#include "cloud/ply.h"
#include "cloud/reach.h"
#include "cloud/xyz.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"
#include "core/wrong_kind.h"

#include <liblzf/lzf.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>

namespace fettle {

namespace {

// Where the elements of each field lie in a body: the element block of point i begins at start + i · step.
struct Layout {
    const char* start;
    std::size_t step;
};

// Byte blocks, one a column, taken into x y z and the fields of a cloud.
Cloud gather(const PcdHeader& header, const std::vector<Layout>& layouts)
{
    Cloud cloud;
    cloud.xyz.resize(3, static_cast<Eigen::Index>(header.points));
    for (std::size_t c = 0; c < header.columns.size(); ++c) {
        const PcdColumn& column = header.columns[c];
        const auto [start, step] = layouts[c];
        const std::size_t axis = std::string_view("xyz").find(column.name);
        if (column.name.size() == 1 && axis != std::string_view::npos) {
            visit_element(column.type, column.size, [&, from = start, stride = step](auto zero) {
                for (std::size_t i = 0; i < header.points; ++i)
                    cloud.xyz(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(i)) =
                        static_cast<double>(load<decltype(zero)>(from + i * stride));
            });
            continue;
        }
        Field& field = cloud.fields.emplace_back(Field{column.name, column.type, column.size, column.count, {}});
        const std::size_t block = column.bytes();
        field.bytes.resize(header.points * block);
        for (std::size_t i = 0; i < header.points; ++i)
            std::memcpy(field.bytes.data() + i * block, start + i * step, block);
    }
    return cloud;
}

Cloud gather_binary(const PcdHeader& header, std::string_view body)
{
    std::vector<Layout> layouts;
    const char* start = body.data();
    for (const PcdColumn& column : header.columns) {
        layouts.push_back({start, header.stride()});
        start += column.bytes();
    }
    return gather(header, layouts);
}

Cloud read_binary(const PcdHeader& header, std::string_view body, const std::string& source)
{
    check_binary_size(header, body.size(), body.substr(std::min(header.points * header.stride(), body.size())), source);
    return gather_binary(header, body);
}

// Two 32-bit sizes, compressed and not; then the fields one after the other, all points of one together, in LZF.
Cloud read_compressed(const PcdHeader& header, std::string_view body, const std::string& source)
{
    constexpr std::size_t kSizes = 2 * sizeof(std::uint32_t);
    // PCL fills its file up to a whole page with zeros; 64 KiB is the largest page in use.
    constexpr std::size_t kLargestPage = 1 << 16;
    // An LZF back reference of three bytes stands for 264 bytes at most.
    constexpr std::size_t kBestRatio = 88;

    if (body.size() < kSizes)
        throw InputError(source, "compressed body of " + std::to_string(body.size()) + " bytes, expected at least 8");
    const std::size_t packed = load<std::uint32_t>(body.data());
    const std::size_t unpacked = load<std::uint32_t>(body.data() + sizeof(std::uint32_t));
    body.remove_prefix(kSizes);
    const std::size_t needed = header.points * header.stride();
    if (unpacked != needed)
        throw InputError(source, "POINTS " + std::to_string(header.points) + " need " + std::to_string(needed) +
                                     " bytes, the compressed body says " + std::to_string(unpacked));
    if (packed > body.size())
        throw InputError(source, "compressed body of " + std::to_string(packed) + " bytes, there are " +
                                     std::to_string(body.size()));
    const std::string_view padding = body.substr(packed);
    if (padding.size() > kLargestPage || padding.find_first_not_of('\0') != std::string_view::npos)
        throw InputError(source, std::to_string(padding.size()) + " bytes after the compressed body");
    if (unpacked > kBestRatio * packed)
        throw InputError(source, "compressed body of " + std::to_string(packed) + " bytes cannot hold " +
                                     std::to_string(unpacked));
    const auto buffer = std::make_unique_for_overwrite<char[]>(unpacked);
    const bool whole = unpacked == 0 ? packed == 0 // lzf_decompress() needs a byte at least
                                     : lzf_decompress(body.data(), static_cast<unsigned>(packed), buffer.get(),
                                                      static_cast<unsigned>(unpacked)) == unpacked;
    if (!whole) throw InputError(source, "the compressed body is corrupt");
    std::vector<Layout> layouts;
    const char* start = buffer.get();
    for (const PcdColumn& column : header.columns) {
        layouts.push_back({start, column.bytes()});
        start += column.bytes() * header.points;
    }
    return gather(header, layouts);
}

void parse_row(const PcdHeader& header, std::string_view line, const std::string& place, char* to)
{
    std::size_t found = 0;
    for (const PcdColumn& column : header.columns)
        for (int k = 0; k < column.count; ++k, to += column.size, ++found) {
            const std::string_view word = next_word(line);
            if (word.empty())
                throw InputError(place + "expected " + std::to_string(header.values_per_row()) + " numbers, got " +
                                 std::to_string(found));
            const bool fits = visit_element(column.type, column.size,
                                            [&](auto zero) { return parse_element<decltype(zero)>(word, to); });
            if (!fits)
                throw InputError(place + "field '" + column.name + "': " + in_quotes(word) + " is no number of type " +
                                 element_name(column.type, column.size));
        }
    if (const std::size_t more = words(line).size(); more > 0)
        throw InputError(place + "expected " + std::to_string(found) + " numbers, got " + std::to_string(found + more));
}

Cloud read_ascii(const PcdHeader& header, std::string_view body, const std::string& source)
{
    const std::size_t shortest_row = 2 * header.values_per_row() - 1; // "0 0 0"
    if (header.points > 0 && header.points > (body.size() + 1) / (shortest_row + 1))
        throw InputError(source, "POINTS " + std::to_string(header.points) + ", but only " +
                                     std::to_string(body.size()) + " bytes of rows");
    const std::size_t stride = header.stride();
    const auto buffer = std::make_unique_for_overwrite<char[]>(header.points * stride);
    std::size_t rows = 0;
    Lines lines(body, header.lines);
    while (lines.next()) {
        if (lines.line().find_first_not_of(" \t") == std::string_view::npos) continue;
        const std::string place = source + ": " + lines.place() + ": ";
        if (rows == header.points)
            throw InputError(place + (looks_like_pcd(lines.line()) ? "another PCD follows"
                                                                   : "more rows than POINTS " + std::to_string(rows)));
        parse_row(header, lines.line(), place, buffer.get() + rows * stride);
        ++rows;
    }
    if (rows < header.points)
        throw InputError(source,
                         "POINTS " + std::to_string(header.points) + ", but only " + std::to_string(rows) + " rows");
    std::vector<Layout> layouts;
    const char* start = buffer.get();
    for (const PcdColumn& column : header.columns) {
        layouts.push_back({start, stride});
        start += column.bytes();
    }
    return gather(header, layouts);
}

void convert_to_base(Cloud& cloud, const Units& units)
{
    if (units == Units{}) return;
    cloud.xyz *= units.mm();
    cloud.view_origin *= units.mm();
    for (Field& field : cloud.fields)
        if (const double factor = to_base(units, field_dimension(field.name)); factor != 1) scale(field, factor);
}

void set_layout(Cloud& cloud, const PcdHeader& header)
{
    cloud.width = header.height > 1 ? header.width : 0;
    cloud.view_origin = header.view_origin;
    cloud.view_orientation = header.view_orientation;
}

// Not by pcl_io: it loads sixty other libraries, which costs more than the 20 ms that a tool may take to start. It also
// allocates what POINTS says before it looks at the size of the file.
CloudFile parse_pcd(std::string_view bytes, const std::string& source, const std::optional<Units>& wanted)
{
    const PcdHeader header = parse_pcd_header(bytes, source);
    const Units units = agreed_units(header.units, wanted, source);
    const std::string_view body = bytes.substr(header.body);
    Cloud cloud = header.data == PcdHeader::Data::ascii    ? read_ascii(header, body, source)
                  : header.data == PcdHeader::Data::binary ? read_binary(header, body, source)
                                                           : read_compressed(header, body, source);
    set_layout(cloud, header);
    return {std::move(cloud), units};
}

} // namespace

Cloud parse_pcd_records(const PcdHeader& header, std::string_view records, const Units& units)
{
    PcdHeader of_part = header;
    of_part.points = records.size() / header.stride();
    Cloud cloud = gather_binary(of_part, records);
    set_layout(cloud, header);
    convert_to_base(cloud, units);
    return cloud;
}

CloudFile parse_cloud(std::string_view bytes, const std::string& source, std::optional<Units> units)
{
    bytes = without_mark(bytes, source);
    if (bytes.empty()) throw InputError(source, "empty, expected points");
    if (bytes.front() == '{') throw WrongKind(source, "JSON, expected points");
    CloudFile file;
    const bool is_ply = looks_like_ply(bytes);
    if (is_ply || looks_like_xyz(bytes)) {
        file = {is_ply ? parse_ply(bytes, source).vertices : parse_xyz(bytes, source), units.value_or(Units{})};
        check_names(file.cloud.fields, source);
    } else {
        file = parse_pcd(bytes, source, units);
    }
    convert_to_base(file.cloud, file.units);
    check_reach(file.cloud.xyz, source);
    return file;
}

CloudFile read_cloud(const std::string& path, std::optional<Units> units)
{
    return parse_cloud(read_whole(path), display_name(path), units);
}

} // namespace fettle
