#pragma once

#include "belt/belt_grinding.h"
#include "core/descriptor.h"

#include <string>

namespace fettle::belt {

/// CSV table of the errors after each contact point. A line is written as soon as its point is done.
class BeltErrorLog {
  public:
    /// @param mm_per_unit  of the lengths in the table
    /// @throws InputError if it cannot be written
    BeltErrorLog(const std::string& path, double mm_per_unit);

    /// Appends the lines of the points done since the last call.
    /// @throws InputError if they cannot be written
    void write(const BeltRun& run);

  private:
    void append(const std::string& lines);

    std::string path_;
    double mm_per_unit_;
    core::FileDescriptor file_;
    std::size_t lines_written_ = 0;
};

} // namespace fettle::belt
