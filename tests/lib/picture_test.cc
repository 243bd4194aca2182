// Pictures read back: the colours at known places are those of the values there.
#include "draw/picture.h"

#include "core/error.h"
#include "draw/canvas.h"
#include "draw/colours.h"
#include "draw/field_scale.h"
#include "draw/outline.h"
#include "draw/picture_parts.h"
#include "draw/png.h"
#include "draw/raster.h"
#include "draw/view.h"

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

namespace fettle {
namespace picture_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const draw::ColourScale kUnit{1};

/// 20 x 20 points, 2 mm apart; their error is that of `error` over the grid's own coordinates.
template <typename Error>
cloud::Cloud grid(const Error& error, double angle = 0)
{
    cloud::Cloud cloud;
    cloud.xyz.resize(3, 400);
    Eigen::VectorXd errors(400);
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
    for (int i = 0; i < 400; ++i) {
        const Eigen::Vector2d at(2 * (i % 20), 2 * (i / 20));
        cloud.xyz.col(i) << turn * at, 1;
        errors[i] = error(at);
    }
    cloud::set_field(cloud, "error", errors);
    return cloud;
}

struct Sheet {
    int width = 0;
    std::vector<std::uint8_t> rgb;
};

Sheet decoded(const std::string& bytes)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
        throw std::runtime_error(image.message);
    EXPECT_EQ(image.format, PNG_FORMAT_RGB); // 8 bit, three channels, no palette
    Sheet sheet{static_cast<int>(image.width), std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
    if (png_image_finish_read(&image, nullptr, sheet.rgb.data(), 0, nullptr) == 0)
        throw std::runtime_error(image.message);
    return sheet;
}

Sheet drawn(const std::variant<cloud::Cloud, mesh::Mesh>& part, const draw::PictureOptions& options)
{
    return decoded(draw::picture(part, options));
}

draw::Rgb at(const Sheet& sheet, int column, int row)
{
    const std::size_t red =
        3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(sheet.width) + static_cast<std::size_t>(column));
    return {sheet.rgb.at(red), sheet.rgb.at(red + 1), sheet.rgb.at(red + 2)};
}

draw::PictureOptions errors_to(double limit)
{
    draw::PictureOptions options;
    options.field = "error";
    options.scale = limit;
    return options;
}

// A square map of 680 pixels is in the middle of the frame of 900 x 680 whose corner is (84, 36).
constexpr int kLeft = 84 + 110, kTop = 36, kSide = 680;

TEST(FieldScale, NamesTheUnitOfAField)
{
    const units::Units metric, imperial{units::Units::Length::in, units::Units::Force::lbf};
    for (const auto& [field, in_mm, in_inch] :
         {std::tuple("z", "mm", "in"), std::tuple("error", "mm", "in"), std::tuple("area", "mm2", "in2"),
          std::tuple("removed_volume", "mm3", "in3"), std::tuple("force", "N", "lbf"),
          std::tuple("feed", "mm/s", "in/s"), std::tuple("pressure", "N/mm2", "lbf/in2"),
          std::tuple("class", "", "")}) {
        EXPECT_EQ(draw::unit_of_field(field, metric), in_mm);
        EXPECT_EQ(draw::unit_of_field(field, imperial), in_inch);
    }
}

TEST(Picture, WritesNumbersThatTellTheirRangeApart)
{
    EXPECT_EQ(draw::number_text(0.75352), "0.754");
    EXPECT_EQ(draw::number_text(0.75352, 3e-4), "0.7535"); // a ground face, 0.003 in over the lowest
    EXPECT_EQ(draw::number_text(0.7502, 3e-4), "0.7502");
    EXPECT_EQ(draw::number_text(-1.25, 0.2), "-1.25"); // a range as wide as the number needs no more
    EXPECT_EQ(draw::number_text(999.7), "1000");
    EXPECT_EQ(draw::number_text(12345.6), "12346");
    EXPECT_EQ(draw::number_text(1234.56, 0.2), "1234.6");
    EXPECT_EQ(draw::number_text(1234567), "1.23e+06");
    EXPECT_EQ(draw::number_text(-0.0), "0");
    EXPECT_EQ(draw::number_text(kNaN), "-");
}

