#pragma once

#include "core/descriptor.h"
#include "strategy/trace_file.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace fettle::station {

/// Brings a trace that is being written to the disk, five times a second, in a thread of its own: the machine does not
/// wait for the disk. A file beside it says how many rows are certain to be there, and their digest, since after a
/// power failure pages of the trace may be missing or older than its header.
class Checkpoint {
  public:
    /// @param trace  path of the trace   @throws InputError if it cannot be opened
    explicit Checkpoint(const std::string& trace);
    ~Checkpoint();
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    /// Called after each row.
    void follow(const strategy::TraceFile& journal);

  private:
    void sync();

    std::string trace_;
    core::FileDescriptor file_;
    std::chrono::steady_clock::time_point next_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<strategy::TraceFile::Completed> due_; ///< to be brought to the disk
    bool ends_ = false;
    std::thread thread_;
};

/// Name of the checkpoint of a trace.
std::string checkpoint_of(const std::string& trace);

/// Reads a trace, if its last rows were lost in a power failure up to the last checkpoint.
/// @throws InputError as strategy::read_recorded_trace(), if there is no checkpoint either
strategy::RecordedTrace read_trace_or_checkpoint(const std::string& trace, const units::Units& units);

} // namespace fettle::station
