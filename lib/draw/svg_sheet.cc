#include "draw/svg_sheet.h"

#include "draw/base64.h"
#include "draw/png.h"
#include "draw/svg.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace fettle::draw {
namespace {

using Eigen::Vector2d;

// Metrics of Helvetica as published by Adobe, in thousandths of the font size: height of capital letters and widths of
// the ASCII characters from the blank on. Bold letters are somewhat wider.
constexpr double kCapitalHeight = 718, kBoldFactor = 1.07;
// Sans-serif letters of a machine without Helvetica are wider: DejaVu Sans by so much.
constexpr double kWideFontFactor = 1.16;
constexpr std::array<int, 95> kWidths = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};
constexpr int kOtherWidth = 556;

/// Replaces "-" before a digit by a minus sign.
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
        else if ((byte & 0xC0U) != 0x80) // once for each UTF-8 character
            width += kOtherWidth;
    return kWideFontFactor * width * (bold ? kBoldFactor : 1) * capital_height / kCapitalHeight;
}

void SvgSheet::box(const Vector2d& corner, const Vector2d& size, const Rgb& colour)
{
    const Vector2d visible = size.cwiseMax(1); // as on a Canvas, a box without width is a line
    drawn_ += empty_element("rect", {{"x", svg::coordinate(corner.x())},
                                     {"y", svg::coordinate(corner.y())},
                                     {"width", svg::coordinate(visible.x())},
                                     {"height", svg::coordinate(visible.y())},
                                     {"fill", svg::colour(colour)},
                                     {"shape-rendering", "crispEdges"}});
}

void SvgSheet::image(const Vector2d& corner, const Vector2d& size, int columns, std::span<const std::uint8_t> rgb)
{
    const int rows = static_cast<int>(rgb.size()) / (3 * columns);
    drawn_ += empty_element("image", {{"x", svg::coordinate(corner.x())},
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
    const std::string style = "font-size:" + svg::coordinate(1000 * capital_height / kCapitalHeight) +
                              "px;fill:" + svg::colour(colour) + (bold ? ";font-weight:600" : "");
    drawn_ += svg::text_element({{"x", svg::coordinate(at.x())},
                                 {"y", svg::coordinate(at.y() + capital_height / 2)},
                                 {"text-anchor", kAnchors[static_cast<std::size_t>(align)]},
                                 {"style", style}},
                                typeset(words));
}

void SvgSheet::line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed)
{
    drawn_ += empty_element(closed ? "polygon" : "polyline", {{"points", svg::coordinates(points)},
                                                              {"fill", "none"},
                                                              {"stroke", svg::colour(colour)},
                                                              {"stroke-width", svg::coordinate(width)},
                                                              {"stroke-linejoin", "round"}});
}

Html SvgSheet::drawing(const std::string& label) const { return svg::drawing(width_, height_, label, drawn_); }

} // namespace fettle::draw
