#pragma once

#include "compare/sheet.h"

#include <memory>
#include <string>

namespace fettle {

/// A white sheet of pixels, drawn on with OpenCV.
class Canvas final : public Sheet {
  public:
    Canvas(int width, int height);
    Canvas(Canvas&&) noexcept;
    ~Canvas() override;

    double text_width(const std::string& words, double capital_height, bool bold = false) const override;
    void box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour) override;
    /// Pixel by pixel, the nearest of the picture each.
    void image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, int columns,
               std::span<const std::uint8_t> rgb) override;

    int width() const;
    int height() const;
    /// The bytes of a PNG file.
    std::string png() const;

  private:
    void draw_text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour,
                   Align align, bool bold) override;
    void draw_line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed) override;

    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle
