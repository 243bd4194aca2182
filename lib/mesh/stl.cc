#include "mesh/stl.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/mesh_file.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <ostream>
#include <vector>

namespace fettle {

namespace {

constexpr std::size_t kHeader = 80;             // bytes of free text in a binary file
constexpr std::size_t kPrelude = kHeader + 4;   // and the number of triangles
constexpr std::size_t kFacet = 12 * 4 + 2;      // normal, three corners, attribute
constexpr std::size_t kCorners = 12;            // offset of the corners in a facet
constexpr std::size_t kMostVertices = 1u << 31; // indices are ints

std::uint32_t stated_triangles(std::string_view bytes)
{
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kHeader, sizeof count);
    return count;
}

/// Makes equal vertices one: a hash table with open addressing over the vertices found so far.
class Welder {
  public:
    explicit Welder(std::size_t triangles)
    {
        triangles_.reserve(3 * triangles);
        vertices_.reserve(3 * triangles / 2); // a closed mesh has half as many vertices as triangles
        slots_.resize(std::bit_ceil(2 * triangles + 16), kEmpty);
    }

    void add(const Eigen::Vector3d (&corners)[3])
    {
        for (const Eigen::Vector3d& corner : corners)
            if (!corner.allFinite()) {
                ++repair_.dropped_triangles;
                return;
            }
        for (const Eigen::Vector3d& corner : corners) triangles_.push_back(index_of(corner));
    }

    Mesh mesh() const
    {
        Mesh mesh;
        mesh.vertices = Eigen::Map<const Eigen::Matrix3Xd>(vertices_.data(), 3, count());
        mesh.triangles =
            Eigen::Map<const Eigen::Matrix3Xi>(triangles_.data(), 3, static_cast<Eigen::Index>(triangles_.size() / 3));
        return mesh;
    }

    MeshRepair repair() const
    {
        MeshRepair repair = repair_;
        repair.welded_vertices = static_cast<Eigen::Index>(triangles_.size()) - count();
        return repair;
    }

  private:
    static constexpr int kEmpty = -1;

    Eigen::Index count() const { return static_cast<Eigen::Index>(vertices_.size() / 3); }

    static std::size_t hash(const Eigen::Vector3d& p)
    {
        std::uint64_t mixed = 0;
        for (const double coordinate : {p.x(), p.y(), p.z()}) {
            mixed ^= std::bit_cast<std::uint64_t>(coordinate);
            mixed *= 0x9e3779b97f4a7c15; // 2^64 / golden ratio: spreads neighbours (Knuth)
            mixed ^= mixed >> 32;
        }
        return mixed;
    }

    int index_of(const Eigen::Vector3d& corner)
    {
        const Eigen::Vector3d p = corner.array() + 0.0; // -0 becomes +0: they are equal but differ in their bits
        if (2 * static_cast<std::size_t>(count()) >= slots_.size()) grow();
        const std::size_t mask = slots_.size() - 1;
        std::size_t slot = hash(p) & mask;
        for (; slots_[slot] != kEmpty; slot = (slot + 1) & mask) {
            const double* other = &vertices_[3 * static_cast<std::size_t>(slots_[slot])];
            if (other[0] == p.x() && other[1] == p.y() && other[2] == p.z()) return slots_[slot];
        }
        slots_[slot] = static_cast<int>(count());
        vertices_.insert(vertices_.end(), p.data(), p.data() + 3);
        return slots_[slot];
    }

    void grow()
    {
        std::vector<int> wider(2 * slots_.size(), kEmpty);
        const std::size_t mask = wider.size() - 1;
        for (const int index : slots_) {
            if (index == kEmpty) continue;
            std::size_t slot =
                hash(Eigen::Map<const Eigen::Vector3d>(&vertices_[3 * static_cast<std::size_t>(index)])) & mask;
            while (wider[slot] != kEmpty) slot = (slot + 1) & mask;
            wider[slot] = index;
        }
        slots_.swap(wider);
    }

