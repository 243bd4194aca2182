// 3MF: an input is read as an archive, and as the model in one, which is made here without compression: a changed byte
// would else only ever be a damaged archive.

#include "mesh/three_mf.h"
#include "mesh_round_trip.h"

#include <zlib.h>

using namespace fettle;

namespace {

void append(std::string& to, std::uint64_t value, int bytes)
{
    for (int k = 0; k < bytes; ++k, value >>= 8) to += static_cast<char>(value & 0xff);
}

/// An archive of stored files (PKWARE's APPNOTE, 4.3).
class ArchiveWriter {
  public:
    void add(const std::string& name, std::string_view contents)
    {
        const std::size_t offset = bytes_.size();
        std::string common;
        append(common, 20, 2); // version
        append(common, 0, 8);  // flags, stored, time and date
        append(common, crc32(0, reinterpret_cast<const Bytef*>(contents.data()), static_cast<uInt>(contents.size())),
               4);
        append(common, contents.size(), 4);
        append(common, contents.size(), 4);
        append(common, name.size(), 2);
        append(common, 0, 2); // extra field
        bytes_ += "PK\3\4" + common + name;
        bytes_ += contents;
        directory_ += std::string("PK\1\2") + '\x14' + '\0' + common;
        append(directory_, 0, 10); // comment, disk, attributes
        append(directory_, offset, 4);
        directory_ += name;
        ++files_;
    }

    std::string finished() const
    {
        std::string all = bytes_ + directory_ + "PK\5\6";
        append(all, 0, 4);
        append(all, files_, 2);
        append(all, files_, 2);
        append(all, directory_.size(), 4);
        append(all, bytes_.size(), 4);
        append(all, 0, 2);
        return all;
    }

  private:
    std::string bytes_, directory_;
    std::uint64_t files_ = 0;
};

constexpr std::string_view kRelationships =
    "<Relationships><Relationship Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" "
    "Target=\"/m\"/></Relationships>";

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view bytes = fuzz::text_of(data, size);
    fuzz::is_read([&] { mesh::parse_three_mf(bytes, "file"); });
    ArchiveWriter archive;
    archive.add("_rels/.rels", kRelationships);
    archive.add("m", bytes);
    fuzz::check_mesh(archive.finished());
    return 0;
}
