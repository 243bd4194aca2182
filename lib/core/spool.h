#pragma once

#include "core/descriptor.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::core {

/// Byte buffer that grows at its end: in memory up to a limit, beyond it in an unnamed file.
class Spool {
  public:
    /// @param max_memory  bytes kept in memory
    explicit Spool(std::size_t max_memory) : max_memory_(max_memory) {}

    /// @throws InputError if the file cannot be created or written
    void append(std::string_view bytes);
    std::size_t size() const { return in_memory_ + in_file_; }
    /// @throws InputError if the file cannot be read
    void read(std::size_t offset, char* to, std::size_t count) const;

  private:
    std::size_t max_memory_;
    std::size_t in_memory_ = 0;       ///< bytes in memory
    std::size_t in_file_ = 0;         ///< bytes in the file, after those in memory
    std::vector<std::string> chunks_; ///< all but the last full; they never move when the buffer grows
    FileDescriptor file_;
};

} // namespace fettle::core
