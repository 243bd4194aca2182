#include "core/error.h"
#include "core/file.h"
#include "core/uninitialized_vector.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <ostream>
#include <streambuf>
#include <sys/stat.h>
#include <system_error>
#include <vector>

namespace fettle::core {

namespace {

[[noreturn]] void fail_write(const std::string& name, int reason = errno, const std::string& action = "cannot write")
{
    throw InputError(name, action + ": " + std::strerror(reason));
}

/// Stream buffer that spills to an unnamed file when it is full.
class SpillBuffer : public std::streambuf {
  public:
    explicit SpillBuffer(std::string name) : name_(std::move(name)), buffer_(kBufferBytes)
    {
        setp(buffer_.data(), end());
    }

    /// Creates the unnamed file on the file system of `path`. @throws InputError if that fails
    void create_file(const std::string& path)
    {
        file_ = open_unnamed(path);
        if (!file_.is_open()) fail_write(name_, errno, action_);
    }

    /// Writes the buffered bytes to the unnamed file. @return  the file, which then has all bytes
    const FileDescriptor& spill()
    {
        if (!write_all(file_, buffered())) fail_write(name_, errno, action_);
        setp(buffer_.data(), end());
        return file_;
    }

    bool has_file() const { return file_.is_open(); }
    std::string_view buffered() const { return {pbase(), static_cast<std::size_t>(pptr() - pbase())}; }

  protected:
    int_type overflow(int_type c) override
    {
        if (!has_file()) {
            action_ = "cannot copy to " + scratch_path();
            create_file(scratch_path());
        }
        const off_t from = lseek(file_.get(), 0, SEEK_CUR);
        spill();
        // Starts writing to the disk now, so that commit() waits less.
        sync_file_range(file_.get(), from, kBufferBytes, SYNC_FILE_RANGE_WRITE);
        return traits_type::eq_int_type(c, traits_type::eof()) ? traits_type::not_eof(c)
                                                               : sputc(traits_type::to_char_type(c));
    }

  private:
    static constexpr std::size_t kBufferBytes = 1 << 20; // most data sent through pipes is smaller

    char* end() { return buffer_.data() + buffer_.size(); }

    std::string name_;
    std::string action_ = "cannot write"; ///< what has failed, for messages
    UninitializedVector<char> buffer_;    ///< to set it would take up to a third of a tool's start
    FileDescriptor file_;
};

bool copy_all(const FileDescriptor& from, const FileDescriptor& to)
{
    std::vector<char> chunk(1 << 18);
    if (lseek(from.get(), 0, SEEK_SET) != 0) return false;
    for (;;) {
        const ssize_t got = read_some(from, chunk.data(), chunk.size());
        if (got <= 0) return got == 0;
        if (!write_all(to, std::string_view(chunk.data(), got))) return false;
    }
}

bool copy_to(const std::string& path, const FileDescriptor& file)
{
    FileDescriptor copy(open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666));
    return copy.is_open() && copy_all(file, copy) && fsync(copy.get()) == 0 && copy.close();
}

constexpr std::array kEndingSignals = {SIGHUP, SIGINT, SIGTERM};
std::atomic<const char*> temporary_file = nullptr;
/// What `kEndingSignals` did before there was a temporary file.
std::array<struct sigaction, kEndingSignals.size()> previous_actions = {};

/// Removes the temporary file and ends the program; or does what the program itself does about its first such signal.
extern "C" void remove_temporary_file(int signal)
{
    for (std::size_t i = 0; i < kEndingSignals.size(); ++i) {
        struct sigaction& previous = previous_actions[i];
        if (kEndingSignals[i] != signal || previous.sa_handler == SIG_DFL) continue;
        const auto own_handler = previous.sa_handler;
        if ((previous.sa_flags & int(SA_RESETHAND)) != 0) previous.sa_handler = SIG_DFL;
        own_handler(signal);
        return;
    }
    if (const char* const name = temporary_file.load()) unlink(name);
    std::signal(signal, SIG_DFL);
    raise(signal); // takes effect when the handler has returned
}

/// While it exists, a signal that terminates the program removes a temporary file first. Ignored signals stay ignored,
/// and handlers of the program are called as ever.
class RemoveOnSignal {
  public:
    explicit RemoveOnSignal(const std::string& name)
    {
        temporary_file = name.c_str();
        for (std::size_t i = 0; i < kEndingSignals.size(); ++i) {
            struct sigaction& previous = previous_actions[i];
            sigaction(kEndingSignals[i], nullptr, &previous);
            struct sigaction action = previous;
            action.sa_handler = remove_temporary_file;
            action.sa_flags &= ~int(SA_RESETHAND);
            if (previous.sa_handler != SIG_IGN) sigaction(kEndingSignals[i], &action, nullptr);
        }
    }
    RemoveOnSignal(const RemoveOnSignal&) = delete;
    RemoveOnSignal& operator=(const RemoveOnSignal&) = delete;
    ~RemoveOnSignal()
    {
        for (std::size_t i = 0; i < kEndingSignals.size(); ++i)
            sigaction(kEndingSignals[i], &previous_actions[i], nullptr);
        temporary_file = nullptr;
    }
};

/// Gives the unnamed file the name `target` and the permissions of the file that it replaces.
/// @return  false and errno if that fails
bool publish(const FileDescriptor& file, const std::string& target)
{
    struct stat status = {};
    const bool exists = stat(target.c_str(), &status) == 0;
    const std::string unnamed = "/proc/self/fd/" + std::to_string(file.get()), name = temporary_name(target);
    unlink(name.c_str()); // left by a killed program with the same process id
    const RemoveOnSignal remove_on_signal(name);
    // If the file system cannot name an unnamed file, a copy gets the name.
    const bool named =
        linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0 || copy_to(name, file);
    if (named && (!exists || chmod(name.c_str(), status.st_mode & 07777) == 0) &&
        rename(name.c_str(), target.c_str()) == 0)
        return true;
    const int reason = errno;
    unlink(name.c_str());
    errno = reason;
    return false;
}

} // namespace

