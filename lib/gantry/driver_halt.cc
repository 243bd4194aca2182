// Interruption of a driver's command by the operator.

#include "gantry/driver.h"

#include <algorithm>

namespace fettle::gantry {
namespace {

/// Between two looks at the operator while an answer is awaited.
constexpr double kInterruptPeriod = 0.002; // s

} // namespace

/// Waits for a line. @throws Interrupted
ChildProcess::Received DriverGantry::receive(double timeout, std::string& line)
{
    using Clock = std::chrono::steady_clock;
    const auto begun = Clock::now();
    for (;;) {
        const double left = timeout - std::chrono::duration<double>(Clock::now() - begun).count();
        const auto received = child_.receive(std::min(left, kInterruptPeriod), line);
        if (received != ChildProcess::Received::timeout || left <= 0) return received;
        if (is_interrupted()) halt(left);
    }
}

/// Ends the command under way, which takes up to `timeout`, s, with a driver that does not know how.
void DriverGantry::halt(double timeout)
{
    const std::string number = std::to_string(++last_number_);
    if (!child_.send(number + " halt")) fail(child_.exit_description());
    if (!receive_answer_of_halt(number, timeout)) execute("status", 0);
    throw Interrupted();
}

/// The interrupted command's answer comes first; it does not count. @return  true if the driver knows `halt`
bool DriverGantry::receive_answer_of_halt(const std::string& number, double timeout)
{
    for (;;) {
        std::string line;
        if (child_.receive(timeout, line) != ChildProcess::Received::line) fail("does not answer 'halt'");
        std::string_view rest = line;
        if (protocol::next_word(rest) != number) continue;
        if (protocol::next_word(rest) != "ok") return false;
        try {
            accept(protocol::parse_status(rest));
        } catch (const GantryFault& fault) {
            fail(fault.what());
        }
        return true;
    }
}

} // namespace fettle::gantry
