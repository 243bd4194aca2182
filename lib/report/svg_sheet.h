#pragma once

#include "compare/sheet.h"
#include "report/html.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fettle {

/// A sheet that becomes a drawing of a page: text stays text, lines stay lines; what is set pixel by pixel becomes one
/// picture beneath what is drawn after it.
class SvgSheet final : public Sheet {
  public:
    SvgSheet(int width, int height);

    double text_width(const std::string& words, double capital_height, bool bold = false) const override;
    void box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour) override;
    void dot(int column, int row, const Rgb& colour) override;

    /// @param label  what a reader hears who cannot see it
    Html drawing(const std::string& label) const;

  private:
    void draw_text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour,
                   Align align, bool bold) override;
    void draw_line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed) override;

    int width_, height_;
    Html below_, above_;                        ///< the pixels
    Rgb background_ = {255, 255, 255};          ///< of pixels that are not set: that of the last box beneath them
    std::vector<std::uint8_t> pixels_;          ///< red, green, blue, row by row; empty before the first
    int left_, right_ = -1, top_, bottom_ = -1; ///< of the pixels that were set
};

} // namespace fettle
