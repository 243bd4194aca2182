#pragma once

#include "job/job.h"

#include <Eigen/Core>

namespace fettle::plan {

/// Section of the wheel by a vertical plane: a straight edge as long as the wheel is wide (along X_w), or a circle
/// (along Y_w). The height of the wheel's surface above its lowest point is rise(dx) + rise(dy).
struct WheelSection {
    bool round = false;
    double radius = 0; ///< of the circle, mm
    double reach = 0;  ///< half the length that can touch the surface, mm

    /// Height above the lowest point at the distance d, mm; |d| ≤ reach.
    double rise(double d) const;
};

/// The sections of the wheel across and along the passes, which run along `axis`, 'x' or 'y' of W.
struct WheelSections {
    WheelSection across, along;
};
WheelSections wheel_sections(double radius, double width, char axis);

/// Axes of the pass frame in the frame M: columns (across, along), unit vectors. They are (X_w, Y_w) if the passes run
/// along y, and (Y_w, X_w) otherwise.
Eigen::Matrix2d pass_axes(const job::Job& job);

} // namespace fettle::plan
