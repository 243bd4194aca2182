#include "core/file.h"

#include "core/error.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ext/stdio_filebuf.h>
#include <fcntl.h>
#include <iostream>
#include <sstream>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>

namespace fettle {

namespace {

/// Of an output that is held back, bytes: up to there it is not copied while it grows. Untouched it costs nothing.
constexpr std::size_t kRoom = 1 << 24;

[[noreturn]] void fail(const std::string& path, const std::string& doing)
{
    throw InputError(display_name(path), doing + ": " + std::strerror(errno));
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
            errno = reason;
            fail(path, "cannot read");
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
    std::string path;      ///< as the user gave it
    std::string temporary; ///< what is written; empty if the target is written directly
    std::unique_ptr<__gnu_cxx::stdio_filebuf<char>> buffer;
    std::unique_ptr<std::ostream> stream;
    std::ostringstream
        held; ///< for stdout and what is written directly: nothing goes out before the work has succeeded
};

OutputFile::OutputFile(const std::string& path) : state_(std::make_unique<State>())
{
    State& s = *state_;
    s.path = path == "-" ? "stdout" : display_name(path);
    int file = -1;
    struct stat status = {};
    if (path.empty()) {
        errno = ENOENT;
    } else if (path == "-") {
        file = dup(STDOUT_FILENO);
    } else if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
        file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        s.temporary = path + ".XXXXXX";
        file = mkostemp(s.temporary.data(), O_CLOEXEC);
        if (file < 0) s.temporary.clear();
        const mode_t mask = umask(0);
        umask(mask);
        if (file >= 0) fchmod(file, status.st_mode != 0 ? status.st_mode & 07777 : 0666 & ~mask);
    }
    if (file < 0) fail(s.path, "cannot write");
    constexpr std::size_t kBuffer = 1 << 16;
    if (s.temporary.empty()) {
        std::string room;
        room.reserve(kRoom);
        s.held = std::ostringstream(std::move(room));
    }
    s.buffer = std::make_unique<__gnu_cxx::stdio_filebuf<char>>(file, std::ios::out | std::ios::binary, kBuffer);
    s.stream = std::make_unique<std::ostream>(s.buffer.get());
}

OutputFile::~OutputFile()
{
    if (!state_) return;
    state_->buffer.reset();
    if (!state_->temporary.empty()) unlink(state_->temporary.c_str());
}

std::ostream& OutputFile::stream()
{
    if (state_->temporary.empty()) return state_->held;
    return *state_->stream;
}

void OutputFile::commit()
{
    State& s = *state_;
    errno = 0;
    const std::string_view held = s.held.view();
    s.stream->write(held.data(), static_cast<std::streamsize>(held.size()));
    s.stream->flush();
    const bool written = s.stream->good();
    if (!written && errno == 0) errno = EIO;
    if (!written) fail(s.path, "cannot write");
    if (!s.temporary.empty() && fsync(s.buffer->fd()) != 0) fail(s.path, "cannot write");
    if (!s.buffer->close()) fail(s.path, "cannot write");
    if (s.temporary.empty()) return;
    if (rename(s.temporary.c_str(), s.path.c_str()) != 0) fail(s.path, "cannot write");
    s.temporary.clear();
}

} // namespace fettle
