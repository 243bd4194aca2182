#include "report/svg_sheet.h"

#include "compare/png.h"
#include "report/base64.h"
#include "report/svg.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace fettle {
namespace {

using Eigen::Vector2d;

// Of Helvetica and those like it, in thousandths of the font's size: capital letters are that high, and the characters
// from the blank on that wide (its metrics, as Adobe published them). Bold letters are somewhat wider.
constexpr double kCapital = 718, kBold = 1.07;
constexpr std::array<int, 95> kWidths = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};
constexpr int kOther = 556;

/// With true minus signs: "-" before a digit.
std::string typeset(const std::string& words)
{
    std::string set;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool sign = words[i] == '-' && (i == 0 || words[i - 1] == ' ' || words[i - 1] == '(') &&
                          i + 1 < words.size() && std::isdigit(static_cast<unsigned char>(words[i + 1])) != 0;
        set += sign ? "\u2212" : std::string(1, words[i]);
    }
    return set;
}

} // namespace

double SvgSheet::text_width(const std::string& words, double capital_height, bool bold) const
{
    double width = 0;
    for (const char c : words)
        if (const unsigned char byte = static_cast<unsigned char>(c); byte >= 0x20 && byte < 0x7F)
            width += kWidths[byte - 0x20U];
        else if ((byte & 0xC0U) != 0x80) // one a UTF-8 character
            width += kOther;
    return width * (bold ? kBold : 1) * capital_height / kCapital;
}

void SvgSheet::box(const Vector2d& corner, const Vector2d& size, const Rgb& colour)
{
    const Vector2d seen = size.cwiseMax(1); // as on a canvas: one without width is a line
    drawn_ += lone_element("rect", {{"x", svg::coordinate(corner.x())},
                                    {"y", svg::coordinate(corner.y())},
                                    {"width", svg::coordinate(seen.x())},
                                    {"height", svg::coordinate(seen.y())},
                                    {"fill", svg::colour(colour)},
                                    {"shape-rendering", "crispEdges"}});
}

void SvgSheet::image(const Vector2d& corner, const Vector2d& size, int columns, std::span<const std::uint8_t> rgb)
{
    const int rows = static_cast<int>(rgb.size()) / (3 * columns);
    drawn_ += lone_element("image", {{"x", svg::coordinate(corner.x())},
                                     {"y", svg::coordinate(corner.y())},
                                     {"width", svg::coordinate(size.x())},
                                     {"height", svg::coordinate(size.y())},
                                     {"preserveAspectRatio", "none"},
                                     {"href", "data:image/png;base64," + base64(encode_png(rgb, columns, rows))}});
}

void SvgSheet::draw_text(const std::string& words, const Vector2d& at, double capital_height, const Rgb& colour,
                         Align align, bool bold)
{
    static constexpr std::array<const char*, 3> kAnchors = {"start", "middle", "end"};
    const std::string style = "font-size:" + svg::coordinate(1000 * capital_height / kCapital) +
                              "px;fill:" + svg::colour(colour) + (bold ? ";font-weight:600" : "");
    drawn_ += element("text",
                      {{"x", svg::coordinate(at.x())},
                       {"y", svg::coordinate(at.y() + capital_height / 2)},
                       {"text-anchor", kAnchors[static_cast<std::size_t>(align)]},
                       {"style", style}},
                      typeset(words));
}

void SvgSheet::draw_line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed)
{
    std::string places;
    for (const Vector2d& p : points.colwise())
        places += (places.empty() ? "" : " ") + svg::coordinate(p.x()) + "," + svg::coordinate(p.y());
    drawn_ += lone_element(closed ? "polygon" : "polyline", {{"points", places},
                                                             {"fill", "none"},
                                                             {"stroke", svg::colour(colour)},
                                                             {"stroke-width", svg::coordinate(width)},
                                                             {"stroke-linejoin", "round"}});
}

Html SvgSheet::drawing(const std::string& label) const { return svg::drawing(width_, height_, label, drawn_); }

} // namespace fettle
