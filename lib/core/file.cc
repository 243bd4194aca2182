#include "core/file.h"

#include "core/error.h"
#include "core/gzip.h"
#include "core/lines.h"
#include "core/uninitialized_vector.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <sys/resource.h>
#include <sys/stat.h>
#include <system_error>

namespace fettle::core {

namespace {

constexpr std::size_t kChunkBytes = 1 << 18; // read from a stream at once
/// Only JSON may have a longer first line, bytes. PCD and PLY have the same limit, other text formats have short lines,
/// and a binary STL has zeros among its first bytes, in its number of triangles.
constexpr std::size_t kMaxFirstLine = 1 << 16;

[[noreturn]] void fail_read(const std::string& path, const std::string& action)
{
    throw InputError(display_name(path), action + ": " + std::strerror(errno));
}

FileDescriptor open_to_read(const std::string& path)
{
    FileDescriptor file(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.is_open()) fail_read(path, "cannot open");
    if (path == "-" && isatty(file.get()) != 0)
        throw InputError(display_name(path), "is a terminal: give the name of a file, or what it holds through a pipe");
    return file;
}

/// Determines the largest permitted size from the beginning of a file, and rejects files of no known format before
/// they are read entirely.
/// @param bytes  more than kMaxFirstLine
/// @param max    largest size for any format, bytes
std::size_t max_size_of(std::string_view bytes, std::size_t max, const std::string& path)
{
    const std::string_view head = bytes.substr(0, kMaxFirstLine + 1);
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\t'; };
    const std::size_t first = head.find_first_not_of(" \t\r\n\xef\xbb\xbf"); // after a byte order mark
    const bool is_json = first != std::string_view::npos && (head[first] == '{' || head[first] == '[') &&
                         head.find('\0') == std::string_view::npos; // the text of a binary STL may begin with a brace
    if (is_json) return std::min(max, kMaxJsonBytes);
    if (head.find_first_not_of('\0') == std::string_view::npos) // an empty binary STL has 84 bytes
        throw InputError(display_name(path), "nothing but zero bytes");
    if (std::any_of(head.begin(), head.end(), is_control)) return max;
    throw InputError(display_name(path), "line 1: longer than " + std::to_string(kMaxFirstLine) + " bytes");
}

/// Largest contents that are taken from a pipe, a device or stdin, bytes: a quarter of the memory that this process may
/// have, because numbers take up to twice as much as their text, beside it. Endless input is refused there.
std::size_t max_stream_bytes()
{
    constexpr std::size_t kShare = 4;
    std::size_t memory =
        static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGE_SIZE));
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) == 0) memory = std::min<std::size_t>(memory, limit.rlim_cur);
    return memory / kShare;
}

/// @param size  of what was read of a stream so far
void check_stream_size(std::size_t size, const std::string& path)
{
    if (const std::size_t max = max_stream_bytes(); size > max)
        throw InputError(display_name(path),
                         "longer than the " + std::to_string(max >> 20) +
                             " MiB, a quarter of the memory, that are read of a stream, or decompressed");
}

/// @param size  of the file or of what was read of it so far
void check_size(std::size_t size, std::size_t max, std::string_view head, const std::string& path)
{
    if (size <= max) return;
    throw InputError(display_name(path), "longer than the " + std::to_string(max >> 20) +
                                             " MiB that JSON may have; it begins " + in_quotes(head));
}

void reserve(std::string& bytes, std::size_t size, const std::string& path)
{
    try {
        bytes.reserve(size);
    } catch (const std::exception&) { // std::bad_alloc or std::length_error
        throw InputError(display_name(path), "does not fit into memory: " + std::to_string(size >> 20) + " MiB");
    }
}

/// Bytes of a regular file from the current position on; 0 for other files, also for those of /proc, which claim to be
/// regular and empty.
std::size_t remaining_bytes(const FileDescriptor& file)
{
    struct stat status = {};
    const off_t start = lseek(file.get(), 0, SEEK_CUR);
    if (fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode) || start < 0 || status.st_size <= start) return 0;
    return static_cast<std::size_t>(status.st_size - start);
}

} // namespace

