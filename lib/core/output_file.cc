#include "core/error.h"
#include "core/file.h"

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

namespace fettle {

namespace {

[[noreturn]] void fail(const std::string& name, int reason = errno, const std::string& doing = "cannot write")
{
    throw InputError(name, doing + ": " + std::strerror(reason));
}

/// Bytes that are held, and go to an unnamed file where `place` is once they are many.
class Held : public std::streambuf {
  public:
    explicit Held(std::string name) : name_(std::move(name)), room_(kRoom) { setp(room_.data(), end()); }

    /// To keep them at `place`. @throws InputError if nothing can be written there
    void keep_at(const std::string& place)
    {
        file_ = open_unnamed(place);
        if (!file_.is_open()) fail(name_, errno, doing_);
    }

    /// All that was written to the unnamed file, if there is one.
    const Descriptor& spill()
    {
        if (!write_all(file_, held())) fail(name_, errno, doing_);
        setp(room_.data(), end());
        return file_;
    }

    bool is_spilled() const { return file_.is_open(); }
    std::string_view held() const { return {pbase(), static_cast<std::size_t>(pptr() - pbase())}; }

  protected:
    int_type overflow(int_type c) override
    {
        if (!is_spilled()) {
            doing_ = "cannot copy to " + scratch_path();
            keep_at(scratch_path());
        }
        const off_t from = lseek(file_.get(), 0, SEEK_CUR);
        spill();
        // What goes to the disk already, commit() need not wait for.
        sync_file_range(file_.get(), from, static_cast<off_t>(kRoom), SYNC_FILE_RANGE_WRITE);
        return traits_type::eq_int_type(c, traits_type::eof()) ? traits_type::not_eof(c)
                                                               : sputc(traits_type::to_char_type(c));
    }

  private:
    static constexpr std::size_t kRoom = 1 << 20; // what goes through a pipe is mostly smaller

    char* end() { return room_.data() + room_.size(); }

    std::string name_;
    std::string doing_ = "cannot write"; ///< what fails, for messages
    std::vector<char> room_;
    Descriptor file_;
};

bool copy_all(const Descriptor& from, const Descriptor& to)
{
    std::vector<char> chunk(1 << 18);
    if (lseek(from.get(), 0, SEEK_SET) != 0) return false;
    for (;;) {
        const ssize_t got = read_some(from, chunk.data(), chunk.size());
        if (got <= 0) return got == 0;
        if (!write_all(to, {chunk.data(), static_cast<std::size_t>(got)})) return false;
    }
}

bool copy_to(const std::string& path, const Descriptor& file)
{
    Descriptor copy(open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666));
    return copy.is_open() && copy_all(file, copy) && fsync(copy.get()) == 0 && copy.close();
}

std::atomic<const char*> working_file = nullptr;

extern "C" void remove_working_file(int signal)
{
    if (const char* const name = working_file.load()) unlink(name);
    std::signal(signal, SIG_DFL);
    raise(signal); // once the handler has returned
}

/// While it stands, a signal that ends the program removes a working file first; whoever is ignored stays so.
class WorkingFile {
  public:
    explicit WorkingFile(const std::string& name)
    {
        working_file = name.c_str();
        struct sigaction handler = {};
        handler.sa_handler = remove_working_file;
        for (std::size_t i = 0; i < before_.size(); ++i)
            if (sigaction(kEnding[i], nullptr, &before_[i]) == 0 && before_[i].sa_handler == SIG_DFL)
                sigaction(kEnding[i], &handler, nullptr);
    }
    WorkingFile(const WorkingFile&) = delete;
    WorkingFile& operator=(const WorkingFile&) = delete;
    ~WorkingFile()
    {
        for (std::size_t i = 0; i < before_.size(); ++i) sigaction(kEnding[i], &before_[i], nullptr);
        working_file = nullptr;
    }

  private:
    static constexpr std::array kEnding = {SIGHUP, SIGINT, SIGTERM};
    std::array<struct sigaction, kEnding.size()> before_ = {};
};

/// Gives the unnamed file the name `target`, whose permissions it takes over.
/// @return  false, and errno, if it cannot be done
bool publish(const Descriptor& file, const std::string& target)
{
    struct stat status = {};
    const bool exists = stat(target.c_str(), &status) == 0;
    const std::string here = "/proc/self/fd/" + std::to_string(file.get()), name = working_name(target);
    unlink(name.c_str()); // of a program that had the same number and was killed
    const WorkingFile removed_if_ended(name);
    // Where unnamed files cannot be given a name, a copy can.
    const bool named =
        linkat(AT_FDCWD, here.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0 || copy_to(name, file);
    if (named && (!exists || chmod(name.c_str(), status.st_mode & 07777) == 0) &&
        rename(name.c_str(), target.c_str()) == 0)
        return true;
    const int reason = errno;
    unlink(name.c_str());
    errno = reason;
    return false;
}

} // namespace

std::string link_target(const std::string& path)
{
    std::error_code unresolved;
    std::string target = std::filesystem::canonical(path, unresolved).string();
    if (unresolved) fail(display_name(path), unresolved.value());
    return target;
}

struct OutputFile::State {
    explicit State(const std::string& path) : name(path == "-" ? "stdout" : display_name(path)) {}

    std::string name;   ///< for messages
    std::string target; ///< what is replaced, links followed; empty if `file` is written directly
    Descriptor file;    ///< stdout, or a target that is no regular file
    Held held{name};
    std::ostream stream{&held};
};

OutputFile::OutputFile(const std::string& path) : state_(std::make_unique<State>(path))
{
    State& s = *state_;
    s.stream.exceptions(std::ios::badbit); // what Held throws comes through
    if (path.empty()) fail(s.name, ENOENT);
    struct stat status = {};
    const bool exists = path != "-" && stat(path.c_str(), &status) == 0;
    if (path == "-" || (exists && !S_ISREG(status.st_mode))) {
        s.file = Descriptor(path == "-" ? dup(STDOUT_FILENO) : open(path.c_str(), O_WRONLY | O_CLOEXEC));
        if (!s.file.is_open()) fail(s.name);
        return;
    }
    s.target = exists ? link_target(path) : path;
    s.held.keep_at(s.target);
}

OutputFile::~OutputFile() = default;

std::ostream& OutputFile::stream() { return state_->stream; }

void OutputFile::settle()
{
    State& s = *state_;
    if (!s.target.empty() && fsync(s.held.spill().get()) != 0) fail(s.name);
}

void OutputFile::commit()
{
    State& s = *state_;
    settle();
    bool written = true;
    if (!s.target.empty())
        written = publish(s.held.spill(), s.target);
    else if (isatty(s.file.get()) != 0 && (s.held.is_spilled() || s.held.held().find('\0') != std::string_view::npos))
        throw InputError(s.name, "is a terminal, and what goes there is binary: -o FILE, or a pipe");
    else if (s.held.is_spilled())
        written = copy_all(s.held.spill(), s.file) && s.file.close();
    else
        written = write_all(s.file, s.held.held()) && s.file.close();
    if (!written) fail(s.name);
}

} // namespace fettle
