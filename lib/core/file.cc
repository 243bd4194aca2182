#include "core/file.h"

#include "core/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
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
void check_first_line(std::string_view bytes, const std::string& path)
{
    const std::string_view head = bytes.substr(0, kLongestLine + 1);
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\t'; };
    const std::size_t first = head.find_first_not_of(" \t\xef\xbb\xbf"); // after a byte order mark
    const bool is_json = first != std::string_view::npos && (head[first] == '{' || head[first] == '[');
    if (is_json || std::any_of(head.begin(), head.end(), is_control)) return;
    throw InputError(display_name(path), "line 1: longer than " + std::to_string(kLongestLine) + " bytes");
}

} // namespace

std::string display_name(const std::string& path) { return path == "-" ? "stdin" : path.empty() ? "''" : path; }

std::string read_whole(const std::string& path)
{
    const Descriptor file = open_to_read(path);
    struct stat status = {};
    std::string bytes, chunk(kChunk, '\0');
    if (fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode))
        bytes.reserve(static_cast<std::size_t>(status.st_size));
    for (;;) {
        const ssize_t got = read_some(file, chunk.data(), chunk.size());
        if (got < 0) fail(path, "cannot read");
        if (got == 0) return bytes;
        const bool was_short = bytes.size() <= kLongestLine;
        bytes.append(chunk, 0, static_cast<std::size_t>(got));
        if (was_short && bytes.size() > kLongestLine) check_first_line(bytes, path);
    }
}

InputFile::InputFile(const std::string& path) : path_(path), file_(open_to_read(path))
{
    struct stat status = {};
    const off_t start = lseek(file_.get(), 0, SEEK_CUR);
    // The files of /proc say that they are regular and empty.
    if (fstat(file_.get(), &status) == 0 && S_ISREG(status.st_mode) && start >= 0 && status.st_size > start) {
        start_ = static_cast<std::size_t>(start);
        size_ = static_cast<std::size_t>(status.st_size - start);
        std::string head(std::min(size_, kLongestLine + 1), '\0');
        read(0, head.data(), head.size());
        if (head.size() > kLongestLine) check_first_line(head, path);
    } else {
        keep_stream();
    }
}

void InputFile::keep_stream()
{
    constexpr std::size_t kSmall = 1 << 20; // held in memory
    Descriptor copy;
    std::string chunk(kChunk, '\0');
    for (;;) {
        const ssize_t got = read_some(file_, chunk.data(), chunk.size());
        if (got < 0) fail(path_, "cannot read");
        if (got == 0) break;
        const bool was_short = size_ <= kLongestLine;
        size_ += static_cast<std::size_t>(got);
        held_.append(chunk.data(), static_cast<std::size_t>(got));
        if (was_short && size_ > kLongestLine) check_first_line(held_, path_);
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
