#pragma once

#include "draw/sheet.h"

#include <Eigen/Core>

#include <memory>
#include <string>

namespace fettle::draw {

/// A white raster image, drawn with OpenCV.
class Canvas final : public Sheet {
  public:
    Canvas(int width, int height);
    Canvas(Canvas&&) noexcept;
    ~Canvas() override;

    double text_width(const std::string& words, double capital_height, bool bold = false) const override;
    void box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour) override;
    void line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed = false) override;
    /// Scales by nearest neighbour.
    void image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, int columns,
               std::span<const std::uint8_t> rgb) override;

    int width() const;
    int height() const;
    /// The bytes of a PNG file.
    std::string png() const;

  private:
    void draw_text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour,
                   Align align, bool bold) override;

    struct State;
    std::unique_ptr<State> state_;
};

/// Gaussian filter of an image, which is 0 beyond its border. @param sigma  pixels
Eigen::ArrayXXd gaussian_blur(const Eigen::ArrayXXd& image, double sigma);

} // namespace fettle::draw
