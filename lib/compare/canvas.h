#pragma once

#include "compare/colours.h"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <string>

namespace fettle {

/// A white sheet of pixels, x right, y down, drawn on with OpenCV.
class Canvas {
  public:
    Canvas(int width, int height);
    Canvas(Canvas&&) noexcept;
    ~Canvas();

    enum class Align { left, centre, right };
    /// One line of text. @param at  the left end, middle or right end, half-way up the capital letters
    void text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour = kInk,
              Align align = Align::left, bool bold = false);
    /// How wide a text will be.
    static double text_width(const std::string& words, double capital_height, bool bold = false);

    void box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour);
    /// Anti-aliased. @param points  2xN
    void line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed = false);
    /// Sets one pixel; beside the sheet nothing happens.
    void dot(int column, int row, const Rgb& colour);

    int width() const;
    int height() const;
    /// The bytes of a PNG file.
    std::string png() const;

    static constexpr Rgb kInk = {40, 40, 40};

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle
