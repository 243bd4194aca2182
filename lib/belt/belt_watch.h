#pragma once

#include "belt/belt_grinding.h"
#include "core/descriptor.h"

#include <string>

namespace fettle {

/// A table of the errors after each contact point, as CSV: a line appears as soon as its point is done.
class BeltWatch {
  public:
    /// @param mm  of the lengths' unit
    /// @throws InputError if it cannot be written
    BeltWatch(const std::string& path, double mm);

    /// The lines of points that are not there yet.
    /// @throws InputError if they cannot be written
    void write(const BeltRun& run);

  private:
    void append(const std::string& lines);

    std::string path_;
    double mm_;
    Descriptor file_;
    std::size_t lines_ = 0;
};

} // namespace fettle
