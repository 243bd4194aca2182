// Charts read back: where the marks of known points are.
#include "draw/chart.h"

#include "draw/canvas.h"
#include "draw/ticks.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <limits>
#include <vector>

namespace fettle {
namespace chart_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kWidth = 600, kHeight = 400;
const draw::Rgb kRed = {255, 0, 0};

/// Columns and rows of the pixels of pure red.
std::vector<Eigen::Vector2d> red_pixels(const draw::Chart& chart)
{
    draw::Canvas sheet(kWidth, kHeight);
    draw::draw_chart(sheet, {0, 0}, {kWidth, kHeight}, chart);
    const std::string bytes = sheet.png();
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> rgb(3 * kWidth * kHeight);
    EXPECT_NE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr), 0);
    std::vector<Eigen::Vector2d> found;
    for (int i = 0; i < kWidth * kHeight; ++i)
        if (rgb[3 * i] == 255 && rgb[3 * i + 1] == 0 && rgb[3 * i + 2] == 0) found.emplace_back(i % kWidth, i / kWidth);
    return found;
}

/// Middles of the marks of three points, each by itself, from left to right.
std::vector<Eigen::Vector2d> marks(const Eigen::Vector3d& x, const Eigen::Vector3d& y, bool logarithmic)
{
    draw::Chart chart;
    chart.logarithmic = logarithmic;
    for (int i = 0; i < 3; ++i) chart.curves.push_back({"", Eigen::Vector2d(x[i], y[i]), kRed});
    const std::vector<Eigen::Vector2d> pixels = red_pixels(chart);
    std::vector<Eigen::Vector2d> middles;
    constexpr double kMinMarkSpacing = 20; // marks are smaller, and further from each other
    for (const Eigen::Vector2d& pixel : pixels) {
        const bool known = std::any_of(middles.begin(), middles.end(),
                                       [&](const Eigen::Vector2d& m) { return (m - pixel).norm() < kMinMarkSpacing; });
        if (!known) middles.push_back(pixel); // the upper left corner of each: rows come first
    }
    std::sort(middles.begin(), middles.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
    return middles;
}

TEST(Chart, PlacesAreLinearInXAndY)
{
    const std::vector<Eigen::Vector2d> at = marks({0, 1, 4}, {10, 20, 50}, false);
    ASSERT_EQ(at.size(), 3U);
    const Eigen::Vector2d first = at[1] - at[0], second = at[2] - at[1];
    EXPECT_LT(first.y(), 0); // y up
    EXPECT_NEAR(second.x(), 3 * first.x(), 2);
    EXPECT_NEAR(second.y(), 3 * first.y(), 2);
}

TEST(Chart, LogarithmicYStepsAlikeForEachPowerOfTen)
{
    const std::vector<Eigen::Vector2d> at = marks({0, 1, 2}, {0.01, 0.1, 1}, true);
    ASSERT_EQ(at.size(), 3U);
    EXPECT_LT(at[1].y(), at[0].y() - 50);
    EXPECT_NEAR(at[2].y() - at[1].y(), at[1].y() - at[0].y(), 1);
}

TEST(Chart, LinesBreakWhereThereIsNoNumber)
{
    draw::Chart whole, broken;
    Eigen::Matrix2Xd points(2, 5);
    points << 0, 1, 2, 3, 4, 0, 0, 0, 0, 0;
    whole.curves.push_back({"", points, kRed, false});
    points(1, 2) = kNaN;
    broken.curves.push_back({"", points, kRed, false});
    // two of the four stretches are left
    EXPECT_NEAR(double(red_pixels(broken).size()), red_pixels(whole).size() / 2.0, 8);
    // nor has 0 a logarithm
    whole.logarithmic = true;
    EXPECT_TRUE(red_pixels(whole).empty());
}

TEST(Ticks, EachLabelIsItsValue)
{
    for (const double span : {3e-12, 7e-9, 2e-6, 4e-4, 0.3, 1.0, 40.0, 9e5})
        for (const double offset : {0.0, 1.0, 100.0}) {
            const double step = draw::tick_step(span, 8);
            if (step < 1e-9 * offset) continue;
            for (int k = -8; k <= 8; ++k) {
                const double value = std::round(offset / step) * step + k * step;
                EXPECT_NEAR(std::stod(draw::tick_text(value, step)), value, 1e-6 * step) << step;
            }
        }
    EXPECT_EQ(draw::tick_text(1.5e-12, 5e-13), "1.5e-12");
    EXPECT_EQ(draw::tick_text(-1e-20, 5e-13), "0");
    EXPECT_EQ(draw::tick_text(-1e-20, 0.05), "0.00");
    EXPECT_EQ(draw::tick_text(0.000002, 0.000001), "0.000002");
}

} // namespace chart_test
} // namespace fettle
