#include "core/file.h"

#include "core/error.h"
#include "core/lines.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <system_error>

namespace fettle {

namespace {

constexpr std::size_t kChunk = 1 << 18; // of a stream, bytes
/// Longer first lines only JSON has: of PCD and PLY, whose own limit it is, and of all other texts they are short, and
/// the first of these bytes in a binary STL hold zeros, in its count of triangles.
constexpr std::size_t kLongestLine = 1 << 16;

[[noreturn]] void fail(const std::string& path, const std::string& doing)
{
    throw InputError(display_name(path), doing + ": " + std::strerror(errno));
}

Descriptor open_to_read(const std::string& path)
{
    Descriptor file(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.is_open()) fail(path, "cannot open");
    if (path == "-" && isatty(file.get()) != 0)
        throw InputError(display_name(path), "is a terminal: give the name of a file, or what it holds through a pipe");
    return file;
}

/// Refuses what cannot become a file of ours before all of it is read.
/// @param bytes  more than kLongestLine
/// @param most   that it may have, whatever it is
/// @return  how many bytes it may have
std::size_t most_bytes(std::string_view bytes, std::size_t most, const std::string& path)
{
    const std::string_view head = bytes.substr(0, kLongestLine + 1);
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\t'; };
    const std::size_t first = head.find_first_not_of(" \t\r\n\xef\xbb\xbf"); // after a byte order mark
    const bool is_json = first != std::string_view::npos && (head[first] == '{' || head[first] == '[') &&
                         head.find('\0') == std::string_view::npos; // the header of a binary STL may begin so
    if (is_json) return std::min(most, kMostJson);
    if (std::any_of(head.begin(), head.end(), is_control)) return most;
    throw InputError(display_name(path), "line 1: longer than " + std::to_string(kLongestLine) + " bytes");
}

/// @param size  of all of the file, or of what was read of it: `head` and more
void check_size(std::size_t size, std::size_t most, std::string_view head, const std::string& path)
{
    if (size <= most) return;
    throw InputError(display_name(path), "longer than the " + std::to_string(most >> 20) +
                                             " MiB that JSON may have; it begins " + in_quotes(head));
}

/// For what is still to be read.
void make_room(std::string& bytes, std::size_t size, const std::string& path)
{
    try {
        bytes.reserve(size);
    } catch (const std::exception&) { // of either kind, by how large it is
        throw InputError(display_name(path), "does not fit into memory: " + std::to_string(size >> 20) + " MiB");
    }
}

/// Of a regular file, what can still be read of it; 0 of another. The files of /proc say that they are regular and
/// empty.
std::size_t bytes_ahead(const Descriptor& file)
{
    struct stat status = {};
    const off_t start = lseek(file.get(), 0, SEEK_CUR);
    if (fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode) || start < 0 || status.st_size <= start) return 0;
    return static_cast<std::size_t>(status.st_size - start);
}

} // namespace

std::string display_name(const std::string& path) { return path == "-" ? "stdin" : path.empty() ? "''" : path; }

std::string read_whole(const std::string& path, std::size_t most)
{
    const Descriptor file = open_to_read(path);
    const std::size_t ahead = bytes_ahead(file);
    std::string bytes, chunk(kChunk, '\0');
    for (;;) {
        const ssize_t got = read_some(file, chunk.data(), chunk.size());
        if (got < 0) fail(path, "cannot read");
        if (got == 0) return bytes;
        const bool was_short = bytes.size() <= kLongestLine;
        bytes.append(chunk, 0, static_cast<std::size_t>(got));
        if (was_short && bytes.size() > kLongestLine) most = most_bytes(bytes, most, path);
        check_size(std::max(bytes.size(), ahead), most, bytes, path);
        make_room(bytes, ahead, path);
    }
}

InputFile::InputFile(const std::string& path) : path_(path), file_(open_to_read(path))
{
    size_ = bytes_ahead(file_);
    if (size_ == 0) {
        keep_stream();
        return;
    }
    start_ = static_cast<std::size_t>(lseek(file_.get(), 0, SEEK_CUR));
    std::string head(std::min(size_, kLongestLine + 1), '\0');
    read(0, head.data(), head.size());
    if (head.size() > kLongestLine) check_size(size_, most_bytes(head, std::string::npos, path), head, path);
}

void InputFile::keep_stream()
{
    constexpr std::size_t kSmall = 1 << 20; // held in memory
    Descriptor copy;
    std::string chunk(kChunk, '\0');
    std::string head;
    std::size_t most = std::string::npos;
    for (;;) {
        const ssize_t got = read_some(file_, chunk.data(), chunk.size());
        if (got < 0) fail(path_, "cannot read");
        if (got == 0) break;
        const bool was_short = size_ <= kLongestLine;
        size_ += static_cast<std::size_t>(got);
        held_.append(chunk.data(), static_cast<std::size_t>(got));
        if (was_short && size_ > kLongestLine) most = most_bytes(head = held_, most, path_);
        check_size(size_, most, head, path_);
        if (!copy.is_open() && held_.size() < kSmall) continue;
        const std::string scratch = scratch_path();
        if (!copy.is_open()) copy = open_unnamed(scratch);
        if (!copy.is_open() || !write_all(copy, held_)) fail(path_, "cannot copy to " + scratch);
        held_.clear();
    }
    if (copy.is_open()) file_ = std::move(copy);
}

void InputFile::read(std::size_t offset, char* to, std::size_t count) const
{
    if (!held_.empty()) {
        std::memcpy(to, held_.data() + offset, count);
        return;
    }
    for (std::size_t done = 0; done < count;) {
        const ssize_t got = pread(file_.get(), to + done, count - done, static_cast<off_t>(start_ + offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(path_, "cannot read");
        if (got == 0) throw InputError(display_name(path_), "has become shorter while it was read");
        done += static_cast<std::size_t>(got);
    }
}

bool same_file(const std::string& a, const std::string& b)
{
    if (a == "-" || b == "-") return a == b;
    std::error_code failed; // of a folder that may not be searched: then the names alone tell
    const auto whole = [&failed](const std::string& path) {
        return std::filesystem::weakly_canonical(std::filesystem::absolute(path, failed), failed);
    };
    const auto first = whole(a), second = whole(b);
    return failed ? a == b : first == second;
}

} // namespace fettle
