#include "gantry/serve.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <optional>

namespace fettle {
namespace {

/// The same angle but for the rounding of its text.
constexpr double kSameAngle = 1e-9;
/// Slower, a step takes weeks; 0 would take for ever.
constexpr double kSlowest = 1e-6; // mm/s
/// No command is longer.
constexpr std::size_t kLongestLine = 4096;

class Server {
  public:
    Server(Gantry& gantry, const protocol::Limits& limits, const Job& job) : gantry_(gantry), limits_(limits), job_(job)
    {
    }

    /// @return  the answer, without number
    std::string answer(std::string_view line)
    {
        try {
            return "ok " + obey(protocol::next_word(line), line);
        } catch (const std::runtime_error& error) { // a fault of the machine, or a command that is none
            return std::string("error ") + error.what();
        }
    }
    bool over() const { return over_; }
    /// When nobody speaks any more. A wheel that is worn away by what it grinds on the way up stops nothing then.
    void leave()
    {
        try {
            let_go();
        } catch (const InputError&) {
        }
    }

  private:
    void let_go() { gantry_.lift(std::max(job_.safe_height, gantry_.status().commanded.z())); }

    std::string obey(std::string_view command, std::string_view rest)
    {
        const auto number = [&] { return protocol::number_in(protocol::next_word(rest)); };
        const auto point = [&] {
            const double x = number(), y = number(), z = number();
            return within_reach({x, y, z});
        };
        const auto feed = [&] {
            const double rate = number();
            if (rate < kSlowest || rate > limits_.speed) throw GantryFault("no feed of " + to_text(rate) + " mm/s");
            return rate;
        };
        if (command == "connect" && rest == protocol::kVersion)
            return protocol::kVersion + " " + protocol::text_of(limits_);
        if (command == "limit") return limit(number());
        if (command == "home") return home(number());
        if (command == "status") return protocol::text_of(gantry_.status());
        if (command == "travel") return protocol::text_of(gantry_.travel(point()));
        if (command == "lift") return protocol::text_of(gantry_.lift(height(number())));
        if (command == "move") {
            const Eigen::Vector3d to = point();
            return protocol::text_of(gantry_.grind(to, feed()));
        }
        if (command == "press") {
            const Eigen::Vector3d to = point();
            const double rate = feed();
            return protocol::text_of(gantry_.press(to, rate, number()));
        }
        if (command == "touch_off") {
            const double radius = gantry_.touch_off();
            return to_text(radius) + " " + protocol::text_of(gantry_.status());
        }
        if (command == "probe") {
            const Eigen::Vector3d to = point();
            const double z = gantry_.probe(to.head<2>(), to.z());
            return (std::isnan(z) ? "none" : to_text(z)) + " " + protocol::text_of(gantry_.status());
        }
        if (command == "change_wheel") {
            gantry_.change_wheel();
            return protocol::text_of(gantry_.status());
        }
        if (command == "stop" || command == "quit") {
            over_ = true;
            let_go();
            return protocol::text_of(gantry_.status());
        }
        throw GantryFault("no such command: " + std::string(command));
    }

    Eigen::Vector3d within_reach(const Eigen::Vector3d& p) const
    {
        if ((p.array() >= limits_.least.array()).all() && (p.array() <= limits_.most.array()).all()) return p;
        throw GantryFault("the machine does not reach " + to_text(p.x()) + " " + to_text(p.y()) + " " + to_text(p.z()));
    }

    double height(double z) const
    {
        const Eigen::Vector3d here = gantry_.status().commanded;
        return within_reach({here.x(), here.y(), z}).z();
    }

    std::string limit(double force) const
    {
        if (force != job_.force.max) throw GantryFault("F_max is " + to_text(job_.force.max) + " N here");
        return to_text(force);
    }

    std::string home(double theta) const
    {
        if (std::abs(theta - job_.theta) > kSameAngle)
            throw GantryFault("the head stands at " + to_text(job_.theta) + " rad");
        return protocol::text_of(gantry_.status());
    }

    Gantry& gantry_;
    const protocol::Limits& limits_;
    const Job& job_;
    bool over_ = false;
};

} // namespace

void serve(Gantry& gantry, const protocol::Limits& limits, const Job& job, const Descriptor& in, const Descriptor& out)
{
    // Whoever asked may be gone before the answer; that must not end what is to be left behind in order.
    std::signal(SIGPIPE, SIG_IGN);
    Server server(gantry, limits, job);
    std::string pending;
    char some[4096];
    while (!server.over()) {
        const std::size_t end = pending.find('\n');
        if (end == std::string::npos) {
            if (pending.size() > kLongestLine) {
                server.leave();
                throw InputError("stdin", "a line of more than " + std::to_string(kLongestLine) + " bytes");
            }
            const ssize_t n = read_some(in, some, sizeof some);
            if (n <= 0) return server.leave();
            pending.append(some, static_cast<std::size_t>(n));
            continue;
        }
        const std::string line = pending.substr(0, end);
        pending.erase(0, end + 1);
        std::string_view rest = line;
        const std::string number(protocol::next_word(rest));
        if (write_all(out, number + " " + server.answer(rest) + "\n")) continue;
        const bool is_alone = errno == EPIPE;
        server.leave();
        if (is_alone) return;
        throw InputError("stdout", "cannot be written");
    }
}

} // namespace fettle
