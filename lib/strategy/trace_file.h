#pragma once

#include "cloud/pcd.h"
#include "core/descriptor.h"
#include "strategy/trace.h"

#include <string>
#include <vector>

namespace fettle {

/// A trace that is written ahead: what the machine is to do stands in the file before it does it (event `begun`, the
/// place where it is to go), and in its stead, afterwards, what came of it. Whenever the program is killed, the points
/// that its header counts are whole; after them there may be one more, or a part of it, which read_trace() passes over.
/// It is not synced to the disk: it outlives the program, not the computer.
class TraceFile {
  public:
    /// Puts a file with these rows in the place of `path`.
    /// @param source  its name for messages   @throws InputError if it cannot be written
    TraceFile(const std::string& path, const Units& units, PcdEncoding encoding, const std::vector<TraceRow>& rows);

    /// @throws InputError if it cannot be written
    void begin(const TraceRow& row);
    void done(const TraceRow& row);

  private:
    std::string header(std::size_t points) const;
    std::string text(const TraceRow& row) const;
    void write(const std::string& bytes, std::size_t at);

    std::string path_;
    Units units_;
    PcdEncoding encoding_;
    std::string header_; ///< of no points
    Descriptor file_;
    std::size_t start_ = 0, width_ = 0; ///< of the first row; of each, bytes
    std::size_t count_ = 0;             ///< rows
    bool begun_ = false;                ///< the last of them
};

/// A trace, also of a program that was killed. Decisions to stop and what was begun but not done are left out at the
/// end.
/// @param units  it must be in   @throws InputError if it is no trace
std::vector<TraceRow> read_trace(const std::string& path, const Units& units);

} // namespace fettle
