#pragma once

#include "job/job.h"
#include "json/document.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::station {

/// How far a session is. Its words are those of kStageWords, in this order.
enum class Stage {
    anomaly,  ///< points around the anomaly are shown
    sampling, ///< points around what may be touched
    touch,    ///< the boundaries are complete: the touches come next
    review,   ///< surface, margin and plan are known: the operator chooses the mode
    grind,    ///< the machine grinds by itself
    manual,   ///< the operator steers the wheel
    stopped,  ///< by the operator, or by the end of a program: go on, change the mode, or end
    done,     ///< all is within tolerance
};
inline const std::vector<std::string> kStageWords = {"anomaly", "sampling", "touch",   "review",
                                                     "grind",   "manual",   "stopped", "done"};

/// Who leads the wheel (Wang 2007, 3). Its words are those of kModeWords, in this order.
enum class Mode { automatic, manual };
inline const std::vector<std::string> kModeWords = {"automatic", "manual"};

/// A stop by the operator, times of the machine in the trace, s.
struct Stop {
    double asked = 0;  ///< last reading before the machine got the command
    double free = 0;   ///< the wheel was off the part
    double lifted = 0; ///< it was at the safe height
};

/// All that a session has to know to go on after its program has ended, but for what is in the files of the tools:
/// plan.json and trace.pcd in the session's folder (docs/formats.md). Lengths in mm, M.
struct Record {
    job::Job settings; ///< as the session began: what is not taught
    job::Job job;      ///< with θ and boundaries as taught
    Stage stage = Stage::anomaly;
    Mode mode = Mode::automatic;
    std::vector<Eigen::Vector3d> anomaly,
        sampling;                         ///< touched so far: lowest points of the tip; z is NaN without metal
    std::vector<Eigen::Vector3d> touches; ///< likewise, of the surface around the anomaly
    int manual_runs = 0;                  ///< begun; their traces are manual-1.pcd, …
    double peak_force = 0;                ///< of all grinding, N
    std::vector<Stop> stops;
};

json::Value to_json(const Record& record);
/// @throws InputError with the key's path
Record parse_record(json::Reader reader);

/// A new session: it begins where the points around the anomaly are shown.
Record begin_record(const job::Job& settings);

} // namespace fettle::station
