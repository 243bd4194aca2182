#pragma once

#include "draw/html.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>

/// SVG drawings as fragments of a page. Coordinates in pixels of the drawing, x right, y down.
namespace fettle::draw::svg {

/// Text of a coordinate, to hundredths of a pixel.
std::string coordinate(double value);
/// The points attribute of a polygon or polyline. @param points  2xN
std::string coordinates(const Eigen::Matrix2Xd& points);
/// Colour as "#1f77b4".
std::string colour(const std::array<std::uint8_t, 3>& rgb);

/// The svg element, as wide as the page allows. @param label  description for screen readers
Html drawing(double width, double height, const std::string& label, const Html& content);

/// @param style  name of a class in the style sheet
Html line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& style);
Html box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const std::string& style);
Html path(const std::string& commands, const std::string& style);
Html polygon(const Eigen::Matrix2Xd& corners, const std::string& style);
Html circle(const Eigen::Vector2d& centre, double radius, const std::string& style);

/// A text with a line break after it, without which neighbours run together where they are copied or extracted.
Html text_element(const Attributes& attributes, const Html& words);

enum class Anchor { start, middle, end };
/// @param words  an underscore makes what follows, up to the next blank, a subscript: "F_max"
Html text(const Eigen::Vector2d& at, const std::string& words, Anchor anchor = Anchor::start,
          const std::string& style = "");

/// Axis of a chart: maps values from min to max linearly to pixels from begin to end.
struct Axis {
    double min = 0, max = 1, begin = 0, end = 1;

    double operator()(double value) const { return begin + (value - min) / (max - min) * (end - begin); }
};

/// Ticks at round values with their numbers and grid lines. @param count  approximate number of ticks
Html ticks_below(const Axis& x, double top, double bottom, int count);
Html ticks_left(const Axis& y, double left, double right, int count);

} // namespace fettle::draw::svg
