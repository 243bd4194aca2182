#include "station/folder.h"

#include "core/error.h"
#include "core/file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>

namespace fettle::station {

Folder::Folder(const std::string& path) : path_(path)
{
    const auto check = [&](bool done) {
        if (!done) throw core::InputError(path, std::string("no folder for a session: ") + std::strerror(errno));
    };
    check(::mkdir(path.c_str(), 0777) == 0 || errno == EEXIST);
    lock_ = core::FileDescriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    check(lock_.is_open());
    if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) throw core::InputError(path, "another session is using it");
}

bool Folder::has(const std::string& name) const { return std::filesystem::exists(file(name)); }

void Folder::save(const std::string& name, const std::function<void(std::ostream&)>& write) const
{
    core::OutputFile out(file(name));
    write(out.stream());
    out.commit();
    ::fsync(lock_.get()); // the name, too
}

void Folder::remove(const std::string& name) const { std::filesystem::remove(file(name)); }

} // namespace fettle::station
