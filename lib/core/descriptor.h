#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace fettle {

/// An open file of the system's, closed once. -1: none.
class Descriptor {
  public:
    explicit Descriptor(int file = -1) : file_(file) {}
    Descriptor(Descriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept
    {
        std::swap(file_, other.file_);
        return *this;
    }
    ~Descriptor()
    {
        if (file_ >= 0) ::close(file_);
    }

    int get() const { return file_; }
    bool is_open() const { return file_ >= 0; }
    /// @return  false, and errno, if what was written did not arrive
    bool close() { return ::close(std::exchange(file_, -1)) == 0; }

  private:
    int file_;
};

/// @return  bytes read, at most `count`; 0 at the end; -1, and errno, if it cannot be read
ssize_t read_some(const Descriptor& file, char* to, std::size_t count);

/// @return  false, and errno, if something could not be written
bool write_all(const Descriptor& file, std::string_view bytes);

/// A new file without a name, for reading and writing, where `path` is or is to be. It is gone when it is closed.
/// @return  not open, and errno, if it cannot be made
Descriptor open_unnamed(const std::string& path);

/// The name by which files beside `path` are written before they get its name: no other program's, nor anyone's file.
std::string working_name(const std::string& path);

/// A path for open_unnamed() where a stream may be copied to: in $TMPDIR, else /tmp.
std::string scratch_path();

} // namespace fettle
