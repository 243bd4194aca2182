#pragma once

#include "gantry/gantry.h"
#include "station/record.h"
#include "strategy/manual.h"
#include "strategy/run.h"
#include "strategy/steering.h"

#include <string>

namespace fettle::station {

/// What the machine is to do next.
enum class Command {
    none,
    move,       ///< across, as the stick points
    record,     ///< touch the part where the machine is
    turn_left,  ///< the head by a degree, counter-clockwise
    turn_right, ///< clockwise
    touch,      ///< touch the surface around the anomaly, fit it, and plan
    grind,      ///< by itself, or go on with it
    steer,      ///< let the operator steer the wheel
    end,
};

/// The state machine of an operator's session (Wang 2007, 3 and 6.1.1): what he does comes in, commands for the machine
/// come out, and their results are fed back in. It knows neither machine nor terminal.
///
///   anomaly ⇄ sampling ⇄ touch → review → grind → done
///                                    ↘        ⇅      ⇅
///                                      manual ⇄ stopped
class Session {
  public:
    /// Begins, or goes on from a record. A program that ended while the machine was at work goes on as stopped.
    explicit Session(Record record);

    Command input(const strategy::Stick& stick);

    // What came of a command.
    void add_point(const Eigen::Vector3d& point); ///< of record: lowest point of the tip
    void turn(double theta);                      ///< the head is at θ, rad
    void add_touch(const Eigen::Vector3d& touch); ///< of touch: one of many
    void planned();                               ///< of touch: all of them, and a plan
    void begin(Stage work);                       ///< of grind and steer: Stage::grind, Stage::manual
    void ground(const strategy::GrindRun& run);   ///< of grind
    void steered(const strategy::ManualRun& run); ///< of steer
    void add_stop(const Stop& stop) { record_.stops.push_back(stop); }
    /// A command failed, and why; the session is where it was.
    void refuse(const std::string& problem) { message_ = problem; }

    const Record& record() const { return record_; }
    /// The last thing to be said to the operator.
    const std::string& message() const { return message_; }

  private:
    Command teach(const strategy::Stick& stick);
    Command choose(strategy::Button button);
    Command start();
    void take_back();
    void complete_boundary();
    void complete_job();
    std::vector<Eigen::Vector3d>& points()
    {
        return record_.stage == Stage::anomaly ? record_.anomaly : record_.sampling;
    }

    Record record_;
    std::string message_;
};

} // namespace fettle::station
