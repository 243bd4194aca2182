#include "mesh/stl.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/equal_corners.h"
#include "mesh/mesh_file.h"

#include <Eigen/Geometry>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <ostream>
#include <vector>

namespace fettle {

namespace {

constexpr std::size_t kHeader = 80;            // bytes of free text in a binary file
constexpr std::size_t kPrelude = kStlHead;     // and the number of triangles
constexpr std::size_t kCorners = 12;           // offset of the corners in a facet
constexpr std::size_t kMostCorners = 1u << 30; // of all facets

std::uint32_t stated_triangles(std::string_view bytes)
{
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kHeader, sizeof count);
    return count;
}

bool same_word(std::string_view word, std::string_view lower_case)
{
    return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

// Words of an ASCII STL; any blank and any line end separates them, keywords may have any case.
class AsciiStl {
  public:
    AsciiStl(std::string_view text, const std::string& source) : text_(text), source_(source) {}

    /// The corners of all facets.
    std::vector<Corner<double>> parse()
    {
        std::vector<Corner<double>> corners;
        expect("solid");
        skip_line();
        for (;;) {
            const std::string_view word = next();
            if (same_word(word, "facet")) {
                parse_facet(corners);
            } else if (same_word(word, "endsolid")) {
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
        for (int k = 0; k < 3; ++k) number(); // whatever it says: the corners tell
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
        if (!same_word(word, keyword)) refuse(word, std::string(keyword));
    }

    double number()
    {
        const std::string_view word = next();
        const std::optional<double> value = parse_number(word);
        if (!value) refuse(word, "a number");
        return *value;
    }

    [[noreturn]] void refuse(std::string_view word, const std::string& expected) const
    {
        const auto before = text_.substr(0, position_);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        throw InputError(source_, "line " + std::to_string(line) + ": expected " + expected + ", got " +
                                      (word.empty() ? "the end of the file" : in_quotes(word)));
    }

    static constexpr std::string_view kSpace = " \t\r\n\v\f";
    std::string_view text_;
    std::size_t position_ = 0;
    const std::string& source_;
};

std::string size_problem(std::string_view bytes)
{
    if (bytes.size() < kPrelude)
        return "binary STL of " + std::to_string(bytes.size()) + " bytes, expected at least " +
               std::to_string(kPrelude);
    const std::uint32_t count = stated_triangles(bytes);
    const std::uint64_t needed = kPrelude + std::uint64_t{kStlTriangle} * count;
    const std::uint64_t swapped = kPrelude + std::uint64_t{kStlTriangle} * __builtin_bswap32(count);
    if (swapped == bytes.size()) return "binary STL in big-endian order, expected little-endian";
    return "binary STL of " + std::to_string(count) + " triangles needs " + std::to_string(needed) +
           " bytes, there are " + std::to_string(bytes.size());
}

} // namespace

bool is_binary_stl(std::string_view bytes) { return is_binary_stl(bytes, bytes.size()); }

bool is_binary_stl(std::string_view head, std::size_t size)
{
    return head.size() >= kPrelude && size == kPrelude + std::uint64_t{kStlTriangle} * stated_triangles(head);
}

bool looks_like_ascii_stl(std::string_view bytes)
{
    constexpr std::size_t kEnough = 1 << 12; // the name of a solid is shorter
    std::string start(bytes.substr(0, kEnough));
    std::transform(start.begin(), start.end(), start.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::size_t first = start.find_first_not_of(" \t\r\n");
    return first != std::string::npos && start.compare(first, 5, "solid") == 0 &&
           (start.find("facet") != std::string::npos || start.find("endsolid") != std::string::npos);
}

Mesh parse_stl(std::string_view bytes, const std::string& source, MeshRepair& repair)
{
    if (is_binary_stl(bytes))
        return read_binary_stl(
            bytes.substr(0, kPrelude),
            [&](std::size_t offset, char* to, std::size_t count) { std::memcpy(to, bytes.data() + offset, count); },
            source, repair);
    if (!looks_like_ascii_stl(bytes)) throw InputError(source, size_problem(bytes));
    const std::vector<Corner<double>> corners = AsciiStl(bytes, source).parse();
    const auto copy = [&](std::size_t first, std::size_t count, Corner<double>* to) {
        std::copy_n(corners.data() + 3 * first, 3 * count, to);
    };
    return welded<double>(corners.size() / 3, copy, repair);
}

Mesh read_binary_stl(std::string_view head, const ReadBytes& read, const std::string& source, MeshRepair& repair)
{
    const std::size_t facets = stated_triangles(head);
    if (3 * facets >= kMostCorners) throw InputError(source, std::to_string(facets) + " triangles are too many");
    tbb::enumerable_thread_specific<std::vector<char>> rooms;
    const auto copy = [&](std::size_t first, std::size_t count, Corner<float>* to) {
        std::vector<char>& bytes = rooms.local();
        bytes.resize(std::max(bytes.size(), kStlTriangle * count));
        read(kPrelude + kStlTriangle * first, bytes.data(), kStlTriangle * count);
        for (std::size_t f = 0; f < count; ++f)
            std::memcpy(to + 3 * f, bytes.data() + kStlTriangle * f + kCorners, 3 * sizeof(Corner<float>));
    };
    return welded<float>(facets, copy, repair);
}

std::string stl_header(std::size_t triangles, Units::Length unit)
{
    std::string header = "binary STL, units " + to_string(unit);
    header.resize(kPrelude);
    const auto count = static_cast<std::uint32_t>(triangles);
    std::memcpy(header.data() + kHeader, &count, sizeof count);
    return header;
}

void put_stl_triangles(const Mesh& part, Units::Length unit, char* to)
{
    const Eigen::Matrix3Xd normals = triangle_normals(part);
    const double scale = mm_per(unit);
    for (Eigen::Index t = 0; t < part.triangles.cols(); ++t, to += kStlTriangle) {
        Eigen::Matrix<float, 3, 4> facet;
        facet.col(0) = normals.col(t).cast<float>();
        for (int k = 0; k < 3; ++k) facet.col(k + 1) = (part.vertices.col(part.triangles(k, t)) / scale).cast<float>();
        std::memcpy(to, facet.data(), sizeof(float) * 12);
        std::memset(to + sizeof(float) * 12, 0, 2);
    }
}

void write_stl(std::ostream& out, const Mesh& mesh, Units::Length unit)
{
    const auto count = static_cast<std::size_t>(mesh.triangles.cols());
    const auto buffer = std::make_unique_for_overwrite<char[]>(kStlTriangle * count);
    put_stl_triangles(mesh, unit, buffer.get());
    out << stl_header(count, unit);
    out.write(buffer.get(), static_cast<std::streamsize>(kStlTriangle * count));
}

} // namespace fettle
