#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/obj_off.h"
#include "mesh/polygons.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace fettle {

namespace {

constexpr std::string_view kStatements[] = {
    "v",      "vt",     "vn",     "vp",  "f",    "l",     "p",    "g",    "o",    "s",    "mg",  "usemtl", "mtllib",
    "usemap", "maplib", "cstype", "deg", "curv", "curv2", "surf", "parm", "trim", "hole", "end", "bevel",  "lod"};

bool is_statement(std::string_view word)
{
    return std::find(std::begin(kStatements), std::end(kStatements), word) != std::end(kStatements);
}

bool is_blank_or_comment(std::string_view line)
{
    const std::size_t first = line.find_first_not_of(" \t");
    return first == std::string_view::npos || line[first] == '#';
}

class ObjParser {
  public:
    ObjParser(std::string_view text, const std::string& source) : lines_(text), source_(source) {}

    Mesh parse()
    {
        while (lines_.next()) {
            if (is_blank_or_comment(lines_.line())) continue;
            std::string_view rest = lines_.line();
            const std::string_view statement = next_word(rest);
            if (!is_statement(statement)) refuse("unknown statement " + in_quotes(statement));
            if (statement == "v") add_vertex(words(rest));
            if (statement == "f") add_face(words(rest));
        }
        if (largest_ > count())
            throw InputError(source_, "line " + std::to_string(largest_line_) + ": vertex " + std::to_string(largest_) +
                                          " of " + std::to_string(count()));
        return assemble();
    }

  private:
    std::int64_t count() const { return static_cast<std::int64_t>(vertices_.size() / 3); }

    [[noreturn]] void refuse(const std::string& problem) const
    {
        throw InputError(source_, lines_.place() + ": " + problem);
    }

    // Three coordinates; a weight or a colour may follow.
    void add_vertex(const std::vector<std::string_view>& numbers)
    {
        if (numbers.size() < 3) refuse("a vertex of " + std::to_string(numbers.size()) + " numbers");
        for (std::size_t k = 0; k < 3; ++k) {
            const std::optional<double> value = parse_number(numbers[k]);
            if (!value) refuse(in_quotes(numbers[k]) + " is no number");
            vertices_.push_back(*value);
        }
    }

    std::int64_t index(std::string_view text, std::string_view corner) const
    {
        const std::optional<std::int64_t> value = parse_whole<std::int64_t>(text);
        if (!value) refuse(in_quotes(corner) + " is no corner of a face");
        return *value;
    }

    // "7", "7/1", "7//3", "7/1/3": vertex, texture, normal, each from 1, or from the last one backwards.
    std::uint32_t corner_index(std::string_view corner)
    {
        const std::size_t end = corner.find('/');
        const std::int64_t stated = index(corner.substr(0, end), corner);
        if (end != std::string_view::npos) {
            const std::string_view rest = corner.substr(end + 1);
            const std::size_t second = rest.find('/');
            if (second != 0) index(rest.substr(0, second), corner);
            if (second != std::string_view::npos) index(rest.substr(second + 1), corner);
        }
        if (stated == 0) refuse("vertex 0, they count from 1");
        const std::int64_t absolute = stated > 0 ? stated : count() + 1 + stated;
        if (absolute < 1) refuse("vertex " + std::to_string(stated) + " is before the first");
        if (absolute > std::numeric_limits<int>::max()) refuse("vertex " + std::to_string(absolute) + " is too many");
        if (absolute > largest_) { // it may be defined further down
            largest_ = absolute;
            largest_line_ = lines_.number();
        }
        return static_cast<std::uint32_t>(absolute - 1);
    }

    void add_face(const std::vector<std::string_view>& corners)
    {
        if (corners.size() < 3 || corners.size() > kMostCorners)
            refuse("a face of " + std::to_string(corners.size()) + " corners");
        for (const std::string_view corner : corners) corners_.push_back(corner_index(corner));
        ends_.push_back(corners_.size());
    }

    Mesh assemble() const
    {
        Mesh mesh;
        mesh.vertices = Eigen::Map<const Eigen::Matrix3Xd>(vertices_.data(), 3, count());
        mesh.triangles = cut_polygons(mesh.vertices, corners_, ends_);
        return mesh;
    }

    Lines lines_;
    const std::string& source_;
    std::vector<double> vertices_;
    std::vector<std::uint32_t> corners_;
    std::vector<std::size_t> ends_;
    std::int64_t largest_ = 0;
    std::size_t largest_line_ = 0;
};

} // namespace

Mesh parse_obj(std::string_view text, const std::string& source) { return ObjParser(text, source).parse(); }

bool looks_like_obj(std::string_view text)
{
    Lines lines(text);
    while (lines.next()) {
        std::string_view line = lines.line();
        if (!is_blank_or_comment(line)) return is_statement(next_word(line));
    }
    return false;
}

} // namespace fettle