std::string resolve_links(const std::string& path)
{
    std::error_code unresolved;
    std::string target = std::filesystem::canonical(path, unresolved).string();
    if (unresolved) fail_write(display_name(path), unresolved.value());
    return target;
}

struct OutputFile::State {
    explicit State(const std::string& path) : name(path == "-" ? "stdout" : display_name(path)) {}

    std::string name;    ///< for messages
    std::string target;  ///< file to replace, links resolved; empty if `file` is written directly
    FileDescriptor file; ///< stdout, or a target that is not a regular file
    SpillBuffer buffer{name};
    std::ostream stream{&buffer};
};

OutputFile::OutputFile(const std::string& path) : state_(std::make_unique<State>(path))
{
    State& s = *state_;
    s.stream.exceptions(std::ios::badbit); // passes on what SpillBuffer throws
    if (path.empty()) fail_write(s.name, ENOENT);
    struct stat status = {};
    const bool exists = path != "-" && stat(path.c_str(), &status) == 0;
    if (path == "-" || (exists && !S_ISREG(status.st_mode))) {
        s.file = FileDescriptor(path == "-" ? dup(STDOUT_FILENO) : open(path.c_str(), O_WRONLY | O_CLOEXEC));
        if (!s.file.is_open()) fail_write(s.name);
        return;
    }
    s.target = exists ? resolve_links(path) : path;
    s.buffer.create_file(s.target);
}

OutputFile::~OutputFile() = default;

std::ostream& OutputFile::stream() { return state_->stream; }

void OutputFile::sync()
{
    State& s = *state_;
    if (!s.target.empty() && fsync(s.buffer.spill().get()) != 0) fail_write(s.name);
}

void OutputFile::commit()
{
    State& s = *state_;
    sync();
    const bool is_spilled = s.buffer.has_file();
    const std::string_view bytes = s.buffer.buffered();
    bool written = true;
    if (!s.target.empty())
        written = publish(s.buffer.spill(), s.target);
    else if (isatty(s.file.get()) != 0 && (is_spilled || bytes.find('\0') != std::string_view::npos))
        throw InputError(s.name, "is a terminal, and what goes there is binary: -o FILE, or a pipe");
    else if (is_spilled)
        written = copy_all(s.buffer.spill(), s.file) && s.file.close();
    else
        written = write_all(s.file, bytes) && s.file.close();
    if (!written) fail_write(s.name);
}

} // namespace fettle::core
