#include "core/zip.h"

#include "core/error.h"

#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

namespace fettle::core {
namespace {

/// A file in memory, as minizip's functions see it.
struct MemoryFile {
    std::string_view bytes;
    ZPOS64_T position = 0;
};

MemoryFile& file_of(void* stream) { return *static_cast<MemoryFile*>(stream); }

zlib_filefunc64_def memory_functions(MemoryFile& file)
{
    zlib_filefunc64_def functions{};
    functions.opaque = &file;
    functions.zopen64_file = [](void* opaque, const void*, int) { return opaque; };
    functions.zread_file = [](void*, void* stream, void* to, uLong count) -> uLong {
        MemoryFile& from = file_of(stream);
        const std::string_view piece =
            from.bytes.substr(std::min<ZPOS64_T>(from.position, from.bytes.size())).substr(0, count);
        std::memcpy(to, piece.data(), piece.size());
        from.position += piece.size();
        return piece.size();
    };
    functions.zwrite_file = [](void*, void*, const void*, uLong) -> uLong { return 0; };
    functions.ztell64_file = [](void*, void* stream) { return file_of(stream).position; };
    functions.zseek64_file = [](void*, void* stream, ZPOS64_T offset, int origin) -> long {
        MemoryFile& in = file_of(stream);
        const ZPOS64_T start = origin == ZLIB_FILEFUNC_SEEK_CUR   ? in.position
                               : origin == ZLIB_FILEFUNC_SEEK_END ? in.bytes.size()
                                                                  : 0;
        if (offset > in.bytes.size() - std::min<ZPOS64_T>(start, in.bytes.size())) return -1;
        in.position = start + offset;
        return 0;
    };
    functions.zclose_file = [](void*, void*) { return 0; };
    functions.zerror_file = [](void*, void*) { return 0; };
    return functions;
}

} // namespace

struct ZipArchive::State {
    MemoryFile file;
    const std::string& source;
    unzFile archive = nullptr;

    State(std::string_view bytes, const std::string& source_) : file{bytes}, source(source_)
    {
        zlib_filefunc64_def functions = memory_functions(file);
        archive = unzOpen2_64("", &functions);
        if (archive == nullptr) throw InputError(source, "a ZIP archive that is damaged or ends too early");
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { unzClose(archive); }
};

ZipArchive::ZipArchive(std::string_view bytes, const std::string& source)
    : state_(std::make_unique<State>(bytes, source))
{
}

ZipArchive::~ZipArchive() = default;

bool ZipArchive::has(const std::string& name) const
{
    constexpr int kCaseCounts = 1;
    return unzLocateFile(state_->archive, name.c_str(), kCaseCounts) == UNZ_OK;
}

void ZipArchive::read(const std::string& name, const std::function<bool(std::string_view)>& use) const
{
    const unzFile archive = state_->archive;
    if (!has(name)) throw InputError(state_->source, "the ZIP archive has no " + name);
    unz_file_info64 info{};
    constexpr uLong kEncrypted = 1;
    if (unzGetCurrentFileInfo64(archive, &info, nullptr, 0, nullptr, 0, nullptr, 0) == UNZ_OK &&
        (info.flag & kEncrypted) != 0)
        throw InputError(state_->source, name + " is encrypted");
    int status = unzOpenCurrentFile(archive);
    // Closes the file where `use` has enough, or throws.
    std::unique_ptr<void, int (*)(unzFile)> open_file(archive, unzCloseCurrentFile);
    std::array<char, 1 << 16> piece;
    while (status == UNZ_OK) {
        const int count = unzReadCurrentFile(archive, piece.data(), piece.size());
        if (count < 0) status = count;
        if (count <= 0) break;
        if (!use({piece.data(), static_cast<std::size_t>(count)})) return;
    }
    const int closed = unzCloseCurrentFile(open_file.release()); // compares the checksum
    if (status != UNZ_OK || closed != UNZ_OK) throw InputError(state_->source, name + " is damaged in the ZIP archive");
}

bool looks_like_zip(std::string_view bytes) { return bytes.starts_with("PK\3\4"); }

} // namespace fettle::core
