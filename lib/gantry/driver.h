#pragma once

#include "core/descriptor.h"
#include "gantry/child.h"
#include "gantry/gantry.h"
#include "gantry/head_check.h"
#include "gantry/protocol.h"
#include "job/job.h"

#include <Eigen/Geometry>

#include <chrono>
#include <optional>
#include <string>

namespace fettle::gantry {

/// A machine behind a driver: a program that speaks the protocol of docs/driver.md on its stdin and stdout.
///
/// A driver is not trusted. Its answers have to carry the number of their command, come in time, hold finite numbers,
/// go forward in time, by no more than the move takes, move no farther than the machine is fast, end at the target of
/// the move, and report a force and a deflection that agree. At the first violation the machine is stopped, the driver
/// is terminated, and GantryFault names the driver and the fault.
///
/// An interruption sends `halt` while the command is under way. A driver that does not know it ends its move first.
class DriverGantry final : public Gantry {
  public:
    /// Connects, sends the job's frame to a robot, the head's F_max, and homes: the head turns to θ.
    /// @param timeout     of an answer beyond the time of the move, s
    /// @param head        of the machine, if it is known: for what its transducer may read
    /// @param T_cell_job  where the job lies in the cell of a robot, mm; nothing: the machine has a frame of its own
    /// @throws InputError if the driver cannot be started, GantryFault if it is at fault
    DriverGantry(const std::string& command, const job::Job& job, double timeout,
                 const std::optional<Head>& head = std::nullopt,
                 const std::optional<Eigen::Isometry3d>& T_cell_job = std::nullopt);
    /// Connects to a driver that runs already. @param name  for messages   @param socket  connected to the driver
    DriverGantry(const std::string& name, core::FileDescriptor socket, const job::Job& job, double timeout);
    ~DriverGantry() override;
    DriverGantry(const DriverGantry&) = delete;
    DriverGantry& operator=(const DriverGantry&) = delete;

    GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    GantryStatus travel_low(const Eigen::Vector3d& tool_point, double over, double free) override;
    GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    GantryStatus press(const Eigen::Vector3d& tool_point, double feed, double force) override;
    GantryStatus lift(double commanded_z) override;
    double touch_off() override;
    void change_wheel() override;
    double probe(const Eigen::Vector2d& xy, double lowest) override;
    void turn_to(double theta) override;
    GantryStatus status() const override { return status_; }
    double max_feed() const override { return limits_.speed; }
    const protocol::Limits& limits() const { return limits_; }

  private:
    void connect(const job::Job& job, const std::optional<Eigen::Isometry3d>& T_cell_job);
    void send_frame(const Eigen::Isometry3d& T_cell_job);
    void set_limit(double force);
    struct Answer {
        bool is_error;
        std::string text; ///< without number and verdict
    };
    Answer exchange(const std::string& command, double duration);
    std::string text_of(const Answer& answer);
    std::string request(const std::string& command, double duration);
    ChildProcess::Received receive(double timeout, std::string& line);
    [[noreturn]] void halt(double timeout);
    bool receive_answer_of_halt(const std::string& number, double timeout);
    double measure(const std::string& command, double duration);
    void execute(const std::string& command, double duration);
    const GantryStatus& end_move(const Answer& answer, const std::string& command, const Eigen::Vector3d& target,
                                 bool guarded);
    const GantryStatus& move(const std::string& command, const Eigen::Vector3d& target, double duration, bool guarded);
    template <class Parse>
    void parse_or_fail(const Parse& parse);
    void accept(const GantryStatus& status); ///< @throws GantryFault with the problem alone
    void check_time(double time) const;      ///< @throws as accept()
    void check_radius(double radius);
    void check_contact(const Eigen::Vector3d& target, const std::string& command);
    void check_position(const Eigen::Vector3d& expected, const std::string& command);
    void check_range(const Eigen::Vector3d& target) const;
    void check_feed(double feed) const;
    [[noreturn]] void fail(const std::string& problem);

    std::string command_;
    ChildProcess child_;
    double timeout_;
    HeadCheck head_;
    double height_tolerance_; ///< of the ground surface, mm
    double new_radius_;       ///< of a new wheel, mm
    double last_radius_ = 0;  ///< of this wheel, as measured last, mm; 0: not yet
    int last_number_ = 0;     ///< of the commands
    protocol::Limits limits_;
    GantryStatus status_;
    bool has_status_ = false;
    std::chrono::steady_clock::time_point status_clock_; ///< when that status came
    double max_duration_ = 0;                            ///< of the command under way, on the machine's clock, s
    bool failed_ = false;
    enum class Known { not_yet, yes, no };
    Known travels_low_ = Known::not_yet; ///< whether the driver knows the command
};

} // namespace fettle::gantry
