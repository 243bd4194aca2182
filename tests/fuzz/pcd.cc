// Point clouds: all that read_cloud() reads, at once and in blocks. What was read is written as text and as numbers,
// and both read the same again.

#include "cloud/pcd.h"
#include "cloud/pcd_header.h"
#include "cloud/point_source.h"
#include "memory_file.h"

#include <sstream>

using namespace fettle;

namespace {

std::string written(const cloud::Cloud& cloud, const units::Units& units, cloud::PcdEncoding encoding)
{
    std::ostringstream out;
    cloud::write_pcd(out, cloud, units, encoding);
    return out.str();
}

void check_round_trip(const cloud::CloudFile& file)
{
    for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::binary, cloud::PcdEncoding::ascii}) {
        const cloud::CloudFile again = cloud::parse_cloud(written(file.cloud, file.units, encoding), "written");
        fuzz::require(again.units.length == file.units.length && again.cloud.size() == file.cloud.size() &&
                          again.cloud.fields.size() == file.cloud.fields.size(),
                      "unit and size are kept");
        const cloud::CloudFile twice = cloud::parse_cloud(written(again.cloud, again.units, encoding), "written");
        fuzz::require(written(twice.cloud, twice.units, encoding) == written(again.cloud, again.units, encoding),
                      "read and written again it is the same");
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static fuzz::MemoryFile memory;
    const std::string_view bytes = fuzz::text_of(data, size);
    cloud::CloudFile file;
    const bool whole = fuzz::is_read([&] { file = cloud::parse_cloud(bytes, "file"); });
    fuzz::is_read([&] {
        cloud::parse_cloud(bytes, "file", units::Units{units::Units::Length::in, units::Units::Force::lbf});
    });
    if (whole) check_round_trip(file);
    if (!cloud::looks_like_pcd(bytes)) return 0;
    cloud::CloudFile parts;
    const bool streamed = fuzz::is_read([&] {
        const cloud::CloudStream stream(memory.with(bytes));
        parts = {*stream.read_all(), stream.units()};
    });
    fuzz::require(whole == streamed, "a stream is read where the whole is");
    if (whole)
        fuzz::require(written(file.cloud, file.units, cloud::PcdEncoding::binary) ==
                          written(parts.cloud, parts.units, cloud::PcdEncoding::binary),
                      "a stream is what the whole is");
    return 0;
}