TEST(Picture, EachPointIsItsCellWithTheColourOfItsValue)
{
    const cloud::Cloud cloud = grid([](const Eigen::Vector2d& p) {
        return p.x() < 19 ? p.y() < 19 ? -1 : 0 : p.y() < 19 ? kNaN : 1;
    });
    const Sheet sheet = drawn(cloud, errors_to(1));
    for (int column = 2; column < kSide - 2; ++column)
        for (int row = 2; row < kSide - 2; ++row) {
            if (std::abs(column - kSide / 2) < 2 || std::abs(row - kSide / 2) < 2) continue;
            const bool left = column<kSide / 2, below = row> kSide / 2;
            const double error = left ? below ? -1 : 0 : below ? kNaN : 1;
            // No holes between the cells; y grows upwards.
            ASSERT_EQ(at(sheet, kLeft + column, kTop + row), kUnit(error)) << column << ' ' << row;
        }
    // The legend: material left on top, over-cut at the bottom.
    const double third_row = 1 - 2 * 2.5 / (kSide - 124); // of a bar 62 pixels inside the frame
    EXPECT_EQ(at(sheet, 84 + 900 + 40 + 10, kTop + 62 + 2), kUnit(third_row));
    EXPECT_EQ(at(sheet, 84 + 900 + 40 + 10, kTop + kSide - 62 - 3), kUnit(-third_row));
}

TEST(Picture, TurnedGridsHaveNoHoles)
{
    const Sheet sheet = drawn(grid([](const Eigen::Vector2d&) { return 0.5; }, 0.4), errors_to(1));
    // A disc about the middle of the frame, within the turned square.
    for (int column = -200; column <= 200; ++column)
        for (int row = -200; row <= 200; ++row) {
            if (std::hypot(column, row) > 200) continue;
            ASSERT_EQ(at(sheet, 84 + 450 + column, kTop + 340 + row), kUnit(0.5));
        }
}

TEST(Picture, BandsAreStepsOfColour)
{
    draw::PictureOptions options = errors_to(1);
    options.bands = 4; // middles at ±0.25 and ±0.75
    const Sheet sheet = drawn(grid([](const Eigen::Vector2d& p) { return p.x() < 19 ? 0.01 : 0.49; }), options);
    EXPECT_EQ(at(sheet, kLeft + 100, kTop + 300), kUnit(0.25));
    EXPECT_EQ(at(sheet, kLeft + 500, kTop + 300), kUnit(0.25));
}

TEST(Picture, IsTheSameEachTime)
{
    const cloud::Cloud cloud = grid([](const Eigen::Vector2d& p) { return std::sin(p.x()); });
    EXPECT_EQ(draw::picture(cloud, errors_to(1)), draw::picture(cloud, errors_to(1)));
}

/// A square of 21 x 21 points, 1 mm apart, upright in the plane y = `y`, x and z from -10 to 10, all of one error.
void add_wall(cloud::Cloud& cloud, double y, double error)
{
    cloud::Cloud wall;
    wall.xyz.resize(3, 441);
    for (int i = 0; i < 441; ++i) wall.xyz.col(i) << i % 21 - 10, y, i / 21 - 10;
    const Eigen::Index known = cloud.size();
    Eigen::VectorXd errors(known + 441);
    if (known > 0) errors.head(known) = cloud::field(cloud, "error");
    errors.tail(441).setConstant(error);
    cloud.xyz.conservativeResize(3, known + 441);
    cloud.xyz.rightCols(441) = wall.xyz;
    cloud::set_field(cloud, "error", errors);
}

// Two walls behind each other, 3 mm apart: from either side only the nearer one is visible.
TEST(Picture, WhatIsBehindIsHidden)
{
    cloud::Cloud cloud;
    add_wall(cloud, 0, 0.5);
    add_wall(cloud, 3, -0.5);
    for (const double side : {-1.0, 1.0}) {
        draw::PictureOptions options = errors_to(1);
        options.towards_eye = {0, side, 0};
        const Sheet sheet = drawn(cloud, options);
        for (int column = 5; column < kSide - 5; ++column)
            for (int row = 5; row < kSide - 5; ++row)
                ASSERT_EQ(at(sheet, kLeft + column, kTop + row), kUnit(-0.5 * side)) << column << ' ' << row;
    }
}

