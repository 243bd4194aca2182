#include "core/file.h"

#include "core/error.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace fettle {

namespace {

/// Of an output, bytes: up to there it is not copied while it grows. Untouched it costs nothing.
constexpr std::size_t kRoom = 1 << 24;

[[noreturn]] void fail(const std::string& path, const std::string& doing, int reason = errno)
{
    throw InputError(display_name(path), doing + ": " + std::strerror(reason));
}

} // namespace

std::string display_name(const std::string& path) { return path == "-" ? "stdin" : path.empty() ? "''" : path; }

std::string read_whole(const std::string& path)
{
    const int file = path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) fail(path, "cannot open");
    struct stat status = {};
    std::string bytes;
    // One byte more than the size: the read that finds the end then needs no room of its own.
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode))
        bytes.reserve(static_cast<std::size_t>(status.st_size) + 1);
    constexpr std::size_t kChunk = 1 << 18;
    for (std::size_t size = 0;;) {
        bytes.resize(std::max(bytes.capacity(), size + kChunk));
        const ssize_t got = read(file, bytes.data() + size, bytes.size() - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            const int reason = errno;
            close(file);
            fail(path, "cannot read", reason);
        }
        size += static_cast<std::size_t>(got);
        if (got == 0) {
            bytes.resize(size);
            break;
        }
    }
    close(file);
    return bytes;
}

InputFile::InputFile(const std::string& path)
    : path_(path), file_(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC))
{
    if (file_ < 0) fail(path_, "cannot open");
    try {
        struct stat status = {};
        const off_t start = lseek(file_, 0, SEEK_CUR);
        // The files of /proc say that they are regular and empty.
        if (fstat(file_, &status) == 0 && S_ISREG(status.st_mode) && start >= 0 && status.st_size > start) {
            start_ = static_cast<std::size_t>(start);
            size_ = static_cast<std::size_t>(status.st_size - start);
        } else {
            keep_stream();
        }
    } catch (...) {
        close(file_);
        throw;
    }
}

InputFile::~InputFile() { close(file_); }

void InputFile::keep_stream()
{
    constexpr std::size_t kSmall = 1 << 20; // held in memory
    constexpr std::size_t kChunk = 1 << 18;
    const char* folder = std::getenv("TMPDIR");
    std::string name = std::string(folder != nullptr && *folder != '\0' ? folder : "/tmp") + "/fettle.XXXXXX";
    int copy = -1;
    std::string chunk(kChunk, '\0');
    for (;;) {
        const ssize_t got = ::read(file_, chunk.data(), chunk.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            const int reason = errno;
            if (copy >= 0) close(copy);
            errno = reason;
            fail(path_, "cannot read");
        }
        if (got == 0) break;
        size_ += static_cast<std::size_t>(got);
        held_.append(chunk.data(), static_cast<std::size_t>(got));
        if (copy < 0 && held_.size() < kSmall) continue;
        if (copy < 0) {
            copy = mkostemp(name.data(), O_CLOEXEC);
            if (copy < 0) fail(path_, "cannot copy to " + name);
            unlink(name.c_str());
        }
        for (std::size_t done = 0; done < held_.size();) {
            const ssize_t put = write(copy, held_.data() + done, held_.size() - done);
            if (put < 0 && errno != EINTR) {
                const int reason = errno;
                close(copy);
                errno = reason;
                fail(path_, "cannot copy to " + name);
            }
            done += static_cast<std::size_t>(std::max<ssize_t>(put, 0));
        }
        held_.clear();
    }
    if (copy < 0) return;
    close(file_);
    file_ = copy;
}

void InputFile::read(std::size_t offset, char* to, std::size_t count) const
{
    if (!held_.empty()) {
        std::memcpy(to, held_.data() + offset, count);
        return;
    }
    for (std::size_t done = 0; done < count;) {
        const ssize_t got = pread(file_, to + done, count - done, static_cast<off_t>(start_ + offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(path_, "cannot read");
        if (got == 0) throw InputError(display_name(path_), "has become shorter while it was read");
        done += static_cast<std::size_t>(got);
    }
}

struct OutputFile::State {
    std::string path;        ///< for messages
    std::string target;      ///< what is replaced, links followed; empty if `file` is written directly
    int file = -1;           ///< stdout, or a target that is no regular file
    std::ostringstream held; ///< nothing may go out before the work has succeeded
};

namespace {

// An empty file beside `target`, whose name it is to get. @return its descriptor, -1 if it cannot be made
int make_temporary(const std::string& target, std::string& name)
{
    name = target + ".XXXXXX";
    const int file = mkostemp(name.data(), O_CLOEXEC);
    if (file < 0) return file;
    struct stat status = {};
    const mode_t mask = umask(0);
    umask(mask);
    fchmod(file, stat(target.c_str(), &status) == 0 ? status.st_mode & 07777 : 0666 & ~mask);
    return file;
}

// @return  false, and errno, if something could not be written
bool write_all(int file, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t written = write(file, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) return false;
        if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

bool replace(const std::string& target, std::string_view bytes)
{
    std::string temporary;
    const int file = make_temporary(target, temporary);
    if (file < 0) return false;
    int reason = write_all(file, bytes) && fsync(file) == 0 ? 0 : errno;
    if (close(file) != 0 && reason == 0) reason = errno;
    if (reason == 0 && rename(temporary.c_str(), target.c_str()) != 0) reason = errno;
    if (reason == 0) return true;
    unlink(temporary.c_str());
    errno = reason;
    return false;
}

} // namespace

// Made and removed at once: a wrong name shows before the work, and a run that is stopped leaves nothing.
OutputFile::OutputFile(const std::string& path) : state_(std::make_unique<State>())
{
    State& s = *state_;
    s.path = path == "-" ? "stdout" : display_name(path);
    std::string room;
    room.reserve(kRoom);
    s.held = std::ostringstream(std::move(room));
    struct stat status = {};
    std::error_code unresolved;
    if (path.empty()) fail(s.path, "cannot write", ENOENT);
    const bool exists = path != "-" && stat(path.c_str(), &status) == 0;
    if (path == "-" || (exists && !S_ISREG(status.st_mode))) {
        s.file = path == "-" ? dup(STDOUT_FILENO) : open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (s.file < 0) fail(s.path, "cannot write");
        return;
    }
    s.target = exists ? std::filesystem::canonical(path, unresolved).string() : path;
    if (unresolved) fail(s.path, "cannot write", unresolved.value());
    std::string temporary;
    const int tried = make_temporary(s.target, temporary);
    if (tried < 0) fail(s.path, "cannot write");
    close(tried);
    unlink(temporary.c_str());
}

OutputFile::~OutputFile()
{
    if (state_ && state_->file >= 0) close(state_->file);
}

std::ostream& OutputFile::stream() { return state_->held; }

void OutputFile::commit()
{
    State& s = *state_;
    const std::string_view bytes = s.held.view();
    const bool written =
        s.target.empty() ? write_all(s.file, bytes) && close(std::exchange(s.file, -1)) == 0 : replace(s.target, bytes);
    if (!written) fail(s.path, "cannot write");
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
