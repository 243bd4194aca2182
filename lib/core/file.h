#pragma once

#include "core/descriptor.h"

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <string>

namespace fettle {

/// The most bytes of a JSON document: a million control points of patches, and no more than some GB as a tree.
inline constexpr std::size_t kMostJson = std::size_t{1} << 26;

/// All bytes of a file, a FIFO or stdin ("-").
/// @param most  bytes; kMostJson where nothing but JSON will do
/// @throws InputError if it cannot be opened or read (the reason is named), is a directory, or is stdin and that a
/// terminal, from which nobody types it; before the rest is read also if it is longer than `most`, begins as JSON and
/// is longer than kMostJson, or begins with a line of other text of more than 64 KiB
std::string read_whole(const std::string& path, std::size_t most = std::string::npos);

/// A file, a FIFO or stdin ("-") that can be read anywhere, by several threads at once. What cannot be sought is copied
/// to an unnamed file in $TMPDIR (else /tmp) unless it is small.
class InputFile {
  public:
    /// @throws InputError as read_whole()
    explicit InputFile(const std::string& path);

    std::size_t size() const { return size_; }
    /// @throws InputError if it cannot be read or has become shorter
    void read(std::size_t offset, char* to, std::size_t count) const;

  private:
    void keep_stream();

    std::string path_;
    Descriptor file_;
    std::size_t start_ = 0; ///< stdin may be a file of which some was read
    std::size_t size_ = 0;
    std::string held_; ///< all of a small stream
};

/// How a path is called in messages: "stdin" for "-".
std::string display_name(const std::string& path);

/// Do two names mean the same file, which need not exist? "-" is itself alone.
bool same_file(const std::string& a, const std::string& b);

/// The file that a name leads to, through links: what takes its place leaves them as they are.
/// @throws InputError if there is none
std::string link_target(const std::string& path);

/// A file that appears whole or not at all: what is written goes to an unnamed file in the same folder, which commit()
/// syncs and gives the name. A link stays one: the file it names is replaced. A target that exists and is no regular
/// file (/dev/null, a FIFO) and stdout ("-") get nothing before commit(). Without commit(), nothing is left, even if
/// the program is killed.
class OutputFile {
  public:
    /// @throws InputError if it could not be written
    explicit OutputFile(const std::string& path);
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    /// Throws InputError itself if something cannot be written (disk full).
    std::ostream& stream();
    /// What is written goes to the disk, though without its name yet: commit() then finds room. Nothing can be written
    /// after it.
    /// @throws InputError if something cannot be written
    void settle();
    /// @throws InputError if something cannot be written; binary data to a terminal
    void commit();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle
