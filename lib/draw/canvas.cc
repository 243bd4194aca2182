#include "draw/canvas.h"

#include "draw/png.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::draw {
namespace {

// Hershey strokes are drawn this many times larger and averaged down: smooth at every size.
constexpr int kOversampling = 4;
// Height of the font's capital letters at scale 1, pixels.
constexpr double kFontCapitalHeight = 21;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
// Fractional bits of OpenCV's fixed-point coordinates.
constexpr int kFractionBits = 4;

cv::Scalar scalar(const Rgb& c) { return {double(c[0]), double(c[1]), double(c[2])}; }

cv::Point rounded(const Eigen::Vector2d& p) { return cv::Point(std::lround(p.x()), std::lround(p.y())); }

// ASCII substitutes of U+00A0 to U+00FF.
constexpr std::array<const char*, 96> kLatin = {
    " ",   "!",  "c", "GBP", "?",  "JPY", "|",    "par.", "\"", "(c)", "a", "<<", "-",   "-",   "(R)", "-",
    "deg", "+-", "2", "3",   "'",  "u",   "par.", ".",    ",",  "1",   "o", ">>", "1/4", "1/2", "3/4", "?",
    "A",   "A",  "A", "A",   "Ae", "Aa",  "AE",   "C",    "E",  "E",   "E", "E",  "I",   "I",   "I",   "I",
    "D",   "N",  "O", "O",   "O",  "O",   "Oe",   "x",    "Oe", "U",   "U", "U",  "Ue",  "Y",   "Th",  "ss",
    "a",   "a",  "a", "a",   "ae", "aa",  "ae",   "c",    "e",  "e",   "e", "e",  "i",   "i",   "i",   "i",
    "d",   "n",  "o", "o",   "o",  "o",   "oe",   "/",    "oe", "u",   "u", "u",  "ue",  "y",   "th",  "y"};

/// The font holds only ASCII: Latin-1 characters are replaced by kLatin, dashes by "-", all others by "?".
std::string to_ascii(const std::string& words)
{
    std::string ascii;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto byte = [&](std::size_t k) { return k < words.size() ? static_cast<unsigned char>(words[k]) : 0U; };
        const bool latin = (byte(i) == 0xC2 && byte(i + 1) >= 0xA0) || byte(i) == 0xC3;
        const bool dash = byte(i) == 0xE2 && ((byte(i + 1) == 0x80 && byte(i + 2) >= 0x90 && byte(i + 2) <= 0x95) ||
                                              (byte(i + 1) == 0x88 && byte(i + 2) == 0x92));
        if (byte(i) < 0x80)
            ascii += words[i];
        else if (latin && byte(i + 1) >= 0x80)
            ascii += kLatin[(byte(i + 1) & 0x3FU) + (byte(i) == 0xC3 ? 0x40U : 0U) - 0x20U];
        else
            ascii += dash ? "-" : "?";
        while (byte(i) >= 0x80 && (byte(i + 1) & 0xC0U) == 0x80) ++i; // the rest of the character
    }
    return ascii;
}

/// Width of a stroke: a ninth of the letter's height, bold a sixth.
int stroke_width(double capital_height, bool bold)
{
    return std::max(1L, std::lround(kOversampling * capital_height / (bold ? 6 : 9)));
}

cv::Size text_size(const std::string& words, double capital_height, bool bold)
{
    int baseline = 0;
    const double scale = kOversampling * capital_height / kFontCapitalHeight;
    return cv::getTextSize(words, kFont, scale, stroke_width(capital_height, bold), &baseline);
}

} // namespace

struct Canvas::State {
    cv::Mat3b sheet; // red, green, blue
};

Canvas::Canvas(int width, int height)
    : state_(std::make_unique<State>(State{cv::Mat3b(height, width, cv::Vec3b(255, 255, 255))}))
{
}
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas::~Canvas() = default;

int Canvas::width() const { return state_->sheet.cols; }
int Canvas::height() const { return state_->sheet.rows; }

double Canvas::text_width(const std::string& words, double capital_height, bool bold) const
{
    return double(text_size(to_ascii(words), capital_height, bold).width) / kOversampling;
}

