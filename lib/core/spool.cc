#include "core/spool.h"

#include "core/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace fettle::core {

namespace {

constexpr std::size_t kChunkBytes = 1 << 20;

[[noreturn]] void fail_spool(const std::string& action)
{
    throw InputError(scratch_path(), action + ": " + std::strerror(errno));
}

} // namespace

void Spool::append(std::string_view bytes)
{
    while (!bytes.empty() && in_file_ == 0 && in_memory_ < max_memory_) {
        if (in_memory_ % kChunkBytes == 0)
            chunks_.emplace_back().reserve(std::min(kChunkBytes, max_memory_ - in_memory_));
        const std::size_t part =
            std::min({bytes.size(), kChunkBytes - in_memory_ % kChunkBytes, max_memory_ - in_memory_});
        chunks_.back().append(bytes.substr(0, part));
        in_memory_ += part;
        bytes.remove_prefix(part);
    }
    if (bytes.empty()) return;
    if (!file_.is_open()) file_ = open_unnamed(scratch_path());
    if (!file_.is_open()) fail_spool("cannot make a temporary file");
    if (!write_all(file_, bytes)) fail_spool("cannot write a temporary file");
    in_file_ += bytes.size();
}

void Spool::read(std::size_t offset, char* to, std::size_t count) const
{
    while (count > 0 && offset < in_memory_) {
        const std::size_t part = std::min({count, kChunkBytes - offset % kChunkBytes, in_memory_ - offset});
        std::memcpy(to, chunks_[offset / kChunkBytes].data() + offset % kChunkBytes, part);
        to += part;
        offset += part;
        count -= part;
    }
    while (count > 0) {
        const ssize_t got = pread(file_.get(), to, count, static_cast<off_t>(offset - in_memory_));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) fail_spool("cannot read a temporary file");
        to += got;
        offset += got;
        count -= got;
    }
}

} // namespace fettle::core
