#pragma once

#include "core/descriptor.h"

#include <functional>
#include <iosfwd>
#include <string>

namespace fettle::station {

/// The folder of a session: one session at a time uses it. Its files are written atomically and are on the disk when
/// save() returns, so that they outlive a power failure.
class Folder {
  public:
    /// Makes the folder if there is none.
    /// @throws InputError if that fails, or if another session uses it
    explicit Folder(const std::string& path);

    std::string file(const std::string& name) const { return path_ + "/" + name; }
    bool has(const std::string& name) const;
    /// @throws InputError if it cannot be written
    void save(const std::string& name, const std::function<void(std::ostream&)>& write) const;
    void remove(const std::string& name) const;

  private:
    std::string path_;
    core::FileDescriptor lock_;
};

} // namespace fettle::station
