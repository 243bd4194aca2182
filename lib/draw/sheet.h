#pragma once

#include "draw/colours.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <string>

namespace fettle::draw {

/// Drawing surface of pictures: a raster image (Canvas) or an SVG drawing (SvgSheet). Coordinates in pixels, x right, y
/// down.
class Sheet {
  public:
    virtual ~Sheet() = default;

    enum class Align { left, centre, right };
    static constexpr Rgb kInk = {40, 40, 40};

    /// One line of text, UTF-8. @param at  the left end, middle or right end, half-way up the capital letters
    void text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour = kInk,
              Align align = Align::left, bool bold = false)
    {
        if (!words.empty()) draw_text(words, at, capital_height, colour, align, bold);
    }
    /// Width of a text, pixels.
    virtual double text_width(const std::string& words, double capital_height, bool bold = false) const = 0;

    virtual void box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour) = 0;
    /// Anti-aliased. @param points  2xN
    virtual void line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed = false) = 0;
    /// Raster image, scaled to a box. @param rgb  red, green, blue, row by row: 3 · columns · rows
    virtual void image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, int columns,
                       std::span<const std::uint8_t> rgb) = 0;

  private:
    virtual void draw_text(const std::string& words, const Eigen::Vector2d& at, double capital_height,
                           const Rgb& colour, Align align, bool bold) = 0;
};

} // namespace fettle::draw
