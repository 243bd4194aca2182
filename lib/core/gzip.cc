#include "core/gzip.h"

#include "core/error.h"
#include "core/file.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <unistd.h>
#include <utility>
#include <zlib.h>

namespace fettle::core {

struct GzipReader::State {
    gzFile file = nullptr;
    std::string path;
};

GzipReader::GzipReader(const FileDescriptor& file, std::string path) : state_(std::make_unique<State>())
{
    constexpr unsigned kBufferBytes = 1 << 18;
    const int copy = dup(file.get()); // gzclose() closes it
    state_->path = std::move(path);
    state_->file = copy < 0 ? nullptr : gzdopen(copy, "rb");
    if (state_->file == nullptr)
        throw InputError(display_name(state_->path), "cannot read: " + std::string(std::strerror(errno)));
    gzbuffer(state_->file, kBufferBytes);
}

GzipReader::~GzipReader() { gzclose(state_->file); }

std::size_t GzipReader::read(char* to, std::size_t count)
{
    const auto wanted = static_cast<unsigned>(std::min<std::size_t>(count, INT_MAX));
    int got = 0, status = Z_OK;
    const char* reason = nullptr;
    do { // again after a signal
        gzclearerr(state_->file);
        got = gzread(state_->file, to, wanted);
        reason = gzerror(state_->file, &status);
    } while (status == Z_ERRNO && errno == EINTR);
    if (status == Z_ERRNO)
        throw InputError(display_name(state_->path), "cannot read: " + std::string(std::strerror(errno)));
    if (status == Z_BUF_ERROR) throw InputError(display_name(state_->path), "compressed by gzip, and ends too early");
    if (got < 0)
        throw InputError(display_name(state_->path), "compressed by gzip, and damaged: " + std::string(reason));
    return static_cast<std::size_t>(got);
}

bool GzipReader::is_compressed() const { return gzdirect(state_->file) == 0; }

bool looks_like_gzip(const std::string& head) { return head.starts_with("\x1f\x8b"); }

} // namespace fettle::core
