#include "report/svg_sheet.h"

#include "compare/png.h"
#include "report/base64.h"
#include "report/svg.h"

#include <algorithm>

namespace fettle {
namespace {

using Eigen::Vector2d;

// Of Helvetica and those like it: a capital letter is 0.72 of the font's size high, letters are about 0.53 of it wide.
constexpr double kCapital = 0.72, kLetter = 0.53, kBoldLetter = 0.57;

} // namespace

SvgSheet::SvgSheet(int width, int height) : width_(width), height_(height), left_(width), top_(height) {}

double SvgSheet::text_width(const std::string& words, double capital_height, bool bold) const
{
    const auto starts = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }; // a UTF-8 character
    return double(std::count_if(words.begin(), words.end(), starts)) * (bold ? kBoldLetter : kLetter) * capital_height /
           kCapital;
}

void SvgSheet::box(const Vector2d& corner, const Vector2d& size, const Rgb& colour)
{
    if (pixels_.empty()) background_ = colour;
    // On a canvas, a box without width is still a line.
    const Vector2d shown = size.cwiseMax(1);
    (pixels_.empty() ? below_ : above_) += lone_element("rect", {{"x", svg::coordinate(corner.x())},
                                                                 {"y", svg::coordinate(corner.y())},
                                                                 {"width", svg::coordinate(shown.x())},
                                                                 {"height", svg::coordinate(shown.y())},
                                                                 {"fill", svg::colour(colour)},
                                                                 {"shape-rendering", "crispEdges"}});
}

void SvgSheet::dot(int column, int row, const Rgb& colour)
{
    if (column < 0 || column >= width_ || row < 0 || row >= height_) return;
    if (pixels_.empty()) {
        pixels_.resize(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        for (std::size_t i = 0; i < pixels_.size(); ++i) pixels_[i] = background_[i % 3];
    }
    const std::size_t at =
        3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column));
    std::copy(colour.begin(), colour.end(), pixels_.begin() + static_cast<std::ptrdiff_t>(at));
    left_ = std::min(left_, column);
    right_ = std::max(right_, column);
    top_ = std::min(top_, row);
    bottom_ = std::max(bottom_, row);
}

void SvgSheet::draw_text(const std::string& words, const Vector2d& at, double capital_height, const Rgb& colour,
                         Align align, bool bold)
{
    static constexpr const char* kAnchors[] = {"start", "middle", "end"};
    Attributes attributes = {{"x", svg::coordinate(at.x())},
                             {"y", svg::coordinate(at.y() + capital_height / 2)},
                             {"text-anchor", kAnchors[static_cast<int>(align)]},
                             {"style", "font-size:" + svg::coordinate(capital_height / kCapital) +
                                           "px;fill:" + svg::colour(colour) + (bold ? ";font-weight:600" : "")}};
    (pixels_.empty() ? below_ : above_) += element("text", attributes, words);
}

void SvgSheet::draw_line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed)
{
    std::string places;
    for (const Vector2d& p : points.colwise())
        places += (places.empty() ? "" : " ") + svg::coordinate(p.x()) + "," + svg::coordinate(p.y());
    (pixels_.empty() ? below_ : above_) +=
        lone_element(closed ? "polygon" : "polyline", {{"points", places},
                                                       {"fill", "none"},
                                                       {"stroke", svg::colour(colour)},
                                                       {"stroke-width", svg::coordinate(width)},
                                                       {"stroke-linejoin", "round"}});
}

Html SvgSheet::drawing(const std::string& label) const
{
    if (right_ < left_) return svg::drawing(width_, height_, label, below_ + above_);
    const int columns = right_ - left_ + 1, rows = bottom_ - top_ + 1;
    std::vector<std::uint8_t> cut;
    for (int row = top_; row <= bottom_; ++row) {
        const auto begin = pixels_.begin() + 3 * (std::ptrdiff_t(row) * width_ + left_);
        cut.insert(cut.end(), begin, begin + 3 * std::ptrdiff_t(columns));
    }
    const Html image =
        lone_element("image", {{"x", std::to_string(left_)},
                               {"y", std::to_string(top_)},
                               {"width", std::to_string(columns)},
                               {"height", std::to_string(rows)},
                               {"href", "data:image/png;base64," + base64(encode_png(cut, columns, rows))}});
    return svg::drawing(width_, height_, label, below_ + image + above_);
}

} // namespace fettle
