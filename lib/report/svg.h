#pragma once

#include "report/html.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>

/// Drawings in SVG, as parts of a page. Coordinates in pixels of the drawing, x right, y down.
namespace fettle::svg {

/// A number as it stands in a path: hundredths of a pixel.
std::string coordinate(double value);
/// "#1f77b4"-like colour of three bytes.
std::string colour(const std::array<std::uint8_t, 3>& rgb);

/// The drawing itself, as wide as the page lets it be. @param label  what a reader hears who cannot see it
Html drawing(double width, double height, const std::string& label, const Html& content);

/// @param style  name of a class in the style sheet
Html line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& style);
Html box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const std::string& style);
Html path(const std::string& commands, const std::string& style);
Html polygon(const Eigen::Matrix2Xd& corners, const std::string& style);
Html circle(const Eigen::Vector2d& centre, double radius, const std::string& style);

enum class Anchor { start, middle, end };
/// @param words  an index after an underscore, "F_max", is set lower, up to the next blank
Html text(const Eigen::Vector2d& at, const std::string& words, Anchor anchor = Anchor::start,
          const std::string& style = "");

/// One axis of a chart: values from least to most over pixels from begin to end.
struct Axis {
    double least = 0, most = 1, begin = 0, end = 1;

    double operator()(double value) const { return begin + (value - least) / (most - least) * (end - begin); }
};

/// Ticks of round values with their numbers, and lines across the chart. @param count  about so many
Html ticks_below(const Axis& x, double top, double bottom, int count);
Html ticks_left(const Axis& y, double left, double right, int count);

} // namespace fettle::svg
