#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/obj_off.h"
#include "mesh/polygons.h"

#include <limits>
#include <vector>

namespace fettle {

namespace {

class OffParser {
  public:
    OffParser(std::string_view text, const std::string& source) : text_(text), lines_(text), source_(source) {}

    Mesh parse()
    {
        read_head();
        Mesh mesh;
        mesh.vertices = read_vertices();
        std::vector<std::uint32_t> corners;
        std::vector<std::size_t> ends;
        for (std::size_t f = 0; f < faces_; ++f) {
            read_face(corners);
            ends.push_back(corners.size());
        }
        if (next_line()) refuse("text after the last face: " + in_quotes(lines_.line()));
        mesh.triangles = cut_polygons(mesh.vertices, corners, ends);
        return mesh;
    }

  private:
    [[noreturn]] void refuse(const std::string& problem) const
    {
        throw InputError(source_, lines_.place() + ": " + problem);
    }

    // The next line that says something, without its comment.
    bool next_line()
    {
        while (lines_.next()) {
            rest_ = lines_.line().substr(0, lines_.line().find('#'));
            if (rest_.find_first_not_of(" \t") != std::string_view::npos) return true;
        }
        return false;
    }

    void need_line(const std::string& what)
    {
        if (!next_line()) refuse("the file ends, expected " + what);
    }

    std::size_t whole(const std::string& what, std::size_t most)
    {
        const std::string_view word = next_word(rest_);
        const std::optional<std::size_t> value = parse_whole<std::size_t>(word);
        if (!value || *value > most)
            refuse(what + ": expected a number from 0 to " + std::to_string(most) + ", got " + in_quotes(word));
        return *value;
    }

    // "OFF", then the numbers of vertices, faces and edges on the same line or the next.
    void read_head()
    {
        constexpr std::size_t kMost = std::numeric_limits<int>::max();
        constexpr std::size_t kShortestLine = 6; // "0 0 0\n"
        need_line("OFF");
        const std::string_view name = next_word(rest_);
        if (name != "OFF" && name != "COFF") refuse("expected OFF or COFF, got " + in_quotes(name));
        coloured_ = name == "COFF";
        if (rest_.find_first_not_of(" \t") == std::string_view::npos) need_line("the numbers of vertices and faces");
        vertices_ = whole("number of vertices", kMost);
        faces_ = whole("number of faces", kMost);
        if (faces_ > 0 && vertices_ == 0) refuse("faces without a vertex");
        const std::size_t left = text_.size() - lines_.offset();
        if (vertices_ + faces_ > (left + 1) / kShortestLine)
            refuse(std::to_string(vertices_) + " vertices and " + std::to_string(faces_) + " faces: only " +
                   std::to_string(left) + " bytes left");
    }

    Eigen::Matrix3Xd read_vertices()
    {
        Eigen::Matrix3Xd vertices(3, static_cast<Eigen::Index>(vertices_));
        for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
            need_line("vertex " + std::to_string(i));
            for (int k = 0; k < 3; ++k) {
                const std::string_view word = next_word(rest_);
                const std::optional<double> value = parse_number(word);
                if (!value)
                    refuse(word.empty() ? "a vertex of " + std::to_string(k) + " numbers"
                                        : in_quotes(word) + " is no number");
                vertices(k, i) = *value;
            }
            if (const std::string_view word = next_word(rest_); !coloured_ && !word.empty())
                refuse("a vertex of more than 3 numbers: " + in_quotes(word));
        }
        return vertices;
    }

    // The number of corners, their vertices; a colour may follow.
    void read_face(std::vector<std::uint32_t>& corners)
    {
        need_line("a face");
        const std::size_t size = whole("number of corners", kMostCorners);
        if (size < 3) refuse("a face of " + std::to_string(size) + " corners");
        for (std::size_t k = 0; k < size; ++k)
            corners.push_back(static_cast<std::uint32_t>(whole("vertex of a face", vertices_ - 1)));
    }

    std::string_view text_;
    Lines lines_;
    std::string_view rest_;
    const std::string& source_;
    bool coloured_ = false;
    std::size_t vertices_ = 0;
    std::size_t faces_ = 0;
};

} // namespace

Mesh parse_off(std::string_view text, const std::string& source) { return OffParser(text, source).parse(); }

bool looks_like_off(std::string_view text)
{
    Lines lines(text);
    while (lines.next()) {
        std::string_view line = lines.line();
        const std::string_view word = next_word(line);
        if (word.empty() || word.starts_with('#')) continue;
        return word.size() <= 6 && word.ends_with("OFF"); // STOFF, 4nOFF: those that we refuse by their name, too
    }
    return false;
}

} // namespace fettle
