#pragma once

#include "core/descriptor.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// Bytes that are kept for later: in memory as far as they may, the rest in an unnamed file.
class Spool {
  public:
    /// @param memory  bytes that may be held
    explicit Spool(std::size_t memory) : memory_(memory) {}

    /// @throws InputError if the file cannot be made or written
    void append(std::string_view bytes);
    std::size_t size() const { return held_ + filed_; }
    /// @throws InputError if the file cannot be read
    void read(std::size_t offset, char* to, std::size_t count) const;

  private:
    std::size_t memory_;
    std::size_t held_ = 0;            ///< bytes in memory
    std::size_t filed_ = 0;           ///< bytes in the file, which follow them
    std::vector<std::string> chunks_; ///< all but the last of one size: nothing is moved when more come
    Descriptor file_;
};

} // namespace fettle
