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

namespace fettle {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestLine = 4096;
constexpr double kGrace = 1;                  // s
constexpr double kLongestWait = 1e6;          // s; what poll() counts in ms in an int
constexpr std::chrono::milliseconds kLook{5}; // between two looks at a program that is to end

double seconds_until(Clock::time_point end) { return std::chrono::duration<double>(end - Clock::now()).count(); }

} // namespace

Child::Child(const std::string& command)
{
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw InputError(command, std::string("cannot be started: ") + std::strerror(errno));
    socket_ = Descriptor(ends[0]);
    const Descriptor theirs(ends[1]);

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
    if (error != 0) throw InputError(command, std::string("cannot be started: ") + std::strerror(error));
}

Child::~Child() { let_end(kGrace); }

void Child::let_end(double timeout)
{
    socket_ = Descriptor();
    if (pid_ > 0) wait(timeout);
    if (group_ > 0) ::kill(-std::exchange(group_, -1), SIGKILL);
    if (pid_ > 0) ::waitpid(std::exchange(pid_, -1), nullptr, 0);
}

bool Child::send(const std::string& line)
{
    const std::string text = line + "\n";
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t n = ::send(socket_.get(), text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        sent += static_cast<std::size_t>(n);
    }
    return true;
}

Child::Heard Child::receive(double timeout, std::string& line)
{
    const std::chrono::duration<double> most(std::min(timeout, kLongestWait));
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(most);
    for (;;) {
        if (const std::size_t at = pending_.find('\n'); at != std::string::npos) {
            line = pending_.substr(0, at);
            pending_.erase(0, at + 1);
            return Heard::line;
        }
        if (pending_.size() > kLongestLine) return Heard::babble;
        pollfd look{socket_.get(), POLLIN, 0};
        const double left = seconds_until(end);
        if (left <= 0) return Heard::silence;
        const int ready = ::poll(&look, 1, static_cast<int>(left * 1000) + 1);
        if (ready < 0 && errno != EINTR) return Heard::end;
        if (ready <= 0) continue;
        char some[kLongestLine];
        const ssize_t n = ::read(socket_.get(), some, sizeof some);
        if (n <= 0) return Heard::end;
        pending_.append(some, static_cast<std::size_t>(n));
    }
}

bool Child::wait(double timeout)
{
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout));
    while (::waitpid(pid_, &status_, WNOHANG) == 0) {
        if (seconds_until(end) <= 0) return false;
        std::this_thread::sleep_for(kLook);
    }
    pid_ = -1;
    return true;
}

std::string Child::ending()
{
    if (group_ < 0 || (pid_ > 0 && !wait(kGrace))) return "closed its output";
    if (WIFSIGNALED(status_)) return "was killed by signal " + std::to_string(WTERMSIG(status_));
    return "ended with status " + std::to_string(WEXITSTATUS(status_));
}

} // namespace fettle
