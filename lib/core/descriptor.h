#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace fettle::core {

/// Owns a file descriptor and closes it once; -1: none.
class FileDescriptor {
  public:
    explicit FileDescriptor(int file = -1) : file_(file) {}
    FileDescriptor(FileDescriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
    FileDescriptor& operator=(FileDescriptor&& other) noexcept
    {
        std::swap(file_, other.file_);
        return *this;
    }
    ~FileDescriptor()
    {
        if (file_ >= 0) ::close(file_);
    }

    int get() const { return file_; }
    bool is_open() const { return file_ >= 0; }
    /// @return  false and errno if written data may be lost
    bool close() { return ::close(std::exchange(file_, -1)) == 0; }

  private:
    int file_;
};

/// Reads once, as read(2), but repeats it when a signal interrupts it.
/// @return  bytes read, at most `count`; 0 at the end; -1 and errno if it cannot be read
ssize_t read_some(const FileDescriptor& file, char* to, std::size_t count);

/// Writes all bytes. @return  false and errno if it failed
bool write_all(const FileDescriptor& file, std::string_view bytes);

/// Creates an unnamed file for reading and writing on the file system of `path`. Closing it deletes it.
/// @return  not open, and errno, if it cannot be created
FileDescriptor open_unnamed(const std::string& path);

/// Temporary name beside `path`, unique to this process, for a file that will be renamed to `path`.
std::string temporary_name(const std::string& path);

/// Path for open_unnamed() in the directory of temporary files: $TMPDIR, else /tmp.
std::string scratch_path();

} // namespace fettle::core
