#pragma once

#include "core/error.h"
#include "sampling/touch_plan.h"

#include <optional>

namespace fettle::sampling {

/// Maximum number of probed lines in each direction. Wang 2007, 4.4.3.1, asks for fewer than 60 touches; a hundred
/// lines indicate an input error or an extremely narrow anomaly.
inline constexpr int kMaxProbingLines = 100;

/// Number of lines across each side of the anomaly's bounding rectangle in W, Wang 2007, eq. 4-5.
struct LineCount {
    int across_a = 0; ///< n_a, lines perpendicular to the side a, which lies along X_w
    int across_b = 0; ///< n_b, lines perpendicular to the side b, which lies along Y_w
};

/// Number of lines after eq. 4-5. @param a, b  sides of the rectangle, mm
LineCount line_count(double a, double b);

/// The layout needs room on both sides of the anomaly, and the sampling area is open on one, as at a part's edge.
/// Touches that are chosen one after the other (margin/adaptive.h) go where there is room.
class NoRoomError : public core::InputError {
  public:
    using core::InputError::InputError;
};

/// Touch plan of a free-form surface (Wang 2007, 4.4.4, 3): n_a lines along Y_w, then n_b along X_w, at the points that
/// divide each side of the anomaly's bounding rectangle into n + 1 equal parts. Each line has four touches, at its
/// crossings with S and B on either side of the anomaly. Boundary points and crossings are on sound metal.
/// @param lines  replaces eq. 4-5 (Wang's Table 4-5 has rows with one line each way)
/// @throws NoRoomError if a line has no room on one side of the anomaly
/// @throws InputError for more than kMaxProbingLines
TouchPlan plan_freeform(const job::Job& job, const std::optional<LineCount>& lines = {});

} // namespace fettle::sampling