// Up and right of each view: Z is up, or Y when looking along Z. Reference: right-handed frames, by hand.
TEST(View, ZIsUpOnTheSheet)
{
    const auto expect = [](const Eigen::Vector3d& from, const Eigen::Vector3d& right, const Eigen::Vector3d& up) {
        const Eigen::Matrix3d rotation = draw::view_rotation(from);
        EXPECT_LT((rotation.row(0).transpose() - right).norm(), 1e-15);
        EXPECT_LT((rotation.row(1).transpose() - up).norm(), 1e-15);
        EXPECT_LT((rotation.row(2).transpose() - from).norm(), 1e-15);
        EXPECT_NEAR(rotation.determinant(), 1, 1e-15);
    };
    expect({0, 0, 1}, {1, 0, 0}, {0, 1, 0});
    expect({0, 0, -1}, {-1, 0, 0}, {0, 1, 0});
    expect({0, -1, 0}, {1, 0, 0}, {0, 0, 1});
    expect({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    const double half = std::sqrt(0.5);
    expect({0, -half, half}, {1, 0, 0}, {0, half, half});
}

// The position of an edge between colours shows the direction of view: a step of the error at x = 1 on a plane that is
// seen at 60° from its normal, so that y is half as long on the sheet and x is not.
TEST(Picture, LengthsAreProjectedLengths)
{
    draw::PictureOptions options = errors_to(1);
    options.towards_eye = {0, -std::sqrt(0.75), 0.5};
    const Sheet sheet = drawn(grid([](const Eigen::Vector2d& p) { return p.y() < 9 ? 1 : -1; }), options); // 40 x 40 mm
    const double pixel = 40.0 / 900;
    int blue = 0, red = 0; // rows in the middle column
    for (int row = 0; row < 480; ++row) {
        const draw::Rgb colour = at(sheet, 84 + 450, kTop + row);
        blue += colour[2] > colour[0] + 30;
        red += colour[0] > colour[2] + 30;
    }
    // Rows of points are 1 mm apart on the sheet; half a spacing is left around them.
    EXPECT_NEAR(blue * pixel, 9 / 2.0 + 1, 1);
    EXPECT_NEAR(red * pixel, (38 - 9) / 2.0 + 1, 1);
}

// Numbers do not depend on where a mesh is seen from. Reference: those from above. A roof of 20 x 20 mm, 5 mm high.
TEST(Picture, HeightsAreThoseOfThePart)
{
    mesh::Mesh roof;
    roof.vertices.resize(3, 6);
    roof.vertices << 0, 20, 20, 0, 0, 20, 0, 0, 20, 20, 10, 10, 0, 0, 0, 0, 5, 5;
    roof.triangles.resize(3, 4);
    roof.triangles.transpose() << 0, 1, 5, 0, 5, 4, 2, 3, 4, 2, 4, 5;
    draw::PictureOptions options;
    const Sheet above = drawn(roof, options);
    options.towards_eye = Eigen::Vector3d(0, -1, 1).normalized();
    const Sheet aside = drawn(roof, options);
    ASSERT_EQ(above.width, aside.width);
    const auto numbers = [](const Sheet& sheet) { // the last line
        return std::vector<std::uint8_t>(sheet.rgb.end() - 3 * 50 * sheet.width, sheet.rgb.end());
    };
    EXPECT_EQ(numbers(above), numbers(aside));
    EXPECT_NE(numbers(above), std::vector<std::uint8_t>(numbers(above).size(), 255));
    EXPECT_NE(above.rgb, aside.rgb);
}

// The legend has pointed ends where values lie beyond, else not. The tips are 2 pixels beyond the bar's frame.
TEST(Picture, MarksTheEndsThatValuesExceed)
{
    const int middle = 84 + 900 + 40 + 11, top = kTop + 62 - 6, bottom = kTop + kSide - 62 + 6;
    const draw::Rgb white = {255, 255, 255};
    const cloud::Cloud cloud = grid([](const Eigen::Vector2d& p) { return p.x() < 1 ? 2 : 0.5; });
    const Sheet beyond = drawn(cloud, errors_to(1)), within = drawn(cloud, errors_to(2));
    EXPECT_EQ(at(beyond, middle, top), kUnit(1));
    EXPECT_EQ(at(beyond, middle, bottom), white);
    EXPECT_EQ(at(within, middle, top), white);
}

// Where most values are in one bin, its bar is broken and the next takes half of the width; else the longest takes all.
TEST(Picture, BreaksABarOfTheHistogramThatHidesTheOthers)
{
    constexpr int kBar = kSide - 2 * 62, kBarTop = kTop + 62, left = 84 + 900 + 40 + 22 + 70;
    const auto length = [&](const Sheet& sheet, int row) {
        int column = left + 1;
        while (at(sheet, column, row) != draw::Rgb{255, 255, 255}) ++column;
        return column - left;
    };
    const auto sheet_of = [](double low_columns) { // the error is 0.01 there, else 0.51, which is in another bin
        return drawn(grid([=](const Eigen::Vector2d& p) { return p.x() < 2 * low_columns - 1 ? 0.01 : 0.51; }),
                     errors_to(1));
    };
    const int row_of_low = kBarTop + kBar / 2 - kBar / 120, row_of_high = kBarTop + kBar / 4 - kBar / 120;
    const Sheet equal = sheet_of(10), few = sheet_of(2);
    EXPECT_NEAR(length(equal, row_of_low), 150, 2);
    EXPECT_NEAR(length(equal, row_of_high), 150, 2);
    EXPECT_NEAR(length(few, row_of_low), 75, 2);  // 2 columns of points beside 18
    EXPECT_NEAR(length(few, row_of_high), 90, 2); // up to the break
}

// Outlines beyond the part belong to the picture: they lie in the frame, and the part where it is.
TEST(Picture, BoundariesAreInTheFrame)
{
    draw::PictureOptions options = errors_to(1);
    options.job.emplace();
    options.job->anomaly.resize(3, 4);
    options.job->anomaly << 10, 28, 28, 10, 10, 10, 28, 28, 1, 1, 1, 1;
    options.job->sampling.resize(3, 4);
    options.job->sampling << -31, 69, 69, -31, -31, -31, 69, 69, kNaN, kNaN, kNaN, kNaN;
    const Sheet sheet = drawn(grid([](const Eigen::Vector2d&) { return 1; }), options); // from 0 to 38
    // S, and half a spacing around it, fill the frame's height: 102 mm on 680 pixels.
    const double pixel = 102.0 / kSide;
    const auto place = [&](double x, double y) {
        return at(sheet, kLeft + static_cast<int>((x + 32) / pixel), kTop + kSide - static_cast<int>((y + 32) / pixel));
    };
    EXPECT_EQ(place(5, 5), kUnit(1));
    EXPECT_NE(place(-10, -10), kUnit(1));
    for (const double end : {-31.0, 69.0}) {
        const draw::Rgb edge = place(end, 19); // violet
        EXPECT_GT(edge[2], edge[1] + 40) << end;
    }
    // Errors of 2 outside B: the legend's end is pointed although none of those that count lies beyond.
    const cloud::Cloud steps = grid([](const Eigen::Vector2d& p) { return p.x() < 7 ? 2 : 0.5; });
    EXPECT_EQ(at(drawn(steps, options), 84 + 900 + 40 + 11, kTop + 62 - 6), kUnit(1));
    const draw::Rgb inner = place(10, 19); // black, on blue
    EXPECT_LT(inner[2], 60);
}

// A pyramid under light from the upper left.
TEST(Picture, HeightsAreShaded)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 5);
    mesh.vertices << -10, 10, 10, -10, 0, -10, -10, 10, 10, 0, 0, 0, 0, 0, 5;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 1, 2, 3, 1, 2, 3, 0, 4, 4, 4, 4;
    draw::PictureOptions options;
    options.scale = 1e6; // one colour: what differs is the light
    const Sheet sheet = drawn(mesh, options);
    const auto light = [&](int column, int row) { return at(sheet, kLeft + column, kTop + row)[1]; };
    EXPECT_GT(light(340, 100), light(340, 580)); // north over south
    EXPECT_GT(light(100, 340), light(580, 340)); // west over east
}

