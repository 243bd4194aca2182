#pragma once

#include "compare/sheet.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle {

/// One line of a chart.
struct Curve {
    std::string name;        ///< in the key; empty: not in the key
    Eigen::Matrix2Xd points; ///< x and y, joined in order; where y is NaN (or has no logarithm) the line is broken
    Rgb colour = Sheet::kInk;
    bool marked = true; ///< a small square at each point
};

struct Chart {
    std::string title, x_label, y_label;
    std::vector<Curve> curves;
    bool logarithmic = false; ///< y by its logarithm
};

/// Colours for curves that stand side by side, told apart by every eye.
Rgb curve_colour(std::size_t index);

/// Draws axes with ticks, the curves and their key. Without a point that can be shown, only the frame.
/// @param corner, size  of the whole chart on the sheet, pixels
void draw_chart(Sheet& sheet, const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const Chart& chart);

} // namespace fettle
