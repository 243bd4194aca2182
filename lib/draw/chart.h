#pragma once

#include "draw/sheet.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::draw {

/// A curve of a chart.
struct Curve {
    std::string name;        ///< in the legend; empty: not listed
    Eigen::Matrix2Xd points; ///< x and y, joined in order; broken where y is NaN (or has no logarithm)
    Rgb colour = Sheet::kInk;
    bool with_markers = true; ///< a small square at each point
};

struct Chart {
    std::string title, x_label, y_label;
    std::vector<Curve> curves;
    bool logarithmic = false; ///< y axis
};

/// Colours for curves of one chart, distinguishable with colour blindness, too; they repeat after six.
Rgb curve_colour(std::size_t index);

/// Draws axes with ticks, the curves and their legend; only the frame if no point can be shown.
/// @param corner, size  of the whole chart on the sheet, pixels
void draw_chart(Sheet& sheet, const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Chart& chart);

} // namespace fettle::draw
