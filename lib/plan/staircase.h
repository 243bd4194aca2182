#pragma once

#include "job/boundary.h"
#include "plan/wheel_section.h"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace fettle {

/// Heights of a surface over points of the pass frame, 2xN (across, along), mm; NaN where it is not defined.
using HeightsAcross = std::function<Eigen::VectorXd(const Eigen::Matrix2Xd& across_along)>;

/// One pass of the staircase: the middle of the wheel's width runs on the line `line` (across); the wheel touches the
/// surface over `intervals` (along; ascending, disjoint). Between two intervals it travels.
struct Pass {
    double line = 0;
    std::vector<Interval> intervals;
};

struct StaircaseOptions {
    double step_over = 0; ///< the most, mm
    /// What may stay standing between the passes, mm. The wheel's axis is level: on a surface that slopes across the
    /// passes it leaves steps of slope · spacing, so the passes stand closer there.
    double leftover = 0;
};

inline constexpr int kMostPasses = 20000;

/// Zig-zag lines that cover a region of the pass frame: after all passes, wheel `sections.across` has come within
/// `leftover` of the surface at every point of the region, and its footprint meets the region everywhere. Passes
/// ascend; the first begins at the smallest coordinates (Wang 2007, eq. 5-4, 5-5).
/// @throws InputError if the surface is so steep across the passes that more than kMostPasses are needed
std::vector<Pass> staircase(const Polygon& region, const HeightsAcross& heights, const WheelSections& sections,
                            const StaircaseOptions& options);

/// Projection of that part of a polygon whose coordinate `axis` (0, 1) lies in [least, most] on the other axis.
std::vector<Interval> strip_projection(const Polygon& polygon, int axis, double least, double most);

} // namespace fettle
