#include "mesh/stl.h"

#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/equal_corners.h"
#include "mesh/mesh_file.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <ostream>
#include <vector>

namespace fettle::mesh {

namespace {

constexpr std::size_t kTextBytes = 80;                // free text at the beginning of a binary file
constexpr std::string_view kJobFrame = ", frame job"; // in that text, of a mesh in a job's frame
constexpr std::size_t kCornersOffset = 12;            // offset of the corners in a facet, after its normal
constexpr std::size_t kMaxCorners = 1u << 30;         // corners of all facets, see weld_facets()

std::uint32_t declared_triangles(std::string_view bytes)
{
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kTextBytes, sizeof count);
    return count;
}

bool equal_ignoring_case(std::string_view word, std::string_view lower_case)
{
    return std::ranges::equal(word, lower_case,
                              [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

/// Parses ASCII STL. Any white space separates words; keywords may have any case.
class AsciiStlParser {
  public:
    AsciiStlParser(std::string_view text, const std::string& source) : text_(text), source_(source) {}

    /// Returns the corners of all facets, three per facet.
    std::vector<Corner<double>> parse()
    {
        std::vector<Corner<double>> corners;
        expect("solid");
        skip_line();
        for (;;) {
            const std::string_view word = next();
            if (equal_ignoring_case(word, "facet")) {
                parse_facet(corners);
            } else if (equal_ignoring_case(word, "endsolid")) {
                skip_line();
                if (at_end()) return corners;
                expect("solid");
                skip_line();
            } else {
                refuse(word, "facet or endsolid");
            }
        }
    }

  private:
    void parse_facet(std::vector<Corner<double>>& corners)
    {
        expect("normal");
        for (int k = 0; k < 3; ++k) number(); // ignored: the corners determine it
        expect("outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            const double x = number(), y = number(), z = number();
            corners.push_back({x, y, z});
        }
        expect("endloop");
        expect("endfacet");
    }

    std::string_view next()
    {
        position_ = std::min(text_.find_first_not_of(kSpace, position_), text_.size());
        const std::size_t end = std::min(text_.find_first_of(kSpace, position_), text_.size());
        const std::string_view word = text_.substr(position_, end - position_);
        position_ = end;
        return word;
    }

    void skip_line() { position_ = std::min(text_.find_first_of("\r\n", position_), text_.size()); }

    bool at_end() const { return text_.find_first_not_of(kSpace, position_) == std::string_view::npos; }

    void expect(std::string_view keyword)
    {
        const std::string_view word = next();
        if (!equal_ignoring_case(word, keyword)) refuse(word, std::string(keyword));
    }

    double number()
    {
        const std::string_view word = next();
        const std::optional<double> value = core::parse_number(word);
        if (!value) refuse(word, "a number");
        return *value;
    }

    [[noreturn]] void refuse(std::string_view word, const std::string& expected) const
    {
        const auto before = text_.substr(0, position_);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        throw core::InputError(source_, "line " + std::to_string(line) + ": expected " + expected + ", got " +
                                            (word.empty() ? "the end of the file" : core::in_quotes(word)));
    }

    static constexpr std::string_view kSpace = " \t\r\n\v\f";
    std::string_view text_;
    std::size_t position_ = 0;
    const std::string& source_;
};

/// Size of a binary STL, bytes.
std::uint64_t binary_stl_size(std::uint32_t triangles)
{
    return kStlHeaderBytes + std::uint64_t{kStlTriangleBytes} * triangles;
}

/// Whether no coordinate of a facet is beyond what parts have in any unit, and not all are 0.
bool has_plausible_corners(const char* facet)
{
    constexpr float kMin = 1e-12F, kMax = 1e12F;
    float coordinates[9];
    std::memcpy(coordinates, facet + kCornersOffset, sizeof coordinates);
    const auto is_plausible = [](float c) { return c == 0 || (std::abs(c) >= kMin && std::abs(c) <= kMax); };
    return std::ranges::all_of(coordinates, is_plausible) &&
           std::ranges::any_of(coordinates, [](float c) { return c != 0; });
}

/// Describes why the bytes are not a binary STL.
std::string describe_size_error(std::string_view bytes)
{
    if (bytes.size() < kStlHeaderBytes)
        return "binary STL of " + std::to_string(bytes.size()) + " bytes, expected at least " +
               std::to_string(kStlHeaderBytes);
    const std::uint32_t count = declared_triangles(bytes);
    if (binary_stl_size(__builtin_bswap32(count)) == bytes.size())
        return "binary STL in big-endian order, expected little-endian";
    return "binary STL of " + std::to_string(count) + " triangles needs " + std::to_string(binary_stl_size(count)) +
           " bytes, there are " + std::to_string(bytes.size());
}

} // namespace

bool is_binary_stl(std::string_view bytes) { return is_binary_stl(bytes, bytes.size()); }

bool is_binary_stl(std::string_view head, std::size_t size)
{
    return head.size() >= kStlHeaderBytes && size == binary_stl_size(declared_triangles(head));
}

bool looks_like_damaged_stl(std::string_view bytes)
{
    if (bytes.size() < kStlHeaderBytes) return false;
    if (binary_stl_size(__builtin_bswap32(declared_triangles(bytes))) == bytes.size()) return true;
    constexpr std::size_t kMaxFacets = 100; // random bytes are plausible once in 10^5 facets
    const std::size_t facets = std::min((bytes.size() - kStlHeaderBytes) / kStlTriangleBytes, kMaxFacets);
    std::size_t plausible = 0;
    for (std::size_t i = 0; i < facets; ++i)
        plausible += has_plausible_corners(bytes.data() + kStlHeaderBytes + i * kStlTriangleBytes);
    return 2 * plausible > facets;
}

std::string read_binary_stl_header(const core::InputFile& file)
{
    std::string head(std::min(file.size(), kStlHeaderBytes), '\0');
    file.read(0, head.data(), head.size());
    return is_binary_stl(head, file.size()) ? head : "";
}

bool looks_like_ascii_stl(std::string_view bytes)
{
    constexpr std::size_t kMaxNameBytes = 1 << 12; // longer than any name of a solid, which precedes the first facet
    std::string start(bytes.substr(0, kMaxNameBytes));
    std::transform(start.begin(), start.end(), start.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::size_t first = start.find_first_not_of(" \t\r\n");
    return first != std::string::npos && start.compare(first, 5, "solid") == 0 &&
           (start.find("facet") != std::string::npos || start.find("endsolid") != std::string::npos);
}

Mesh parse_stl(std::string_view bytes, const std::string& source, MeshRepair& repair)
{
    if (is_binary_stl(bytes))
        return read_binary_stl(
            bytes.substr(0, kStlHeaderBytes),
            [&](std::size_t offset, char* to, std::size_t count) { std::memcpy(to, bytes.data() + offset, count); },
            source, repair);
    if (!looks_like_ascii_stl(bytes)) throw core::InputError(source, describe_size_error(bytes));
    const std::vector<Corner<double>> corners = AsciiStlParser(bytes, source).parse();
    const auto copy = [&](std::size_t first, std::size_t count, Corner<double>* to) {
        std::copy_n(corners.data() + 3 * first, 3 * count, to);
    };
    return weld_facets<double>(corners.size() / 3, copy, repair);
}

Mesh read_binary_stl(std::string_view head, const ByteReader& read, const std::string& source, MeshRepair& repair)
{
    const std::size_t facets = declared_triangles(head);
    if (3 * facets >= kMaxCorners) throw core::InputError(source, std::to_string(facets) + " triangles are too many");
    tbb::enumerable_thread_specific<std::vector<char>> thread_buffers;
    const auto copy = [&](std::size_t first, std::size_t count, Corner<float>* to) {
        std::vector<char>& bytes = thread_buffers.local();
        bytes.resize(std::max(bytes.size(), kStlTriangleBytes * count));
        read(kStlHeaderBytes + kStlTriangleBytes * first, bytes.data(), kStlTriangleBytes * count);
        for (std::size_t f = 0; f < count; ++f)
            std::memcpy(to + 3 * f, bytes.data() + kStlTriangleBytes * f + kCornersOffset, 3 * sizeof(Corner<float>));
    };
    Mesh mesh = weld_facets<float>(facets, copy, repair);
    if (head.substr(0, kTextBytes).find(kJobFrame) != std::string_view::npos) mesh.frame = cloud::Frame::job;
    return mesh;
}

std::string make_stl_header(std::size_t triangles, units::Units::Length unit, cloud::Frame frame)
{
    std::string header =
        "binary STL, units " + units::to_string(unit) + (frame == cloud::Frame::job ? std::string(kJobFrame) : "");
    header.resize(kStlHeaderBytes);
    const auto count = static_cast<std::uint32_t>(triangles);
    std::memcpy(header.data() + kTextBytes, &count, sizeof count);
    return header;
}

void encode_stl_triangles(const Mesh& part, units::Units::Length unit, char* to)
{
    const Eigen::Matrix3Xd normals = triangle_normals(part);
    const double scale = units::mm_per(unit);
    for (Eigen::Index t = 0; t < part.triangles.cols(); ++t, to += kStlTriangleBytes) {
        Eigen::Matrix<float, 3, 4> facet;
        facet.col(0) = normals.col(t).cast<float>();
        for (int k = 0; k < 3; ++k) facet.col(k + 1) = (part.vertices.col(part.triangles(k, t)) / scale).cast<float>();
        std::memcpy(to, facet.data(), sizeof(float) * 12);
        std::memset(to + sizeof(float) * 12, 0, 2);
    }
}

void write_stl(std::ostream& out, const Mesh& mesh, units::Units::Length unit)
{
    const auto count = static_cast<std::size_t>(mesh.triangles.cols());
    const auto buffer = std::make_unique_for_overwrite<char[]>(kStlTriangleBytes * count);
    encode_stl_triangles(mesh, unit, buffer.get());
    out << make_stl_header(count, unit, mesh.frame);
    out.write(buffer.get(), static_cast<std::streamsize>(kStlTriangleBytes * count));
}

} // namespace fettle::mesh
