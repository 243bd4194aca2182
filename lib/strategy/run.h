#pragma once

#include "core/progress.h"
#include "gantry/gantry.h"
#include "plan/plan.h"
#include "removal/height_field.h"
#include "strategy/force_record.h"
#include "strategy/layer_switching.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fettle::strategy {

class TraceFile;

/// One row of a trace: what the machine did, and why. mm, N, s, frame M.
struct TraceRow {
    double time = 0;
    /// Lowest line of the wheel at mid-width, including the spring's deflection.
    Eigen::Vector3d tool = Eigen::Vector3d::Zero();
    int layer = 1;
    int pass = 1;
    Event event = Event::none;
    double force = 0;
    double feed = 0;       ///< 0: not grinding
    double peak_force = 0; ///< during the move
    double deflection = 0; ///< of the spring, at the end of the move
    double radius = 0;     ///< last measured wheel radius; 0: not measured yet
};

/// How layer 1 is ground: at the job's feed, covering after covering until all is within tolerance; or pass after pass
/// until each is, the last stroke by feed-rate control (feed_control.h), or every stroke but the first by force control
/// (force_control.h).
enum class Layer1 { constant, feed, force };

/// What former runs taught of the removal, beside the job's coefficient.
struct KnownRemoval {
    double coefficient_sigma = 0; ///< standard deviation of the job's coefficient, relative
    /// Stock and wheel that were ground off between measurements of the wheel, mm³; 0: none were made.
    double removed_volume = 0, lost_volume = 0;
    double wear_sigma = 0; ///< standard deviation of their ratio, relative
};

struct RunOptions {
    Layer1 layer_1 = Layer1::constant;
    std::optional<KnownRemoval> known_removal;
    /// Grinding time between two measurements of the wheel at P0, s. It is measured at the start of each covering, too.
    double touch_off_period = 120;
    /// Trace of an interrupted run (trace_file.h). It is replayed without the machine; then the wheel is measured, the
    /// machine goes back to where it was, and the run continues.
    std::vector<TraceRow> previous_trace;
    std::string previous_source;  ///< name of that trace, for messages
    TraceFile* journal = nullptr; ///< write-ahead copy of the trace; nullptr: none
    /// The stock as far as it is known, at the end of `previous_trace`: a head that reports no contact with it ends the
    /// run (contact_watch.h). nullptr for a simulated machine, whose head always reports contact.
    const removal::HeightField* known_stock = nullptr;
    std::function<void(const TraceRow&)> watch; ///< called after each action with its row; may be empty
};

/// Result of a run.
struct GrindRun {
    bool finished = false;
    bool stopped = false; ///< by the operator (gantry::Interrupted): the wheel is at the safe height
    bool faulted = false; ///< the machine has stopped, by the fault that `failure` says
    std::string failure;  ///< the limit that was reached, and the state; or the machine's fault
    StrategyCounts counts;
    ForceRecord force;
    double wheel_radius = 0; ///< last measured, mm
    int touch_offs = 0;
    int wheel_changes = 0;
    std::vector<TraceRow> trace;
};

/// Grinds: lets the strategy decide, compensates the wheel, moves the gantry, measures, until the strategy is done or
/// the machine has stopped.
/// @throws InputError if the surface is not defined under a pass, a new wheel is smaller than the smallest radius, or
/// the trace to be continued belongs to another run
GrindRun run(const plan::Plan& plan, gantry::Gantry& gantry, const RunOptions& options = {},
             const core::Progress& progress = {});

} // namespace fettle::strategy
