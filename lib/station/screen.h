#pragma once

#include "plan/plan.h"
#include "station/session.h"

#include <string>
#include <vector>

namespace fettle::station {

/// What the operator sees beside the record: the machine as it is.
struct Live {
    gantry::GantryStatus machine;
    bool has_machine = false;
    int layer = 0, pass = 0; ///< while it grinds by itself; 0: not
    double time_left = 0;    ///< of the covering under way, s
};

inline constexpr std::size_t kScreenColumns = 79, kScreenRows = 23; ///< they fit a terminal of 80 × 24

/// The screen: where the session stands, a sketch, numbers, and the keys that mean something now.
/// @param plan  nullptr: not planned yet
std::vector<std::string> draw_screen(const Session& session, const plan::Plan* plan, const Live& live);

/// The lines about fit and margin: method, touches, rms, goodness, error band and shift.
std::vector<std::string> describe_fit(const plan::Plan& plan);

} // namespace fettle::station
