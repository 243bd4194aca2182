#pragma once

#include "job/boundary.h"
#include "plan/wheel_section.h"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace fettle::plan {

/// Heights of a surface at points of the pass frame, 2xN (across, along), mm; NaN where it is not defined.
using HeightsInPassFrame = std::function<Eigen::VectorXd(const Eigen::Matrix2Xd& across_along)>;

/// One pass of the staircase. The wheel grinds on the intervals and travels above the surface between them.
struct Pass {
    double line = 0;                      ///< position of the middle of the wheel's width across the passes, mm
    std::vector<job::Interval> intervals; ///< contact intervals along the pass, ascending, disjoint, mm
};

struct StaircaseOptions {
    double step_over = 0; ///< largest distance of adjacent passes, mm
    /// Largest scallop height between the passes, mm. The wheel's axis is horizontal: on a surface that slopes across
    /// the passes it leaves steps of slope · spacing, so the passes are closer there.
    double max_scallop = 0;
};

inline constexpr int kMaxPasses = 20000;

/// Zig-zag passes that cover a region of the pass frame: at every point of the region the wheel comes within the
/// scallop height of the surface, and each pass covers a part of the region. Passes ascend; the first one begins at the
/// smallest coordinates (Wang 2007, eq. 5-4, 5-5).
/// @throws InputError if the surface is so steep across the passes that more than kMaxPasses are needed
std::vector<Pass> staircase(const job::Polygon& region, const HeightsInPassFrame& heights,
                            const WheelSections& sections, const StaircaseOptions& options);

/// Projects the part of a polygon whose coordinate `axis` (0, 1) is in [min, max] on the other axis.
std::vector<job::Interval> strip_projection(const job::Polygon& polygon, int axis, double min, double max);

} // namespace fettle::plan
