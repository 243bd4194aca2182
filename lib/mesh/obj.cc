#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/obj_off.h"
#include "mesh/polygons.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace fettle::mesh {

namespace {

constexpr std::string_view kStatements[] = {
    "v",      "vt",     "vn",     "vp",  "f",    "l",     "p",    "g",    "o",    "s",    "mg",  "usemtl", "mtllib",
    "usemap", "maplib", "cstype", "deg", "curv", "curv2", "surf", "parm", "trim", "hole", "end", "bevel",  "lod"};

bool is_statement(std::string_view word) { return std::ranges::find(kStatements, word) != std::end(kStatements); }

/// True for two integers: some writers begin with the numbers of vertices and faces (the test files of FCL do).
bool is_counts_line(std::string_view line)
{
    const std::vector<std::string_view> words = core::words(line);
    return words.size() == 2 && core::parse_integer<std::int64_t>(words[0]) &&
           core::parse_integer<std::int64_t>(words[1]);
}

class ObjParser : core::FileLines {
  public:
    using core::FileLines::FileLines;

    Mesh parse()
    {
        bool is_first = true;
        while (next()) {
            if (core::is_blank_or_comment(line())) continue;
            if (std::exchange(is_first, false) && is_counts_line(line())) continue;
            std::string_view rest = line();
            const std::string_view statement = core::next_word(rest);
            if (!is_statement(statement)) refuse("unknown statement " + core::in_quotes(statement));
            if (statement == "v") add_vertex(core::words(rest));
            if (statement == "f") add_face(core::words(rest));
        }
        if (max_vertex_ > count())
            throw core::InputError(source_, "line " + std::to_string(max_vertex_line_) + ": vertex " +
                                                std::to_string(max_vertex_) + " of " + std::to_string(count()));
        Mesh mesh;
        mesh.vertices = Eigen::Map<const Eigen::Matrix3Xd>(vertices_.data(), 3, count());
        mesh.triangles = triangulate_polygons(mesh.vertices, corners_, ends_);
        return mesh;
    }

  private:
    std::int64_t count() const { return static_cast<std::int64_t>(vertices_.size() / 3); }

    /// A vertex has three coordinates; a weight or a colour may follow.
    void add_vertex(const std::vector<std::string_view>& numbers)
    {
        if (numbers.size() < 3) refuse("a vertex of " + std::to_string(numbers.size()) + " numbers");
        for (std::size_t k = 0; k < 3; ++k) {
            const std::optional<double> value = core::parse_number(numbers[k]);
            if (!value) refuse(core::in_quotes(numbers[k]) + " is not a number");
            vertices_.push_back(*value);
        }
    }

    std::int64_t parse_index(std::string_view text, std::string_view corner) const
    {
        const std::optional<std::int64_t> value = core::parse_integer<std::int64_t>(text);
        if (!value) refuse(core::in_quotes(corner) + " is not a corner of a face");
        return *value;
    }

    /// Parses "7", "7/1", "7//3" or "7/1/3": vertex, texture and normal, counted from 1, or from -1 backwards.
    std::uint32_t parse_corner(std::string_view corner)
    {
        const std::size_t end = corner.find('/');
        const std::int64_t index = parse_index(corner.substr(0, end), corner);
        if (end != std::string_view::npos) {
            const std::string_view rest = corner.substr(end + 1);
            const std::size_t second = rest.find('/');
            if (second != 0) parse_index(rest.substr(0, second), corner);
            if (second != std::string_view::npos) parse_index(rest.substr(second + 1), corner);
        }
        if (index == 0) refuse("vertex 0, they count from 1");
        const std::int64_t absolute = index > 0 ? index : count() + 1 + index;
        if (absolute < 1) refuse("vertex " + std::to_string(index) + " is before the first");
        if (absolute > std::numeric_limits<int>::max()) refuse("vertex " + std::to_string(absolute) + " is too many");
        if (absolute > max_vertex_) { // checked at the end: the vertex may be defined further down
            max_vertex_ = absolute;
            max_vertex_line_ = number();
        }
        return static_cast<std::uint32_t>(absolute - 1);
    }

    void add_face(const std::vector<std::string_view>& corners)
    {
        if (corners.size() < 3 || corners.size() > kMaxPolygonCorners)
            refuse("a face of " + std::to_string(corners.size()) + " corners");
        for (const std::string_view corner : corners) corners_.push_back(parse_corner(corner));
        ends_.push_back(corners_.size());
    }

    std::vector<double> vertices_;       ///< x, y, z of one after the other
    std::vector<std::uint32_t> corners_; ///< vertices of all faces, one after the other
    std::vector<std::size_t> ends_;      ///< end of each face in `corners_`
    std::int64_t max_vertex_ = 0;        ///< highest index that a face names, counted from 1
    std::size_t max_vertex_line_ = 0;    ///< line that names it
};

} // namespace

Mesh parse_obj(std::string_view text, const std::string& source) { return ObjParser(text, source).parse(); }

bool looks_like_obj(std::string_view text)
{
    core::Lines lines(text);
    bool is_first = true;
    while (lines.next()) {
        std::string_view line = lines.line();
        if (core::is_blank_or_comment(line)) continue;
        if (!std::exchange(is_first, false) || !is_counts_line(line)) return is_statement(core::next_word(line));
    }
    return false;
}

} // namespace fettle::mesh
