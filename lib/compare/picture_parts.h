#pragma once

#include "compare/canvas.h"
#include "compare/raster.h"
#include "job/job.h"

#include <string>

/// The parts of picture(): what stands around the map.
namespace fettle {

/// What the numbers are about: those that count for colours, histogram and statistics, in the units of the picture.
struct Values {
    std::string name, unit;
    Eigen::VectorXd numbers; ///< NaN: undefined
};

/// Colours of values: the diverging ones of ColourScale, or a sequential map.
struct Scale {
    double low = 0, high = 1;
    bool diverging = false;
    int bands = 0;

    Rgb operator()(double value) const; ///< NaN: kUndefinedColour
};

/// Where the map lies on the sheet.
struct Layout {
    View view;
    Eigen::Vector2d map_corner; ///< of the frame, pixels
    Eigen::Vector2d map_size;
    Eigen::Vector2d drawn_at; ///< of the view inside the frame
    double reach = 0;         ///< of a point, mm
};

/// Heights of capital letters, pixels.
inline constexpr double kTitle = 15, kLabel = 10.5, kSmall = 9.5;

/// Frame, ticks and a bar of round length.
void draw_axes(Canvas& sheet, const Layout& layout, const Units& units);
/// B and S of a job.
void draw_outlines(Canvas& sheet, const Layout& layout, const Job& job);
/// Bar of colours with ticks, and beside it how often each value occurs.
void draw_legend(Canvas& sheet, const Layout& layout, const Values& values, const Scale& scale);
/// One line of statistics. @param place  the region they hold for; empty: all
void draw_numbers(Canvas& sheet, const Layout& layout, const Values& values, const std::string& place);

} // namespace fettle
