#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace fettle::core {

/// A ZIP archive in memory, read by minizip.
class ZipArchive {
  public:
    /// @param source  of the archive, for messages; both must outlive it   @throws InputError if it is none
    ZipArchive(std::string_view bytes, const std::string& source);
    ~ZipArchive();

    /// True if a file of this name is in it; case counts.
    bool has(const std::string& name) const;
    /// Decompresses a file of the archive, in pieces.
    /// @param use  receives the pieces in their order; it returns false to stop
    /// @throws InputError if there is no such file, or it is damaged or encrypted
    void read(const std::string& name, const std::function<bool(std::string_view)>& use) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// True if the bytes begin as a ZIP archive does.
bool looks_like_zip(std::string_view bytes);

} // namespace fettle::core
