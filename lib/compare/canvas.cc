#include "compare/canvas.h"

#include "compare/png.h"

#include <opencv2/imgproc.hpp>

#include <array>
#include <cmath>

namespace fettle {
namespace {

// Hershey strokes are drawn this many times larger and averaged down: smooth at every size.
constexpr int kOversampling = 4;
// Capital letters of the font, at scale 1, pixels.
constexpr double kCapital = 21;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
// Fractions of a pixel that OpenCV's fixed-point coordinates keep.
constexpr int kShift = 4;

cv::Scalar scalar(const Rgb& c) { return {double(c[0]), double(c[1]), double(c[2])}; }

// U+00A0 to U+00FF as they are written where there is only ASCII.
constexpr std::array<const char*, 96> kLatin = {
    " ",   "!",  "c", "GBP", "?",  "JPY", "|",    "par.", "\"", "(c)", "a", "<<", "-",   "-",   "(R)", "-",
    "deg", "+-", "2", "3",   "'",  "u",   "par.", ".",    ",",  "1",   "o", ">>", "1/4", "1/2", "3/4", "?",
    "A",   "A",  "A", "A",   "Ae", "Aa",  "AE",   "C",    "E",  "E",   "E", "E",  "I",   "I",   "I",   "I",
    "D",   "N",  "O", "O",   "O",  "O",   "Oe",   "x",    "Oe", "U",   "U", "U",  "Ue",  "Y",   "Th",  "ss",
    "a",   "a",  "a", "a",   "ae", "aa",  "ae",   "c",    "e",  "e",   "e", "e",  "i",   "i",   "i",   "i",
    "d",   "n",  "o", "o",   "o",  "o",   "oe",   "/",    "oe", "u",   "u", "u",  "ue",  "y",   "th",  "y"};

/// The font holds ASCII alone: letters of western languages are written by others, dashes as "-", the rest as "?".
std::string plain(const std::string& words)
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

/// A stroke grows with the letter: a ninth of its height, bold a sixth.
int stroke(double capital_height, bool bold)
{
    return std::max(1, static_cast<int>(std::lround(kOversampling * capital_height / (bold ? 6 : 9))));
}

cv::Size text_size(const std::string& words, double capital_height, bool bold)
{
    int below = 0;
    const double scale = kOversampling * capital_height / kCapital;
    return cv::getTextSize(words, kFont, scale, stroke(capital_height, bold), &below);
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
    return double(text_size(plain(words), capital_height, bold).width) / kOversampling;
}

void Canvas::draw_text(const std::string& words, const Eigen::Vector2d& at, double capital_height, const Rgb& colour,
                       Align align, bool bold)
{
    const double shift = align == Align::left ? 0 : align == Align::centre ? 0.5 : 1;
    const double left = at.x() - shift * text_width(words, capital_height, bold);
    const double base = at.y() + capital_height / 2;
    // A mask around the text, with room for strokes, tails and the average; then the ink by how much of it there is.
    const int room = static_cast<int>(std::ceil(capital_height));
    const std::string letters_of_font = plain(words);
    const cv::Size letters = text_size(letters_of_font, capital_height, bold) / kOversampling;
    const cv::Rect place(static_cast<int>(std::floor(left)) - room, static_cast<int>(std::floor(base)) - 2 * room,
                         letters.width + 2 * room + 2, 3 * room + 2);
    cv::Mat1b mask(place.height * kOversampling, place.width * kOversampling, uchar(0));
    const cv::Point pen(static_cast<int>(std::lround(kOversampling * (left - place.x))),
                        static_cast<int>(std::lround(kOversampling * (base - place.y))));
    cv::putText(mask, letters_of_font, pen, kFont, kOversampling * capital_height / kCapital, 255,
                stroke(capital_height, bold), cv::LINE_AA);
    cv::resize(mask, mask, place.size(), 0, 0, cv::INTER_AREA);
    const cv::Rect visible = place & cv::Rect(0, 0, width(), height());
    for (int row = visible.y; row < visible.y + visible.height; ++row)
        for (int column = visible.x; column < visible.x + visible.width; ++column) {
            const double ink = mask(row - place.y, column - place.x) / 255.0;
            cv::Vec3b& pixel = state_->sheet(row, column);
            for (int i = 0; i < 3; ++i)
                pixel[i] =
                    static_cast<uchar>(std::lround(std::lerp(pixel[i], colour[static_cast<std::size_t>(i)], ink)));
        }
}

void Canvas::box(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Rgb& colour)
{
    const cv::Rect rectangle(
        cv::Point(static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y()))),
        cv::Point(static_cast<int>(std::lround(corner.x() + size.x())),
                  static_cast<int>(std::lround(corner.y() + size.y()))));
    if (!rectangle.empty()) cv::rectangle(state_->sheet, rectangle, scalar(colour), cv::FILLED);
}

void Canvas::draw_line(const Eigen::Matrix2Xd& points, const Rgb& colour, double width, bool closed)
{
    std::vector<cv::Point> path;
    for (const Eigen::Vector2d& p : points.colwise())
        path.emplace_back(static_cast<int>(std::lround(p.x() * (1 << kShift))),
                          static_cast<int>(std::lround(p.y() * (1 << kShift))));
    cv::polylines(state_->sheet, path, closed, scalar(colour), std::max(1, static_cast<int>(std::lround(width))),
                  cv::LINE_AA, kShift);
}

void Canvas::image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, int columns,
                   std::span<const std::uint8_t> rgb)
{
    const Eigen::Vector2d least = corner.array().round(), whole = size.array().round();
    const int rows = static_cast<int>(rgb.size()) / (3 * columns);
    const cv::Rect place(static_cast<int>(least.x()), static_cast<int>(least.y()), static_cast<int>(whole.x()),
                         static_cast<int>(whole.y()));
    const cv::Rect visible = place & cv::Rect(0, 0, width(), height());
    for (int row = visible.y; row < visible.y + visible.height; ++row)
        for (int column = visible.x; column < visible.x + visible.width; ++column) {
            const int from_row = (row - place.y) * rows / place.height;
            const int from_column = (column - place.x) * columns / place.width;
            const std::uint8_t* pixel = rgb.data() + 3 * (std::ptrdiff_t(from_row) * columns + from_column);
            state_->sheet(row, column) = cv::Vec3b(pixel[0], pixel[1], pixel[2]);
        }
}

std::string Canvas::png() const
{
    const cv::Mat3b& sheet = state_->sheet; // made whole: its rows follow each other without gaps
    return encode_png({sheet.data, 3 * sheet.total()}, sheet.cols, sheet.rows);
}

} // namespace fettle
