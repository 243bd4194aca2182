#pragma once

#include "compare/sheet.h"
#include "report/html.h"

#include <string>

namespace fettle {

/// A sheet that becomes a drawing of a page: text stays text, lines stay lines, pictures are PNGs inside it.
class SvgSheet final : public Sheet {
  public:
    SvgSheet(int width, int height) : width_(width), height_(height) {}

    double text_width(const std::string& words, double capital_height, bool bold = false) const override;
    void box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour) override;
    void image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, int columns,
               std::span<const std::uint8_t> rgb) override;

    /// @param label  what a reader hears who cannot see it
    Html drawing(const std::string& label) const;

  private:
    void draw_text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour,
                   Align align, bool bold) override;
    void draw_line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed) override;

    int width_, height_;
    Html drawn_;
};

} // namespace fettle