TEST(Picture, HasRoomForOnePoint)
{
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Vector3d(3, 4, 5);
    const Sheet sheet = drawn(cloud, {});
    EXPECT_NE(at(sheet, 84 + 450, kTop + 340), (draw::Rgb{228, 228, 232})); // the disc in the middle
    EXPECT_EQ(at(sheet, 84 + 450 + 100, kTop + 340), (draw::Rgb{228, 228, 232}));
}

TEST(Picture, RefusesWhatItCannotDraw)
{
    cloud::Cloud cloud;
    EXPECT_THROW(draw::picture(cloud, {}), core::InputError);
    cloud.xyz = Eigen::Matrix3Xd::Constant(3, 4, kNaN);
    EXPECT_THROW(draw::picture(cloud, {}), core::InputError);
    cloud.xyz.setRandom();
    EXPECT_THROW(draw::picture(cloud, errors_to(1)), core::InputError); // no such field
}

// The font is ASCII: what it lacks is written with what it has. Reference: the same words in ASCII.
TEST(Canvas, WritesWesternLettersByOthers)
{
    const auto drawn_text = [](const std::string& words) {
        draw::Canvas sheet(700, 40);
        sheet.text(words, {10, 20}, 12);
        return sheet.png();
    };
    EXPECT_EQ(drawn_text("Gu\u00DFteil \u2013 Pr\u00FCfung \u00B10.5 \u00E9\u00FF"),
              drawn_text("Gussteil - Pruefung +-0.5 ey"));
    EXPECT_EQ(drawn_text("\u22125 \u2212"), drawn_text("-5 -"));
    EXPECT_EQ(drawn_text("a\u4E2D\xFFz\xC3"), drawn_text("a??z?"));
}

