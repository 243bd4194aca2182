#pragma once

#include "sampling/touch_plan.h"

#include <optional>

namespace fettle {

/// Lines each way that are probed at most. Wang 2007, 4.4.3.1, wants fewer than 60 touches; a hundred lines are a slip,
/// or a needle of an anomaly.
inline constexpr int kMostLines = 100;

/// Number of lines across each side of the anomaly's bounding rectangle, Wang 2007, eq. 4-5.
struct LineCount {
    int across_a = 0; ///< n_a, lines perpendicular to the side a, which lies along X_w
    int across_b = 0; ///< n_b, lines perpendicular to the side b, which lies along Y_w
};

/// @param a, b  sides of the rectangle, mm
LineCount line_count(double a, double b);

/// Free-form surface (Wang 2007, 4.4.4, 3): n_a lines along Y_w, then n_b along X_w, at the points that cut each side
/// of the anomaly's bounding rectangle into n + 1 equal parts; four touches on each, exactly where it crosses S and B
/// on either side of the anomaly. The boundary points lie on good metal, and so do the crossings.
/// @param lines  instead of eq. 4-5 (Wang's Table 4-5 has rows with one line each way)
/// @throws InputError if a line has no room on one side of the anomaly, or for more than kMostLines
TouchPlan plan_freeform(const Job& job, const std::optional<LineCount>& lines = {});

} // namespace fettle
