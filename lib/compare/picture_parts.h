#pragma once

#include "compare/raster.h"
#include "compare/sheet.h"
#include "job/job.h"

#include <string>

/// The parts of picture(): what stands around the map.
namespace fettle {

/// What the numbers are about: those that count for colours, histogram and statistics, in the units of the picture.
struct Values {
    std::string name, unit;
    Eigen::VectorXd numbers;                ///< NaN: undefined
    double least_shown = 0, most_shown = 0; ///< of the whole map, also where it does not count
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
    Eigen::Matrix3d rotation_view_machine;
    View view;
    Eigen::Vector2d map_corner; ///< of the frame, pixels
    Eigen::Vector2d map_size;
    Eigen::Vector2d drawn_at; ///< of the view inside the frame
};

/// Heights of capital letters, pixels.
inline constexpr double kTitle = 15, kLabel = 10.5, kSmall = 9.5;
inline constexpr Rgb kGrey = {120, 120, 120}, kFrame = {170, 170, 170};

/// Three digits that matter.
std::string number_text(double value);
/// The corners of a box, for a line around it.
Eigen::Matrix2Xd frame_of(const Eigen::Vector2d& corner, const Eigen::Vector2d& size);

/// Frame, a bar of round length, and ticks along each side that is an axis of the machine; else a tripod of the axes.
void draw_axes(Sheet& sheet, const Layout& layout, const Units& units);
/// Corners of B or S, 3xN, M; one whose z is left out has the mean height of the others, 0 if none has one.
Eigen::Matrix3Xd outline(const Eigen::Matrix3Xd& polygon);
/// B and S of a job, where nothing of the part hides them; from above all of them.
void draw_outlines(Sheet& sheet, const Layout& layout, const Raster& part, const Job& job);
/// Bar of colours with ticks, its ends pointed where values lie beyond; beside it how often each value occurs.
void draw_legend(Sheet& sheet, const Layout& layout, const Values& values, const Scale& scale);
/// One line of statistics. @param place  the region they hold for; empty: all
void draw_numbers(Sheet& sheet, const Layout& layout, const Values& values, const std::string& place);

} // namespace fettle
