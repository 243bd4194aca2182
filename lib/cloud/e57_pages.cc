#include "cloud/e57_pages.h"

#include "cloud/element.h"
#include "core/error.h"

#include <boost/crc.hpp>

namespace fettle::cloud {
namespace {

constexpr std::size_t kPageBytes = 1024, kChecksumBytes = 4, kContentBytes = kPageBytes - kChecksumBytes;
constexpr std::size_t kHeaderBytes = 48;
// Offsets in the header (ASTM E2807-11, table 5).
constexpr std::size_t kMajorVersion = 8, kFileLength = 16, kXmlOffset = 24, kXmlLength = 32, kPageSize = 40;

/// CRC-32C of a page's contents (Castagnoli's polynomial, reflected).
std::uint32_t checksum_of(std::string_view contents)
{
    boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
    crc.process_bytes(contents.data(), contents.size());
    return crc.checksum();
}

/// Unlike all other numbers of the file the checksums are big-endian.
std::uint32_t load_big_endian(const char* bytes)
{
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < kChecksumBytes; ++k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
    return value;
}

} // namespace

E57Pages::E57Pages(std::string_view bytes, const std::string& source) : source_(source)
{
    if (bytes.size() < kHeaderBytes)
        throw core::InputError(source, "E57 of " + std::to_string(bytes.size()) + " bytes, its header has 48");
    const auto header = [&](std::size_t offset) { return load<std::uint64_t>(bytes.data() + offset); };
    const auto major = load<std::uint32_t>(bytes.data() + kMajorVersion);
    if (major != 1) throw core::InputError(source, "E57 of version " + std::to_string(major) + ", 1 is read");
    if (header(kPageSize) != kPageBytes)
        throw core::InputError(source, "E57 with pages of " + std::to_string(header(kPageSize)) + " bytes, not 1024");
    if (header(kFileLength) != bytes.size() || bytes.size() % kPageBytes != 0)
        throw core::InputError(source, "E57 of " + std::to_string(header(kFileLength)) + " bytes by its header, has " +
                                           std::to_string(bytes.size()));
    contents_.reserve(bytes.size() / kPageBytes * kContentBytes);
    for (std::size_t begin = 0; begin < bytes.size(); begin += kPageBytes) {
        const std::string_view contents = bytes.substr(begin, kContentBytes);
        if (checksum_of(contents) != load_big_endian(bytes.data() + begin + kContentBytes))
            throw core::InputError(source, "E57: wrong checksum of page " + std::to_string(begin / kPageBytes) +
                                               ": the file is damaged");
        contents_ += contents;
    }
    xml_ = at(header(kXmlOffset), header(kXmlLength), "XML section");
}

std::string_view E57Pages::from(std::uint64_t physical_offset, const std::string& what) const
{
    const std::uint64_t page = physical_offset / kPageBytes, in_page = physical_offset % kPageBytes;
    if (page >= contents_.size() / kContentBytes || in_page >= kContentBytes)
        throw core::InputError(source_, "E57: " + what + " at " + std::to_string(physical_offset) +
                                            ", which is no place in the file");
    return std::string_view(contents_).substr(page * kContentBytes + in_page);
}

std::string_view E57Pages::at(std::uint64_t physical_offset, std::uint64_t length, const std::string& what) const
{
    const std::string_view rest = from(physical_offset, what);
    if (length > rest.size())
        throw core::InputError(source_, "E57: " + what + " of " + std::to_string(length) + " bytes, " +
                                            std::to_string(rest.size()) + " are left");
    return rest.substr(0, length);
}

} // namespace fettle::cloud
