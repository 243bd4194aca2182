#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/obj_off.h"
#include "mesh/polygons.h"

#include <limits>
#include <vector>

namespace fettle::mesh {

namespace {

class OffParser : core::FileLines {
  public:
    using core::FileLines::FileLines;

    Mesh parse()
    {
        read_header();
        Mesh mesh;
        mesh.vertices = read_vertices();
        std::vector<std::uint32_t> corners;
        std::vector<std::size_t> ends;
        for (std::size_t f = 0; f < faces_; ++f) {
            read_face(corners);
            ends.push_back(corners.size());
        }
        if (next_line()) refuse("text after the last face: " + core::in_quotes(line()));
        mesh.triangles = triangulate_polygons(mesh.vertices, corners, ends);
        return mesh;
    }

  private:
    /// Steps to the next line that is neither blank nor a comment.
    bool next_line()
    {
        while (next()) {
            rest_ = line().substr(0, line().find('#'));
            if (!core::is_blank_line(rest_)) return true;
        }
        return false;
    }

    void need_line(const std::string& what)
    {
        if (!next_line()) refuse("the file ends, expected " + what);
    }

    std::size_t read_integer(const std::string& what, std::size_t max)
    {
        const std::string_view word = core::next_word(rest_);
        const std::optional<std::size_t> value = core::parse_integer<std::size_t>(word);
        if (!value || *value > max)
            refuse(what + ": expected a number from 0 to " + std::to_string(max) + ", got " + core::in_quotes(word));
        return *value;
    }

    /// Reads "OFF" and, on the same line or the next, the numbers of vertices, faces and edges.
    void read_header()
    {
        constexpr std::size_t kMaxCount = std::numeric_limits<int>::max();
        constexpr std::size_t kMinLineBytes = 6; // "0 0 0\n"
        need_line("OFF");
        const std::string_view name = core::next_word(rest_);
        if (name != "OFF" && name != "COFF") refuse("expected OFF or COFF, got " + core::in_quotes(name));
        coloured_ = name == "COFF";
        if (core::is_blank_line(rest_)) need_line("the numbers of vertices and faces");
        vertices_ = read_integer("number of vertices", kMaxCount);
        faces_ = read_integer("number of faces", kMaxCount);
        if (faces_ > 0 && vertices_ == 0) refuse("faces without a vertex");
        const std::size_t left = text_.size() - offset();
        if (vertices_ + faces_ > (left + 1) / kMinLineBytes)
            refuse(std::to_string(vertices_) + " vertices and " + std::to_string(faces_) + " faces: only " +
                   std::to_string(left) + " bytes left");
    }

    Eigen::Matrix3Xd read_vertices()
    {
        Eigen::Matrix3Xd vertices(3, vertices_);
        for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
            need_line("vertex " + std::to_string(i));
            for (int k = 0; k < 3; ++k) {
                const std::string_view word = core::next_word(rest_);
                const std::optional<double> value = core::parse_number(word);
                if (!value)
                    refuse(word.empty() ? "a vertex of " + std::to_string(k) + " numbers"
                                        : core::in_quotes(word) + " is not a number");
                vertices(k, i) = *value;
            }
            if (const std::string_view word = core::next_word(rest_); !coloured_ && !word.empty())
                refuse("a vertex of more than 3 numbers: " + core::in_quotes(word));
        }
        return vertices;
    }

    /// A face has the number of its corners and their vertices; a colour may follow.
    void read_face(std::vector<std::uint32_t>& corners)
    {
        need_line("a face");
        const std::size_t size = read_integer("number of corners", kMaxPolygonCorners);
        if (size < 3) refuse("a face of " + std::to_string(size) + " corners");
        for (std::size_t k = 0; k < size; ++k)
            corners.push_back(static_cast<std::uint32_t>(read_integer("vertex of a face", vertices_ - 1)));
    }

    std::string_view rest_; ///< of the line
    bool coloured_ = false;
    std::size_t vertices_ = 0;
    std::size_t faces_ = 0;
};

} // namespace

Mesh parse_off(std::string_view text, const std::string& source) { return OffParser(text, source).parse(); }

bool looks_like_off(std::string_view text)
{
    core::Lines lines(text);
    while (lines.next()) {
        std::string_view line = lines.line();
        const std::string_view word = core::next_word(line);
        if (word.empty() || word.starts_with('#')) continue;
        return word.size() <= 6 && word.ends_with("OFF"); // also STOFF, 4nOFF, … that parse_off() rejects
    }
    return false;
}

} // namespace fettle::mesh