std::string display_name(const std::string& path) { return path == "-" ? "stdin" : path.empty() ? "''" : path; }

std::string read_file(const std::string& path, std::size_t max)
{
    const FileDescriptor file = open_to_read(path);
    const std::size_t expected = remaining_bytes(file);
    GzipReader reader(file, path);
    std::string bytes;
    UninitializedVector<char> chunk(kChunkBytes);
    for (;;) {
        const std::size_t got = reader.read(chunk.data(), chunk.size());
        if (got == 0) return bytes;
        const bool was_short = bytes.size() <= kMaxFirstLine;
        bytes.append(chunk.data(), got);
        if (was_short && bytes.size() > kMaxFirstLine) max = max_size_of(bytes, max, path);
        check_size(std::max(bytes.size(), expected), max, bytes, path);
        if (expected == 0 || reader.is_compressed()) check_stream_size(bytes.size(), path);
        reserve(bytes, expected, path);
    }
}

InputFile::InputFile(const std::string& path) : path_(path), file_(open_to_read(path))
{
    size_ = remaining_bytes(file_);
    if (size_ == 0) {
        copy_stream();
        return;
    }
    start_ = static_cast<std::size_t>(lseek(file_.get(), 0, SEEK_CUR));
    std::string head(std::min(size_, kMaxFirstLine + 1), '\0');
    read(0, head.data(), head.size());
    if (looks_like_gzip(head)) {
        start_ = size_ = 0;
        copy_stream();
        return;
    }
    if (head.size() > kMaxFirstLine) check_size(size_, max_size_of(head, std::string::npos, path), head, path);
}

void InputFile::copy_stream()
{
    constexpr std::size_t kMaxMemoryBytes = 1 << 20;
    FileDescriptor copy;
    UninitializedVector<char> chunk(kChunkBytes);
    std::string head;
    std::size_t max = std::string::npos;
    GzipReader reader(file_, path_);
    for (;;) {
        const std::size_t got = reader.read(chunk.data(), chunk.size());
        if (got == 0) break;
        const bool was_short = size_ <= kMaxFirstLine;
        size_ += got;
        memory_.append(chunk.data(), got);
        if (was_short && size_ > kMaxFirstLine) max = max_size_of(head = memory_, max, path_);
        check_size(size_, max, head, path_);
        check_stream_size(size_, path_);
        if (!copy.is_open() && memory_.size() < kMaxMemoryBytes) continue;
        const std::string scratch = scratch_path();
        if (!copy.is_open()) copy = open_unnamed(scratch);
        if (!copy.is_open() || !write_all(copy, memory_)) fail_read(path_, "cannot copy to " + scratch);
        memory_.clear();
    }
    if (copy.is_open()) file_ = std::move(copy);
}

void InputFile::read(std::size_t offset, char* to, std::size_t count) const
{
    if (!memory_.empty()) {
        std::memcpy(to, memory_.data() + offset, count);
        return;
    }
    for (std::size_t done = 0; done < count;) {
        const ssize_t got = pread(file_.get(), to + done, count - done, static_cast<off_t>(start_ + offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail_read(path_, "cannot read");
        if (got == 0) throw InputError(display_name(path_), "has become shorter while it was read");
        done += got;
    }
}

std::string InputFile::read_all() const
{
    std::string bytes(size_, '\0');
    read(0, bytes.data(), bytes.size());
    return bytes;
}

bool same_file(const std::string& a, const std::string& b)
{
    if (a == "-" || b == "-") return a == b;
    std::error_code failed; // for a folder that may not be searched; then the names are compared
    const auto canonical = [&failed](const std::string& path) {
        return std::filesystem::weakly_canonical(std::filesystem::absolute(path, failed), failed);
    };
    const auto first = canonical(a), second = canonical(b);
    return failed ? a == b : first == second;
}

} // namespace fettle::core
