// Answers of a driver to a client that sends all commands. The driver may be at fault; the client then reports it.

#include "gantry/driver.h"
#include "core/descriptor.h"
#include "fuzz.h"

#include <sys/socket.h>

using namespace fettle;

namespace {

constexpr double kPatience = 0.01; // s; the answers are there before the questions

void drive(core::FileDescriptor socket, const job::Job& job)
{
    gantry::DriverGantry gantry("driver", std::move(socket), job, kPatience);
    gantry.travel({1, 2, 5});
    gantry.grind({2, 2, 5}, 10);
    gantry.press({3, 2, 4}, 10, 20);
    gantry.lift(20);
    gantry.touch_off();
    gantry.probe({1, 1}, 0);
    gantry.change_wheel();
    fuzz::require(gantry.status().commanded.allFinite(), "a machine is somewhere");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const job::Job job;
    int ends[2];
    fuzz::require(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0, "there are sockets");
    core::FileDescriptor ours(ends[0]);
    const core::FileDescriptor theirs(ends[1]);
    fuzz::require(core::write_all(theirs, fuzz::text_of(data, size)), "a socket takes the answers");
    ::shutdown(theirs.get(), SHUT_WR);
    fuzz::is_read([&] { drive(std::move(ours), job); });
    return 0;
}
