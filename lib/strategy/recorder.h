#pragma once

#include "gantry/gantry.h"
#include "strategy/trace.h"
#include "strategy/trace_file.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::strategy {

/// The layer between a strategy and its machine: announces each action in the journal, executes it, and records the
/// result. The trace of an interrupted run (`history`) is replayed first: the machine stands still, and the strategy
/// gets the recorded measurements, so it reaches the very state in which it was interrupted.
///
/// A trace holds floats, in the units of the job. The strategy gets its measurements rounded to what the trace holds,
/// or it might decide differently in a replay.
class Recorder {
  public:
    /// Layer and pass of a row, and the event that caused it.
    struct Mark {
        int layer = 1;
        int pass = 1;
        Event event = Event::none;
    };

    /// @param history  rows to be replayed
    /// @param source   name of the history's trace, for messages
    /// @param journal  nullptr: none
    Recorder(gantry::Gantry& gantry, const units::Units& units, std::vector<TraceRow> history,
             const std::string& source, TraceFile* journal);

    /// False during the replay: the machine stands still.
    bool is_live() const { return live_; }
    /// True between the end of the replay and the machine's first move.
    bool replay_ended() const { return !live_ && next_ == history_.size(); }
    /// True if the history goes on with a measurement of the wheel: the run was resumed here before.
    bool was_resumed_here() const { return next_ < history_.size() && history_[next_].event == Event::touch_off; }
    /// Ends the replay: from here on the machine moves.
    void go_live();

    /// The gantry's actions: taken from the history during the replay, done by the machine afterwards.
    /// @throws InputError if the history has another action here; GantryFault, also if the journal cannot be written:
    /// what the machine does has to be known
    const gantry::GantryStatus& travel(const Mark& mark, const Eigen::Vector3d& tool_point);
    const gantry::GantryStatus& travel_low(const Mark& mark, const Eigen::Vector3d& tool_point, double over,
                                           double free);
    const gantry::GantryStatus& grind(const Mark& mark, const Eigen::Vector3d& tool_point, double feed);
    const gantry::GantryStatus& press(const Mark& mark, const Eigen::Vector3d& tool_point, double feed, double force);
    const gantry::GantryStatus& lift(const Mark& mark, double commanded_z);
    double touch_off(const Mark& mark);
    /// After an interruption: lifts the wheel off the part, then to the safe height; a row for each.
    void retract(const Mark& mark, double safe_height);
    void change_wheel(const Mark& mark);
    /// Records a decision that moves nothing.
    void record_decision(const Mark& mark);
    /// Records that the machine has stopped for good: in the trace, and in the journal if that can be written.
    void record_fault(const Mark& mark);

    double max_feed() const { return gantry_.max_feed(); } ///< of the machine, mm/s

    const gantry::GantryStatus& status() const { return status_; } ///< the last one, as the trace holds it
    const std::vector<TraceRow>& trace() const { return trace_; }

  private:
    template <class Work>
    const gantry::GantryStatus& act(const Mark& mark, const Eigen::Vector3d& target, double feed, const Work& work);
    void replay(const Mark& mark, double feed);
    void set_status(const gantry::GantryStatus& status);
    void record(const Mark& mark, double feed);
    template <class Write>
    void write_journal(const Write& write);

    gantry::Gantry& gantry_;
    units::Units units_;
    std::vector<TraceRow> history_;
    std::string source_;
    TraceFile* journal_;
    std::size_t next_ = 0; ///< row of the history
    bool live_ = false;
    double time_offset_ = 0; ///< trace time minus machine time, s
    double radius_ = 0;
    gantry::GantryStatus status_;
    std::vector<TraceRow> trace_;
};

} // namespace fettle::strategy
