#pragma once

#include "cloud/pcd.h"
#include "station/planning.h"
#include "station/record.h"
#include "station/workplace.h"
#include "strategy/steering.h"
#include "json/document.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fettle::station {

struct StationOptions {
    WorkplaceOptions workplace;
    PlanningOptions planning;
    std::string folder;  ///< of the session
    bool resume = false; ///< go on with the session in the folder, if there is one
    strategy::Layer1 layer_1 = strategy::Layer1::constant;
    cloud::PcdEncoding encoding = cloud::PcdEncoding::binary; ///< of the PCDs
    std::optional<double> force;                              ///< in manual mode, N; nothing: F_down
    std::optional<double> lowest; ///< lower bound of probe and drives, mm; nothing: that of the machine
    double pace = 0;              ///< machine time over real time of a simulated machine; 0: it does not wait
    /// Shows the lines of the screen; empty: nobody looks.
    std::function<void(const std::vector<std::string>& lines)> show;
    /// True if the program has to end: the machine is stopped first. May be empty.
    std::function<bool()> is_terminated;
};

struct StationResult {
    bool is_complete = false; ///< all is within tolerance, or the operator has ended manual grinding
    std::string failure;      ///< of the machine, the last one; empty: none
    std::vector<std::string> warnings;
    json::Value report;
};

/// Leads an operator through a session on a machine, until he ends it: the state machine of Session, executed.
///
/// The machine can be stopped at any moment: the wheel is lifted off the part at once, and then to the safe height. All
/// that was reached is in the folder before the machine moves on.
/// @param settings  the job without what is taught; its boundaries hold where none are shown
/// @throws InputError for a folder that holds another session, or a machine that cannot be opened
StationResult run_station(const job::Job& settings, strategy::Steering& steering, const StationOptions& options);

} // namespace fettle::station
