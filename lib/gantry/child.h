#pragma once

#include "core/descriptor.h"

#include <string>
#include <sys/types.h>
#include <utility>

namespace fettle {

/// A program that is spoken to line by line: its stdin and stdout are one socket, its stderr is ours. It has a process
/// group of its own and is gone when this is.
class Child {
  public:
    /// @param command  for the shell
    /// @throws InputError if it cannot be started
    explicit Child(const std::string& command);
    /// Somebody who speaks already. @param socket  a stream's, where he is at the other end
    explicit Child(Descriptor socket) : socket_(std::move(socket)) {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    /// let_end() in a second.
    ~Child();

    /// @return  false if nobody takes it
    bool send(const std::string& line);

    enum class Heard { line, silence, end, babble };
    /// Waits for a line, s. Babble: more than a line may hold without an end.
    Heard receive(double timeout, std::string& line);

    /// Closes the socket and waits for the program to end, s. What is left then is killed.
    void let_end(double timeout);

    /// How it ended: "ended with status 3", "was killed by signal 9", "closed its output".
    std::string ending();

  private:
    bool wait(double timeout);

    Descriptor socket_;
    pid_t pid_ = -1; ///< -1 once it has been waited for
    pid_t group_ = -1;
    int status_ = 0;
    std::string pending_; ///< read, but not yet a line
};

} // namespace fettle