void Canvas::draw_text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour,
                       Align align, bool bold)
{
    const double shift = align == Align::left ? 0 : align == Align::centre ? 0.5 : 1;
    const double left = at.x() - shift * text_width(words, capital_height, bold);
    const double base = at.y() + capital_height / 2;
    // An oversampled mask of the text, with a margin for strokes and descenders, is averaged down; its coverage blends
    // the colour in.
    const int margin = std::ceil(capital_height);
    const std::string ascii = to_ascii(words);
    const cv::Size letters = text_size(ascii, capital_height, bold) / kOversampling;
    const cv::Rect area(std::floor(left) - margin, std::floor(base) - 2 * margin, letters.width + 2 * margin + 2,
                        3 * margin + 2);
    cv::Mat1b mask(area.height * kOversampling, area.width * kOversampling, uchar(0));
    const cv::Point pen = rounded(kOversampling * Eigen::Vector2d(left - area.x, base - area.y));
    cv::putText(mask, ascii, pen, kFont, kOversampling * capital_height / kFontCapitalHeight, 255,
                stroke_width(capital_height, bold), cv::LINE_AA);
    cv::resize(mask, mask, area.size(), 0, 0, cv::INTER_AREA);
    const cv::Rect visible = area & cv::Rect(0, 0, width(), height());
    for (int row = visible.y; row < visible.y + visible.height; ++row)
        for (int column = visible.x; column < visible.x + visible.width; ++column) {
            const double coverage = mask(row - area.y, column - area.x) / 255.0;
            cv::Vec3b& pixel = state_->sheet(row, column);
            for (int i = 0; i < 3; ++i)
                pixel[i] = static_cast<uchar>(std::lround(std::lerp(pixel[i], colour[i], coverage)));
        }
}

void Canvas::box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour)
{
    cv::Rect rectangle(rounded(corner), rounded(corner + size));
    rectangle.width = std::max(rectangle.width, 1); // as on an SvgSheet, a box without width is a line
    rectangle.height = std::max(rectangle.height, 1);
    cv::rectangle(state_->sheet, rectangle, scalar(colour), cv::FILLED);
}

void Canvas::line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed)
{
    std::vector<cv::Point> path;
    for (const Eigen::Vector2d& p : points.colwise()) path.push_back(rounded(p * (1 << kFractionBits)));
    cv::polylines(state_->sheet, path, closed, scalar(colour), std::max(1L, std::lround(width)), cv::LINE_AA,
                  kFractionBits);
}

void Canvas::image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, int columns,
                   std::span<const std::uint8_t> rgb)
{
    const int rows = static_cast<int>(rgb.size()) / (3 * columns);
    const cv::Rect area(rounded(corner), cv::Size(rounded(size)));
    const cv::Rect visible = area & cv::Rect(0, 0, width(), height());
    for (int row = visible.y; row < visible.y + visible.height; ++row)
        for (int column = visible.x; column < visible.x + visible.width; ++column) {
            const int from_row = (row - area.y) * rows / area.height;
            const int from_column = (column - area.x) * columns / area.width;
            const std::uint8_t* pixel = rgb.data() + 3 * (std::ptrdiff_t(from_row) * columns + from_column);
            state_->sheet(row, column) = cv::Vec3b(pixel[0], pixel[1], pixel[2]);
        }
}

std::string Canvas::png() const
{
    const cv::Mat3b& sheet = state_->sheet; // continuous: its rows have no padding
    return encode_png({sheet.data, 3 * sheet.total()}, sheet.cols, sheet.rows);
}

Eigen::ArrayXXd gaussian_blur(const Eigen::ArrayXXd& image, double sigma)
{
    const int side = 2 * static_cast<int>(std::ceil(3 * sigma)) + 1; // beyond 3σ lies 0.3 % of the weight
    Eigen::ArrayXXd blurred(image.rows(), image.cols());
    // The rows of OpenCV's matrices are Eigen's columns.
    const cv::Mat1d from(static_cast<int>(image.cols()), static_cast<int>(image.rows()),
                         const_cast<double*>(image.data()));
    cv::Mat1d to(from.rows, from.cols, blurred.data());
    cv::GaussianBlur(from, to, {side, side}, sigma, sigma, cv::BORDER_CONSTANT);
    return blurred;
}

} // namespace fettle::draw
