#pragma once

#include "core/descriptor.h"

#include <string>
#include <sys/types.h>
#include <utility>

namespace fettle::gantry {

/// A child process with a line protocol: its stdin and stdout are one socket, its stderr is ours. It has a process
/// group of its own, which ends with this object.
class ChildProcess {
  public:
    /// @param command  for the shell
    /// @throws InputError if it cannot be started
    explicit ChildProcess(const std::string& command);
    /// A peer that runs already. @param socket  connected stream socket
    explicit ChildProcess(core::FileDescriptor socket) : socket_(std::move(socket)) {}
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    /// Terminates it within a second.
    ~ChildProcess();

    /// @return  false if the peer has closed its end
    bool send(const std::string& line);

    enum class Received { line, timeout, closed, too_long };
    /// Waits for a line. Too long: more bytes without an end of line than a line may have. @param timeout  s
    Received receive(double timeout, std::string& line);

    /// Closes the socket, waits for the program to end, and kills its process group after `timeout`, s.
    void terminate(double timeout);

    /// How it ended: "ended with status 3", "was killed by signal 9", "closed its output".
    std::string exit_description();

  private:
    bool wait_for_exit(double timeout);

    core::FileDescriptor socket_;
    pid_t pid_ = -1; ///< -1 once it has been waited for
    pid_t group_ = -1;
    int status_ = 0;
    std::string pending_; ///< received, not yet a complete line
};

} // namespace fettle::gantry
