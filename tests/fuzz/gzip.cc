// Files that gzip compressed: at once and in small pieces they are the same, and what zlib inflates whole is what is
// read.

#include "core/gzip.h"
#include "memory_file.h"

#include <fcntl.h>
#include <optional>
#include <string>
#include <zlib.h>

using namespace fettle;

namespace {

/// What a reader gives of a file, in pieces of `count` bytes; nothing where it refuses.
std::optional<std::string> read_by(const std::string& path, std::size_t count, bool& is_compressed)
{
    std::string bytes, piece(count, '\0');
    const bool read = fuzz::is_read([&] {
        const core::FileDescriptor file(::open(path.c_str(), O_RDONLY));
        core::GzipReader reader(file, "file");
        while (const std::size_t got = reader.read(piece.data(), count)) bytes.append(piece, 0, got);
        is_compressed = reader.is_compressed();
    });
    return read ? std::optional(bytes) : std::nullopt;
}

/// One member that ends where the bytes do.
std::optional<std::string> inflated(std::string_view bytes)
{
    constexpr int kGzipWindow = 15 + 16;
    z_stream stream = {};
    fuzz::require(inflateInit2(&stream, kGzipWindow) == Z_OK, "zlib begins");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    std::string out, piece(1 << 16, '\0');
    int status = Z_OK;
    while (status == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(piece.data());
        stream.avail_out = static_cast<uInt>(piece.size());
        status = inflate(&stream, Z_NO_FLUSH);
        out.append(piece, 0, piece.size() - stream.avail_out);
    }
    const bool whole = status == Z_STREAM_END && stream.avail_in == 0;
    inflateEnd(&stream);
    return whole ? std::optional(out) : std::nullopt;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static fuzz::MemoryFile memory;
    const std::string_view bytes = fuzz::text_of(data, size);
    const std::string& path = memory.with(bytes);
    bool is_compressed = false, again = false;
    const std::optional<std::string> whole = read_by(path, 1 << 14, is_compressed), pieces = read_by(path, 61, again);
    fuzz::require(whole == pieces && is_compressed == again, "pieces are what the whole is");
    if (whole && !is_compressed) fuzz::require(*whole == bytes, "what is not compressed stays as it is");
    if (const std::optional<std::string> expected = inflated(bytes))
        fuzz::require(whole == expected, "what zlib inflates is what is read");
    return 0;
}
