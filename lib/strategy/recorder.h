#pragma once

#include "gantry/gantry.h"
#include "strategy/trace.h"
#include "strategy/trace_file.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle {

/// Stands between a strategy and its machine: writes into the journal what the machine is to do, has it done, and
/// records what came of it. What was done before (`done`) is gone over first: the machine stands still, and the
/// strategy is told what was measured then, so it comes to the very state in which it was cut off.
///
/// A trace holds floats, in the units of the job. The strategy is told no more than the trace holds, or it might decide
/// differently the second time.
class Recorder {
  public:
    /// Of which layer and pass a row is, and why.
    struct Mark {
        int layer = 1;
        int pass = 1;
        Event event = Event::none;
    };

    /// @param journal  nullptr: none
    /// @param source   name of the trace that `done` is from, for messages
    Recorder(Gantry& gantry, const Units& units, std::vector<TraceRow> done, const std::string& source,
             TraceFile* journal);

    /// All of what was done has been gone over, and the machine has not moved yet.
    bool resumes() const { return !live_ && next_ == done_.size(); }
    /// So it has been here before: the trace goes on with what was done then, the wheel was measured.
    bool resumed() const { return next_ < done_.size() && done_[next_].event == Event::touch_off; }
    /// From here on the machine moves.
    void go_live();

    /// As the gantry's own. @throws InputError if the trace says something else; GantryFault
    const GantryStatus& travel(const Mark& mark, const Eigen::Vector3d& tool_point);
    const GantryStatus& grind(const Mark& mark, const Eigen::Vector3d& tool_point, double feed);
    const GantryStatus& press(const Mark& mark, const Eigen::Vector3d& tool_point, double feed, double force);
    const GantryStatus& lift(const Mark& mark, double commanded_z);
    double touch_off(const Mark& mark);
    void change_wheel(const Mark& mark);
    /// A row for a decision; nothing moves.
    void decide(const Mark& mark);

    const GantryStatus& status() const { return status_; } ///< as it was told last
    const std::vector<TraceRow>& trace() const { return trace_; }

  private:
    template <class Work>
    const GantryStatus& act(const Mark& mark, const Eigen::Vector3d& target, double feed, const Work& work);
    void go_over(const Mark& mark, double feed);
    void tell(const GantryStatus& status);
    void record(TraceRow row);

    Gantry& gantry_;
    Units units_;
    std::vector<TraceRow> done_;
    std::string source_;
    TraceFile* journal_;
    std::size_t next_ = 0; ///< of what was done, to be gone over
    bool live_ = false;
    double later_ = 0; ///< the time of the trace over the machine's, s
    double radius_ = 0;
    GantryStatus status_;
    std::vector<TraceRow> trace_;
};

} // namespace fettle
