#include "core/spool.h"

#include "core/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace fettle {

namespace {

constexpr std::size_t kChunk = 1 << 20;

[[noreturn]] void fail(const std::string& doing)
{
    throw InputError(scratch_path(), doing + ": " + std::strerror(errno));
}

} // namespace

void Spool::append(std::string_view bytes)
{
    while (!bytes.empty() && filed_ == 0 && held_ < memory_) {
        if (held_ % kChunk == 0) chunks_.emplace_back().reserve(std::min(kChunk, memory_ - held_));
        const std::size_t part = std::min({bytes.size(), kChunk - held_ % kChunk, memory_ - held_});
        chunks_.back().append(bytes.substr(0, part));
        held_ += part;
        bytes.remove_prefix(part);
    }
    if (bytes.empty()) return;
    if (!file_.is_open()) file_ = open_unnamed(scratch_path());
    if (!file_.is_open()) fail("cannot make a temporary file");
    if (!write_all(file_, bytes)) fail("cannot write a temporary file");
    filed_ += bytes.size();
}

void Spool::read(std::size_t offset, char* to, std::size_t count) const
{
    while (count > 0 && offset < held_) {
        const std::size_t part = std::min({count, kChunk - offset % kChunk, held_ - offset});
        std::memcpy(to, chunks_[offset / kChunk].data() + offset % kChunk, part);
        to += part;
        offset += part;
        count -= part;
    }
    while (count > 0) {
        const ssize_t got = pread(file_.get(), to, count, static_cast<off_t>(offset - held_));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) fail("cannot read a temporary file");
        to += got;
        offset += static_cast<std::size_t>(got);
        count -= static_cast<std::size_t>(got);
    }
}

} // namespace fettle
