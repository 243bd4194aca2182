// E57 scans. An input is what a file holds without the checksums of its pages, which are made here: a changed byte
// would else only ever be a wrong checksum. What was read is written as PCD and reads the same again.

#include "cloud/e57.h"
#include "cloud/pcd.h"
#include "fuzz.h"

#include <boost/crc.hpp>

#include <algorithm>
#include <cstring>
#include <sstream>

using namespace fettle;

namespace {

/// The file of these contents; its header states the length that it has.
std::string with_checksums(std::string_view contents)
{
    constexpr std::size_t kContentBytes = 1020, kLengthAt = 16, kHeaderBytes = 48;
    std::string padded(contents);
    padded.resize((padded.size() + kContentBytes - 1) / kContentBytes * kContentBytes);
    if (padded.size() >= kHeaderBytes) {
        const std::uint64_t length = padded.size() / kContentBytes * 1024;
        std::memcpy(padded.data() + kLengthAt, &length, sizeof length);
    }
    std::string file;
    for (std::size_t begin = 0; begin < padded.size(); begin += kContentBytes) {
        const std::string page = padded.substr(begin, kContentBytes);
        boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
        crc.process_bytes(page.data(), page.size());
        file += page;
        for (int shift = 24; shift >= 0; shift -= 8) file += static_cast<char>(crc.checksum() >> shift & 0xff);
    }
    return file;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view bytes = fuzz::text_of(data, size);
    fuzz::is_read([&] { cloud::parse_e57(bytes, "file"); });
    cloud::CloudFile file;
    if (!fuzz::is_read([&] {
            const std::string whole = with_checksums(bytes);
            if (cloud::looks_like_e57(whole)) file = cloud::parse_cloud(whole, "file");
        }))
        return 0;
    std::ostringstream pcd;
    cloud::write_pcd(pcd, file.cloud, file.units);
    fuzz::require(cloud::parse_cloud(pcd.str(), "written").cloud.size() == file.cloud.size(), "it reads again");
    return 0;
}