// Noise cannot be packed: the file is larger than its pixels.
TEST(Png, HoldsEveryPixel)
{
    std::mt19937 random(1);
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {1294, 880}}) {
        std::vector<std::uint8_t> rgb(static_cast<std::size_t>(3 * width * height));
        for (std::uint8_t& value : rgb) value = static_cast<std::uint8_t>(random());
        const Sheet sheet = decoded(draw::encode_png(rgb, width, height));
        EXPECT_EQ(sheet.width, width);
        EXPECT_EQ(sheet.rgb, rgb);
    }
    EXPECT_THROW(draw::encode_png(std::vector<std::uint8_t>(3), 0, 1), std::runtime_error);
}

TEST(Raster, SpacingOfAGridIsItsCell)
{
    for (const double angle : {0.0, 0.3, std::numbers::pi / 4})
        EXPECT_NEAR(draw::point_spacing(grid([](const Eigen::Vector2d&) { return 0; }, angle).xyz), 2, 1e-12);
    EXPECT_EQ(draw::point_spacing(Eigen::Matrix3Xd::Constant(3, 3, 7)), 0);
    Eigen::Matrix3Xd line = Eigen::Matrix3Xd::Zero(3, 5);
    line.row(0) << 0, 3, 6, 9, kNaN; // each has a neighbour 3 away and one 6 away; nothing is farther than two shares
    EXPECT_GE(draw::point_spacing(line), 3);
    EXPECT_LE(draw::point_spacing(line), 6);
}

// A boundary that nobody measured lies on the part; beside the part, where nothing is known, at height 0.
TEST(Outline, LiesOnThePart)
{
    job::Job job;
    job.anomaly.resize(3, 4);
    job.anomaly << 10, 20, 20, 10, 10, 10, 20, 20, kNaN, kNaN, kNaN, kNaN;
    mesh::Mesh part;
    part.vertices.resize(3, 4);
    part.vertices << 0, 40, 40, 0, 0, 0, 40, 40, 1, 1, 1, 1;
    part.triangles.resize(3, 2);
    part.triangles << 0, 0, 1, 2, 2, 3;
    const std::vector<draw::Outline> on = draw::outlines_on(part, job);
    ASSERT_EQ(on.size(), 1);
    EXPECT_LT((on[0].line.row(2).array() - 1).abs().maxCoeff(), 1e-9);
    job.anomaly.topRows<2>().array() += 500;
    EXPECT_TRUE((draw::outlines_on(part, job)[0].line.row(2).array() == 0).all());
}

} // namespace picture_test
} // namespace fettle
