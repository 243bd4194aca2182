#include "core/descriptor.h"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>

namespace fettle::core {

ssize_t read_some(const FileDescriptor& file, char* to, std::size_t count)
{
    for (;;) {
        const ssize_t got = read(file.get(), to, count);
        if (got >= 0 || errno != EINTR) return got;
    }
}

bool write_all(const FileDescriptor& file, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t written = write(file.get(), bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) return false;
        if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

std::string temporary_name(const std::string& path)
{
    const std::filesystem::path target(path);
    return target.parent_path() / (".fettle-" + std::to_string(getpid()) + "-" + target.filename().string());
}

FileDescriptor open_unnamed(const std::string& path)
{
    constexpr mode_t kMode = 0666; // before umask
    const std::string folder = std::filesystem::path(path).parent_path();
    FileDescriptor file(open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode));
    if (file.is_open()) return file;
    // Some file systems lack O_TMPFILE.
    const std::string name = temporary_name(path);
    file = FileDescriptor(open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kMode));
    if (file.is_open()) unlink(name.c_str());
    return file;
}

std::string scratch_path()
{
    const char* folder = std::getenv("TMPDIR");
    return std::string(folder != nullptr && *folder != '\0' ? folder : "/tmp") + "/scratch";
}

} // namespace fettle::core
