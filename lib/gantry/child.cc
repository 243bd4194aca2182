#include "gantry/child.h"

#include "core/error.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <utility>

extern char** environ;

namespace fettle::gantry {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxLineLength = 4096;
constexpr double kGracePeriod = 1;                  // for a program to end, s
constexpr double kMaxWait = 1e6;                    // s; poll() counts ms in an int
constexpr std::chrono::milliseconds kPollPeriod{5}; // while waiting for a program to end

Clock::time_point after(double seconds)
{
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

double seconds_until(Clock::time_point end) { return std::chrono::duration<double>(end - Clock::now()).count(); }

} // namespace

ChildProcess::ChildProcess(const std::string& command)
{
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw core::InputError(command, std::string("cannot be started: ") + std::strerror(errno));
    socket_ = core::FileDescriptor(ends[0]);
    const core::FileDescriptor theirs(ends[1]);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, theirs.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, theirs.get(), STDOUT_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::string shell = "sh", option = "-c", text = command;
    char* arguments[] = {shell.data(), option.data(), text.data(), nullptr};
    const int error = ::posix_spawn(&pid_, "/bin/sh", &actions, &attributes, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    group_ = pid_;
    if (error != 0) throw core::InputError(command, std::string("cannot be started: ") + std::strerror(error));
}

ChildProcess::~ChildProcess() { terminate(kGracePeriod); }

void ChildProcess::terminate(double timeout)
{
    socket_ = core::FileDescriptor();
    if (pid_ > 0) wait_for_exit(timeout);
    if (group_ > 0) ::kill(-std::exchange(group_, -1), SIGKILL);
    if (pid_ > 0) ::waitpid(std::exchange(pid_, -1), nullptr, 0);
}

bool ChildProcess::send(const std::string& line)
{
    const std::string text = line + "\n";
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t n = ::send(socket_.get(), text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        sent += n;
    }
    return true;
}

ChildProcess::Received ChildProcess::receive(double timeout, std::string& line)
{
    const Clock::time_point end = after(std::min(timeout, kMaxWait));
    for (;;) {
        if (const std::size_t at = pending_.find('\n'); at != std::string::npos) {
            line = pending_.substr(0, at);
            pending_.erase(0, at + 1);
            return Received::line;
        }
        if (pending_.size() > kMaxLineLength) return Received::too_long;
        pollfd readable{socket_.get(), POLLIN, 0};
        const double left = seconds_until(end);
        if (left <= 0) return Received::timeout;
        const int ready = ::poll(&readable, 1, int(left * 1000) + 1);
        if (ready < 0 && errno != EINTR) return Received::closed;
        if (ready <= 0) continue;
        char buffer[kMaxLineLength];
        const ssize_t n = ::read(socket_.get(), buffer, sizeof buffer);
        if (n <= 0) return Received::closed;
        pending_.append(buffer, n);
    }
}

bool ChildProcess::wait_for_exit(double timeout)
{
    const Clock::time_point end = after(timeout);
    while (::waitpid(pid_, &status_, WNOHANG) == 0) {
        if (seconds_until(end) <= 0) return false;
        std::this_thread::sleep_for(kPollPeriod);
    }
    pid_ = -1;
    return true;
}

std::string ChildProcess::exit_description()
{
    if (group_ < 0 || (pid_ > 0 && !wait_for_exit(kGracePeriod))) return "closed its output";
    if (WIFSIGNALED(status_)) return "was killed by signal " + std::to_string(WTERMSIG(status_));
    return "ended with status " + std::to_string(WEXITSTATUS(status_));
}

} // namespace fettle::gantry
