#pragma once

// A file without a disk, for readers that take a path.

#include "fuzz.h"

#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

namespace fettle::fuzz {

class MemoryFile {
  public:
    MemoryFile() : file_(::memfd_create("input", 0)), path_("/proc/self/fd/" + std::to_string(file_))
    {
        require(file_ >= 0, "there are files in memory");
    }
    ~MemoryFile() { ::close(file_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    /// Holds these bytes and no others.
    const std::string& with(std::string_view bytes)
    {
        require(::ftruncate(file_, 0) == 0 &&
                    ::pwrite(file_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
                "a file in memory takes what is written");
        return path_;
    }
    const std::string& path() const { return path_; }

  private:
    int file_;
    std::string path_;
};

} // namespace fettle::fuzz
