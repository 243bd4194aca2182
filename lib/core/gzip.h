#pragma once

#include "core/descriptor.h"

#include <cstddef>
#include <memory>
#include <string>

namespace fettle::core {

/// The bytes of a file or stream from its present position on; what gzip compressed comes as what it was.
class GzipReader {
  public:
    /// @param path  for messages
    GzipReader(const FileDescriptor& file, std::string path);
    ~GzipReader();

    /// Fills `to`, except at the end. @return number of bytes
    /// @throws InputError if the file cannot be read, or compressed data is damaged or ends too early
    std::size_t read(char* to, std::size_t count);
    /// Known after the first read.
    bool is_compressed() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// True for the first bytes of what gzip compressed.
bool looks_like_gzip(const std::string& head);

} // namespace fettle::core
