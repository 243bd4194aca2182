#pragma once

#include "draw/field_scale.h"
#include "draw/outline.h"
#include "draw/raster.h"
#include "draw/sheet.h"
#include "job/job.h"

#include <string>

/// Parts of picture() around the map.
namespace fettle::draw {

/// Values that determine colours, histogram and statistics, in the units of the picture.
struct PictureValues {
    std::string name, unit;
    Eigen::VectorXd numbers;             ///< NaN: undefined
    std::string counted = "points";      ///< what has these numbers: the points of a cloud, pixels that show a mesh
    double min_shown = 0, max_shown = 0; ///< of the whole map, outside B, too
};

/// Position of the map on the sheet.
struct Layout {
    Eigen::Matrix3d rotation_view_machine;
    View view;
    Eigen::Vector2d map_corner; ///< upper left corner of the frame, pixels
    Eigen::Vector2d map_size;
    Eigen::Vector2d view_corner; ///< upper left corner of the view inside the frame
};

/// Heights of capital letters, pixels.
inline constexpr double kTitleCapitals = 15, kLabelCapitals = 10.5, kSmallCapitals = 9.5;
inline constexpr Rgb kTextGrey = {120, 120, 120}, kFrameGrey = {170, 170, 170};

/// Text with three significant digits, or with as many more as show a difference of `resolution`.
std::string number_text(double value, double resolution = 0);
/// Corners of a box, 2x4, for a closed line.
Eigen::Matrix2Xd rectangle_corners(const Eigen::Vector2d& corner, const Eigen::Vector2d& size);

/// Draws the frame, a scale bar, and ticks along each side that is parallel to a machine axis; in an oblique view, a
/// tripod of the axes.
void draw_axes(Sheet& sheet, const Layout& layout, const units::Units& units);
/// Draws outlines where the part does not hide them; from above, completely.
void draw_outlines(Sheet& sheet, const Layout& layout, const Raster& part, const std::vector<Outline>& outlines);
/// Draws the colour bar with ticks and the histogram; the ends of the bar are pointed where values lie beyond.
void draw_legend(Sheet& sheet, const Layout& layout, const PictureValues& values, const PictureScale& scale);
/// Draws a line of statistics. @param region  to which they apply; empty: all
void draw_numbers(Sheet& sheet, const Layout& layout, const PictureValues& values, const std::string& region);

} // namespace fettle::draw
