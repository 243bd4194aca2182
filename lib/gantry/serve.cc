#include "gantry/serve.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <poll.h>

namespace fettle::gantry {
namespace {

constexpr double kAngleTolerance = 1e-9; // rad; rounding of its text
/// A slower feed takes weeks for a step.
constexpr double kMinFeed = 1e-6; // mm/s
constexpr std::size_t kMaxLineLength = 4096;

/// The client's lines.
class Lines {
  public:
    explicit Lines(const core::FileDescriptor& in) : in_(in) {}

    enum class Got { line, end, too_long };
    Got next(std::string& line)
    {
        for (;;) {
            const std::size_t end = pending_.find('\n');
            if (end != std::string::npos) {
                line = pending_.substr(0, end);
                pending_.erase(0, end + 1);
                return Got::line;
            }
            if (pending_.size() > kMaxLineLength) return Got::too_long;
            if (!read()) return Got::end;
        }
    }

    /// Has the client sent `halt` while a command is under way? Reads what has come, and keeps it.
    bool halt_has_come()
    {
        pollfd readable{in_.get(), POLLIN, 0};
        if (pending_.size() <= kMaxLineLength && ::poll(&readable, 1, 0) > 0) read();
        std::string_view rest = pending_;
        for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
            std::string_view line = rest.substr(0, end);
            protocol::next_word(line); // its number
            if (line == "halt") return true;
            rest.remove_prefix(end + 1);
        }
        return false;
    }

  private:
    bool read()
    {
        char buffer[4096];
        const ssize_t n = core::read_some(in_, buffer, sizeof buffer);
        if (n > 0) pending_.append(buffer, n);
        return n > 0;
    }

    const core::FileDescriptor& in_;
    std::string pending_;
};

class Server {
  public:
    Server(Gantry& gantry, const protocol::Limits& limits, const job::Job& job, Lines& lines)
        : gantry_(gantry), limits_(limits), job_(job), theta_(job.theta), lines_(lines)
    {
    }

    /// @return  the answer, without number
    std::string answer(std::string_view line)
    {
        gantry_.set_interrupt([this](const GantryStatus& /*now*/) { return lines_.halt_has_come(); });
        try {
            return "ok " + execute(protocol::next_word(line), line);
        } catch (const Interrupted& stop) {
            return std::string("error ") + stop.what();
        } catch (const std::runtime_error& error) { // a fault of the machine, or a malformed command
            return std::string("error ") + error.what();
        }
    }
    bool ended() const { return ended_; }
    /// Raises the head after the client has disconnected. Nobody is left to report a fault to, such as a wheel worn
    /// away.
    void retract_ignoring_faults()
    {
        try {
            retract();
        } catch (const core::InputError&) {
        }
    }

  private:
    GantryStatus retract()
    {
        gantry_.set_interrupt({});
        return gantry_.lift(std::max(job_.safe_height, gantry_.status().commanded.z()));
    }

    std::string halt()
    {
        gantry_.set_interrupt({});
        return protocol::to_line(gantry::retract(gantry_, job_.safe_height));
    }

    std::string execute(std::string_view command, std::string_view rest)
    {
        const auto number = [&] { return protocol::parse_finite_number(protocol::next_word(rest)); };
        const auto point = [&] {
            const double x = number(), y = number(), z = number();
            return within_reach({x, y, z});
        };
        const auto feed = [&] {
            const double rate = number();
            if (rate < kMinFeed || rate > limits_.speed)
                throw GantryFault("no feed of " + core::to_text(rate) + " mm/s");
            return rate;
        };
        if (command == "connect" && rest == protocol::kVersion)
            return protocol::kVersion + " " + protocol::to_line(limits_);
        if (command == "limit") return limit(number());
        if (command == "frame") {
            gantry_.set_frame(protocol::parse_pose(rest));
            return protocol::to_line(gantry_.status());
        }
        if (command == "home") return home(number());
        if (command == "status") return protocol::to_line(gantry_.status());
        if (command == "travel") return protocol::to_line(gantry_.travel(point()));
        if (command == "travel_low") {
            const Eigen::Vector3d to = point();
            const double over = number(), free = number();
            within_reach({to.x(), to.y(), over});
            return protocol::to_line(gantry_.travel_low(to, over, free));
        }
        if (command == "lift") return protocol::to_line(gantry_.lift(height(number())));
        if (command == "move") {
            const Eigen::Vector3d to = point();
            return protocol::to_line(gantry_.grind(to, feed()));
        }
        if (command == "press") {
            const Eigen::Vector3d to = point();
            const double rate = feed();
            return protocol::to_line(gantry_.press(to, rate, number()));
        }
        if (command == "touch_off") {
            const double radius = gantry_.touch_off();
            return core::to_text(radius) + " " + protocol::to_line(gantry_.status());
        }
        if (command == "probe") {
            const Eigen::Vector3d to = point();
            const double z = gantry_.probe(to.head<2>(), to.z());
            return (std::isnan(z) ? "none" : core::to_text(z)) + " " + protocol::to_line(gantry_.status());
        }
        if (command == "change_wheel") {
            gantry_.change_wheel();
            return protocol::to_line(gantry_.status());
        }
        if (command == "halt") return halt();
        if (command == "stop" || command == "quit") {
            ended_ = true;
            return protocol::to_line(retract());
        }
        throw GantryFault("no such command: " + std::string(command));
    }

    Eigen::Vector3d within_reach(const Eigen::Vector3d& p) const
    {
        if ((p.array() >= limits_.min.array()).all() && (p.array() <= limits_.max.array()).all()) return p;
        throw GantryFault("the machine does not reach " + core::to_text(p.x()) + " " + core::to_text(p.y()) + " " +
                          core::to_text(p.z()));
    }

    double height(double z) const
    {
        const Eigen::Vector3d here = gantry_.status().commanded;
        return within_reach({here.x(), here.y(), z}).z();
    }

    std::string limit(double force) const
    {
        if (force != job_.force.max) throw GantryFault("F_max is " + core::to_text(job_.force.max) + " N here");
        return core::to_text(force);
    }

    std::string home(double theta)
    {
        if (std::abs(theta - theta_) > kAngleTolerance) gantry_.turn_to(theta);
        theta_ = theta;
        return protocol::to_line(gantry_.status());
    }

    Gantry& gantry_;
    const protocol::Limits& limits_;
    const job::Job& job_;
    double theta_; ///< of the head, rad
    Lines& lines_;
    bool ended_ = false;
};

} // namespace

void serve(Gantry& gantry, const protocol::Limits& limits, const job::Job& job, const core::FileDescriptor& in,
           const core::FileDescriptor& out)
{
    // The client may close the pipe before the answer; the head has to be raised nevertheless.
    std::signal(SIGPIPE, SIG_IGN);
    Lines lines(in);
    Server server(gantry, limits, job, lines);
    std::string line;
    while (!server.ended()) {
        const Lines::Got got = lines.next(line);
        if (got != Lines::Got::line) {
            server.retract_ignoring_faults();
            if (got == Lines::Got::end) return;
            throw core::InputError("stdin", "a line of more than " + std::to_string(kMaxLineLength) + " bytes");
        }
        std::string_view rest = line;
        const std::string number(protocol::next_word(rest));
        if (core::write_all(out, number + " " + server.answer(rest) + "\n")) continue;
        const bool client_gone = errno == EPIPE;
        server.retract_ignoring_faults();
        if (client_gone) return;
        throw core::InputError("stdout", "cannot be written");
    }
}

} // namespace fettle::gantry
