#pragma once

#include <iosfwd>
#include <memory>
#include <string>

namespace fettle {

/// All bytes of a file, a FIFO or stdin ("-").
/// @throws InputError if it cannot be opened or read (the reason is named), or is a directory
std::string read_whole(const std::string& path);

/// How a path is called in messages: "stdin" for "-".
std::string display_name(const std::string& path);

/// A file that appears whole or not at all: it is written under another name in the same folder; commit() flushes,
/// syncs and renames it. A target that exists and is no regular file (/dev/null, a FIFO) is written directly at
/// commit(), "-" is stdout. Destroyed without commit(), nothing is left.
class OutputFile {
  public:
    /// @throws InputError if it cannot be created
    explicit OutputFile(const std::string& path);
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    std::ostream& stream();
    /// @throws InputError if a write failed (disk full)
    void commit();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle
