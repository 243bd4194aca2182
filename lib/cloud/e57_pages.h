#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fettle::cloud {

/// The contents of an E57 file without the checksums that end each page of 1024 bytes. Places in the file are given as
/// physical offsets, which count the checksums, lengths as logical ones, which do not.
class E57Pages {
  public:
    /// @throws InputError for a wrong header, a wrong size or a wrong checksum
    E57Pages(std::string_view bytes, const std::string& source);

    /// Bytes from a physical offset on. @throws InputError if the file ends before
    std::string_view at(std::uint64_t physical_offset, std::uint64_t length, const std::string& what) const;
    /// All bytes from a physical offset on. @throws InputError if it lies outside
    std::string_view from(std::uint64_t physical_offset, const std::string& what) const;

    std::string_view xml() const { return xml_; }

  private:
    std::string contents_;
    const std::string& source_;
    std::string_view xml_;
};

} // namespace fettle::cloud
