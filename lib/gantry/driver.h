#pragma once

#include "core/descriptor.h"
#include "gantry/child.h"
#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"

#include <string>

namespace fettle {

/// A machine behind a driver: a program that speaks the protocol of docs/driver.md on its stdin and stdout.
///
/// A driver is not trusted. Its answers carry the number of what they answer, must come in time, hold finite numbers,
/// go forward in time, be no farther from the last one than the machine is fast, and end where the move should. At the
/// first that does not, the machine is told to stop, the driver is ended, and GantryFault names the driver and the
/// fault.
class DriverGantry final : public Gantry {
  public:
    /// Connects, tells the head's F_max, and homes: the head turns to θ.
    /// @param patience  how long an answer may take beyond the time of the move, s
    /// @throws InputError if the driver cannot be started, GantryFault if it is at fault
    DriverGantry(const std::string& command, const Job& job, double patience);
    /// The same with a driver that runs already. @param name  for messages   @param socket  where it is spoken to
    DriverGantry(const std::string& name, Descriptor socket, const Job& job, double patience);
    ~DriverGantry() override;
    DriverGantry(const DriverGantry&) = delete;
    DriverGantry& operator=(const DriverGantry&) = delete;

    GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    GantryStatus press(const Eigen::Vector3d& tool_point, double feed, double force) override;
    GantryStatus lift(double commanded_z) override;
    double touch_off() override;
    void change_wheel() override;
    double probe(const Eigen::Vector2d& xy, double lowest) override;
    GantryStatus status() const override { return status_; }
    const protocol::Limits& limits() const { return limits_; }

  private:
    void connect(const Job& job);
    std::string ask(const std::string& command, double duration);
    double measure(const std::string& command, double duration);
    const GantryStatus& obey(const std::string& command, double duration);
    const GantryStatus& move(const std::string& command, const Eigen::Vector3d& target, double duration, bool guarded);
    void accept(const GantryStatus& status); ///< @throws GantryFault with the problem alone
    void back_over(const Eigen::Vector3d& place, const std::string& command);
    void check_range(const Eigen::Vector3d& target);
    [[noreturn]] void fail(const std::string& problem);

    std::string command_;
    Child child_;
    double patience_;
    double most_force_; ///< F_max, N
    int asked_ = 0;
    protocol::Limits limits_;
    GantryStatus status_;
    bool known_ = false; ///< has there been a status?
    bool failed_ = false;
};

} // namespace fettle
