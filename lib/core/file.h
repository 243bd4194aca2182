#pragma once

#include "core/descriptor.h"

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <string>

namespace fettle::core {

/// Largest JSON document, bytes: enough for a million control points of patches, and at most a few GB as a tree.
inline constexpr std::size_t kMaxJsonBytes = std::size_t{1} << 26;

/// Contents of a file, a FIFO or stdin ("-"); of what gzip compressed, decompressed.
/// @param max  largest size, bytes; kMaxJsonBytes for files that must be JSON
/// @throws InputError if it cannot be opened or read (with the reason), is a directory, or is stdin and a terminal.
/// Files that are too long are rejected before they are read entirely: longer than `max`, JSON longer than
/// kMaxJsonBytes, or other text whose first line is longer than 64 KiB
std::string read_file(const std::string& path, std::size_t max = std::string::npos);

/// A file, a FIFO or stdin ("-") with random access, for several threads at once. A stream, and what gzip compressed,
/// is copied to memory if it is small, else to an unnamed file in $TMPDIR (else /tmp).
class InputFile {
  public:
    /// @throws InputError as read_file()
    explicit InputFile(const std::string& path);

    std::size_t size() const { return size_; }
    /// @throws InputError if it cannot be read or has become shorter
    void read(std::size_t offset, char* to, std::size_t count) const;
    /// Contents of the whole file. @throws InputError as read()
    std::string read_all() const;

  private:
    void copy_stream();

    std::string path_;
    FileDescriptor file_;
    std::size_t start_ = 0; ///< position at opening: stdin may be a file that was read partly
    std::size_t size_ = 0;
    std::string memory_; ///< contents of a small stream
};

/// Name of a path in messages: "stdin" for "-".
std::string display_name(const std::string& path);

/// True if two paths name the same file, which need not exist. "-" equals only itself.
bool same_file(const std::string& a, const std::string& b);

/// Resolves symbolic links, so that the file can be replaced and the links stay.
/// @throws InputError if the file does not exist
std::string resolve_links(const std::string& path);

/// Writes a file atomically: data goes to an unnamed file in the same folder, which commit() syncs and names. A
/// symbolic link stays, and the file it names is replaced. A target that is not a regular file (/dev/null, a FIFO) and
/// stdout
/// ("-") receive nothing before commit(). Without commit() nothing is left, even if the program is killed.
class OutputFile {
  public:
    /// @throws InputError if the file cannot be written
    explicit OutputFile(const std::string& path);
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    /// The stream throws InputError itself if data cannot be written (disk full).
    std::ostream& stream();
    /// Writes all data to the disk, still without a name, so that commit() cannot fail for lack of space. Nothing can
    /// be written afterwards.
    /// @throws InputError if data cannot be written
    void sync();
    /// Gives the file its name, or writes the data to a target that is not a regular file.
    /// @throws InputError if data cannot be written, or is binary and would go to a terminal
    void commit();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle::core