    std::vector<double> vertices_;
    std::vector<int> triangles_;
    std::vector<int> slots_;
    MeshRepair repair_;
};

Welder parse_binary(std::string_view bytes)
{
    Welder welder(stated_triangles(bytes));
    for (const char* facet = bytes.data() + kPrelude; facet != bytes.data() + bytes.size(); facet += kFacet) {
        float numbers[9];
        std::memcpy(numbers, facet + kCorners, sizeof numbers);
        Eigen::Vector3d corners[3];
        for (int k = 0; k < 3; ++k) corners[k] = Eigen::Map<const Eigen::Vector3f>(numbers + 3 * k).cast<double>();
        welder.add(corners);
    }
    return welder;
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

    Welder parse()
    {
        constexpr std::size_t kShortestFacet = 80; // bytes: the keywords alone, with single digits
        Welder welder(text_.size() / kShortestFacet / 3);
        expect("solid");
        skip_line();
        for (;;) {
            const std::string_view word = next();
            if (same_word(word, "facet")) {
                parse_facet(welder);
            } else if (same_word(word, "endsolid")) {
                skip_line();
                if (at_end()) return welder;
                expect("solid");
                skip_line();
            } else {
                refuse(word, "facet or endsolid");
            }
        }
    }

  private:
    void parse_facet(Welder& welder)
    {
        expect("normal");
        for (int k = 0; k < 3; ++k) number(); // whatever it says: the corners tell
        expect("outer");
        expect("loop");
        Eigen::Vector3d corners[3];
        for (Eigen::Vector3d& corner : corners) {
            expect("vertex");
            for (int k = 0; k < 3; ++k) corner[k] = number();
        }
        expect("endloop");
        expect("endfacet");
        welder.add(corners);
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
    const std::uint64_t needed = kPrelude + std::uint64_t{kFacet} * count;
    const std::uint64_t swapped = kPrelude + std::uint64_t{kFacet} * __builtin_bswap32(count);
    if (swapped == bytes.size()) return "binary STL in big-endian order, expected little-endian";
    return "binary STL of " + std::to_string(count) + " triangles needs " + std::to_string(needed) +
           " bytes, there are " + std::to_string(bytes.size());
}

} // namespace

bool is_binary_stl(std::string_view bytes) { return is_binary_stl(bytes, bytes.size()); }

bool is_binary_stl(std::string_view head, std::size_t size)
{
    return head.size() >= kPrelude && size == kPrelude + std::uint64_t{kFacet} * stated_triangles(head);
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
    const bool binary = is_binary_stl(bytes);
    if (!binary && !looks_like_ascii_stl(bytes)) throw InputError(source, size_problem(bytes));
    if (binary && 3 * std::size_t{stated_triangles(bytes)} >= kMostVertices)
        throw InputError(source, std::to_string(stated_triangles(bytes)) + " triangles are too many");
    const Welder welder = binary ? parse_binary(bytes) : AsciiStl(bytes, source).parse();
    repair = welder.repair();
    return welder.mesh();
}

void write_stl(std::ostream& out, const Mesh& mesh, Units::Length unit)
{
    const auto count = static_cast<std::uint32_t>(mesh.triangles.cols());
    const std::size_t size = kPrelude + kFacet * count;
    const auto buffer = std::make_unique<char[]>(size);
    const std::string header = "binary STL, units " + to_string(unit);
    header.copy(buffer.get(), kHeader);
    std::memcpy(buffer.get() + kHeader, &count, sizeof count);
    const Eigen::Matrix3Xd normals = triangle_normals(mesh);
    const double scale = mm_per(unit);
    char* to = buffer.get() + kPrelude;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t, to += kFacet) {
        Eigen::Matrix<float, 3, 4> facet;
        facet.col(0) = normals.col(t).cast<float>();
        for (int k = 0; k < 3; ++k) facet.col(k + 1) = (mesh.vertices.col(mesh.triangles(k, t)) / scale).cast<float>();
        std::memcpy(to, facet.data(), sizeof(float) * 12);
    }
    out.write(buffer.get(), static_cast<std::streamsize>(size));
}

} // namespace fettle
