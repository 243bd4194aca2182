#include "gantry/serve.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <optional>

namespace fettle::gantry {
namespace {

constexpr double kAngleTolerance = 1e-9; // rad; rounding of its text
/// A slower feed takes weeks for a step.
constexpr double kMinFeed = 1e-6; // mm/s
constexpr std::size_t kMaxLineLength = 4096;

class Server {
  public:
    Server(Gantry& gantry, const protocol::Limits& limits, const job::Job& job)
        : gantry_(gantry), limits_(limits), job_(job)
    {
    }

    /// @return  the answer, without number
    std::string answer(std::string_view line)
    {
        try {
            return "ok " + execute(protocol::next_word(line), line);
        } catch (const std::runtime_error& error) { // a fault of the machine, or a malformed command
            return std::string("error ") + error.what();
        }
    }
    bool ended() const { return ended_; }
    /// Raises the head when the client is gone. A wheel that is worn away on the way up is no reason to fail then.
    void retract_ignoring_faults()
    {
        try {
            retract();
        } catch (const core::InputError&) {
        }
    }

  private:
    GantryStatus retract() { return gantry_.lift(std::max(job_.safe_height, gantry_.status().commanded.z())); }

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
        if (command == "home") return home(number());
        if (command == "status") return protocol::to_line(gantry_.status());
        if (command == "travel") return protocol::to_line(gantry_.travel(point()));
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

    std::string home(double theta) const
    {
        if (std::abs(theta - job_.theta) > kAngleTolerance)
            throw GantryFault("the head stands at " + core::to_text(job_.theta) + " rad");
        return protocol::to_line(gantry_.status());
    }

    Gantry& gantry_;
    const protocol::Limits& limits_;
    const job::Job& job_;
    bool ended_ = false;
};

} // namespace

void serve(Gantry& gantry, const protocol::Limits& limits, const job::Job& job, const core::FileDescriptor& in,
           const core::FileDescriptor& out)
{
    // The client may be gone before the answer; the head has to be raised nevertheless.
    std::signal(SIGPIPE, SIG_IGN);
    Server server(gantry, limits, job);
    std::string pending;
    char buffer[4096];
    while (!server.ended()) {
        const std::size_t end = pending.find('\n');
        if (end == std::string::npos) {
            if (pending.size() > kMaxLineLength) {
                server.retract_ignoring_faults();
                throw core::InputError("stdin", "a line of more than " + std::to_string(kMaxLineLength) + " bytes");
            }
            const ssize_t n = core::read_some(in, buffer, sizeof buffer);
            if (n <= 0) return server.retract_ignoring_faults();
            pending.append(buffer, n);
            continue;
        }
        const std::string line = pending.substr(0, end);
        pending.erase(0, end + 1);
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
