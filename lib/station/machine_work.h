#pragma once

#include "station/folder.h"
#include "station/forecast.h"
#include "station/screen.h"
#include "station/session.h"
#include "station/station.h"
#include "strategy/run_identity.h"
#include "strategy/teach.h"

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fettle::station {

/// Executes the commands of a session on its machine, shows the screen meanwhile, and lets the operator stop it.
class MachineWork {
  public:
    MachineWork(const StationOptions& options, const Folder& folder, Session& session, Workplace& place,
                strategy::SteeringClock& clock);
    MachineWork(const MachineWork&) = delete;
    MachineWork& operator=(const MachineWork&) = delete;

    using Save = std::function<void()>;

    /// Opens the machine, and the plan of a session that has one. @throws InputError
    void prepare();
    // The commands. All: @throws GantryFault, Interrupted, InputError
    void move(const Eigen::Vector2d& direction);
    Eigen::Vector3d touch_here();
    void turn_to(double theta);
    void touch_and_plan(const Save& save);
    void grind(const Save& save);
    void steer(const Save& save);

    /// After Interrupted: lifts the wheel, or the probe.
    void retract();
    /// After GantryFault: the machine is connected anew by the next command.
    void give_up(const std::string& failure);
    /// At the end of the session: lets the machine go, which lifts it.
    void leave();

    bool is_terminated() const { return options_.is_terminated && options_.is_terminated(); }
    /// Shows the screen, ten times a second at most. @param now  at once
    void show(bool now);
    const plan::Plan* plan() const { return plan_ ? &*plan_ : nullptr; }
    const std::string& failure() const { return failure_; }
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    using Clock = std::chrono::steady_clock;
    using Traces = std::vector<std::vector<strategy::TraceRow>>;

    gantry::Gantry& gantry() { return *place_.machine().gantry; }
    strategy::Teacher& teacher();
    /// Lets the operator stop what follows. @param follows  the steering time goes on with the machine's
    void arm(bool follows);
    bool is_stopped(const gantry::GantryStatus& now);
    void keep_pace(double machine_time);
    void add_stop(const std::vector<strategy::TraceRow>& trace, double asked);
    strategy::GrindRun run_plan(const Save& save, std::vector<strategy::TraceRow> previous,
                                const strategy::RunIdentity& identity);
    std::string manual_file(int run) const;
    std::vector<strategy::TraceRow> read_trace(const std::string& name);
    Traces traces();
    void save_trace(const std::string& name, const std::vector<strategy::TraceRow>& trace,
                    const strategy::RunIdentity& identity) const;
    void save_ground();
    void add_warnings(const std::vector<std::string>& more);

    const StationOptions& options_;
    const Folder& folder_;
    Session& session_;
    Workplace& place_;
    strategy::SteeringClock& clock_;
    std::optional<plan::Plan> plan_;
    std::optional<strategy::Teacher> teacher_;
    Live live_;
    bool follows_ = false;
    double steering_begin_ = 0, machine_begin_ = 0; ///< when the work began, s
    double paced_time_ = 0;                         ///< machine time that has been waited for, s
    Clock::time_point paced_until_;                 ///< end of that in real time
    double asked_ = 0;                              ///< machine time of the last interruption, s
    Clock::time_point next_show_;
    std::string failure_;
    std::vector<std::string> warnings_;
};

} // namespace fettle::station
