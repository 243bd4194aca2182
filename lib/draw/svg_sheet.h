#pragma once

#include "draw/html.h"
#include "draw/sheet.h"

#include <string>

namespace fettle::draw {

/// Sheet that produces an SVG drawing: text and lines remain vectors, images are embedded as PNG.
class SvgSheet final : public Sheet {
  public:
    SvgSheet(int width, int height) : width_(width), height_(height) {}

    double text_width(const std::string& words, double capital_height, bool bold = false) const override;
    void box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour) override;
    void line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed = false) override;
    void image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, int columns,
               std::span<const std::uint8_t> rgb) override;

    /// @param label  description for screen readers
    Html drawing(const std::string& label) const;

  private:
    void draw_text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour,
                   Align align, bool bold) override;

    int width_, height_;
    Html drawn_;
};

} // namespace fettle::draw
