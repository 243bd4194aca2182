#pragma once

#include "job/job.h"

#include <Eigen/Core>

namespace fettle {

/// Section of the wheel by a vertical plane through its lowest line: a straight edge as long as the wheel is wide
/// (along X_w), or a circle (along Y_w). The wheel is the sum of the two: over its lowest point it stands at
/// rise(dx) + rise(dy).
struct WheelSection {
    bool round = false;
    double radius = 0; ///< of the circle, mm
    double reach = 0;  ///< half the length that can touch, mm

    /// Height over the lowest point at distance d; |d| ≤ reach.
    double rise(double d) const;
};

/// The two sections for passes along `axis`, 'x' or 'y' of W.
struct WheelSections {
    WheelSection across; ///< the passes
    WheelSection along;
};
WheelSections wheel_sections(double radius, double width, char axis);

/// Axes of the passes in the machine frame: columns (across, along), unit vectors. Across, along are X_w, Y_w when the
/// passes run along y, and Y_w, X_w otherwise.
Eigen::Matrix2d pass_axes(const Job& job);

} // namespace fettle
