#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <unistd.h>

namespace fettle {

/// An empty folder, the current one while it lives; then it goes with all that is in it.
class OwnFolder {
  public:
    OwnFolder()
    {
        std::string name = std::filesystem::temp_directory_path() / "fettle_test.XXXXXX";
        if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
        folder_ = name;
        std::filesystem::current_path(folder_);
    }
    ~OwnFolder()
    {
        std::filesystem::current_path(before_);
        std::filesystem::remove_all(folder_);
    }
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;

  private:
    std::filesystem::path before_ = std::filesystem::current_path(), folder_;
};

} // namespace fettle
