#include "strategy/trace_file.h"

#include "cloud/pcd_header.h"
#include "core/error.h"
#include "core/file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sstream>
#include <unistd.h>

namespace fettle {
namespace {

/// Lines of a text have the same length, so that one can take the place of another: thirteen numbers.
constexpr std::size_t kLine = 240;
/// Digits of the number of points.
constexpr std::size_t kDigits = 10;

[[noreturn]] void fail(const std::string& path)
{
    throw InputError(path, std::string("cannot write: ") + std::strerror(errno));
}

/// The number after a word, at the beginning of a line, in as many digits as any number of points has.
void widen(std::string& header, const std::string& word, std::size_t points)
{
    const std::size_t at = header.find("\n" + word + " ") + word.size() + 2;
    const std::string digits = std::to_string(points);
    header.replace(at, header.find('\n', at) - at, std::string(kDigits - digits.size(), '0') + digits);
}

/// A program may have been killed after a row and before the header that counts it.
std::string_view counted(std::string_view bytes, const std::string& source)
{
    const PcdHeader header = parse_pcd_header(bytes, source);
    if (header.data == PcdHeader::Data::binary) return bytes.substr(0, header.body + header.points * header.stride());
    std::size_t end = header.body;
    for (std::size_t n = 0; n < header.points && end < bytes.size(); ++n)
        end = std::min(bytes.find('\n', end), bytes.size() - 1) + 1;
    return bytes.substr(0, end);
}

} // namespace

TraceFile::TraceFile(const std::string& path, const Units& units, PcdEncoding encoding,
                     const std::vector<TraceRow>& rows)
    : path_(path), units_(units), encoding_(encoding), width_(text({}).size()), count_(rows.size())
{
    std::ostringstream plain;
    write_pcd_header(plain, to_cloud({}), 0, units, encoding);
    header_ = plain.str();
    start_ = header(0).size();
    const std::string target = std::filesystem::exists(path) ? link_target(path) : path;
    const std::string name = working_name(target);
    ::unlink(name.c_str());
    file_ = Descriptor(::open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666));
    if (!file_.is_open()) fail(path);
    std::string all = header(count_);
    for (const TraceRow& row : rows) all += text(row);
    const bool written = write_all(file_, all) && ::rename(name.c_str(), target.c_str()) == 0;
    if (!written) {
        const int reason = errno;
        ::unlink(name.c_str());
        errno = reason;
        fail(path);
    }
}

void TraceFile::begin(const TraceRow& row)
{
    const std::string line = text(row), head = header(count_ + 1); // so that little time is between the two
    write(line, start_ + count_++ * width_);
    write(head, 0);
    begun_ = true;
}

void TraceFile::done(const TraceRow& row)
{
    if (!begun_) return begin(row), void(begun_ = false);
    // SIGKILL can end a write where a page of the file ends, so a row that is counted is never written over.
    write(header(count_ - 1), 0);
    write(text(row), start_ + (count_ - 1) * width_);
    write(header(count_), 0);
    begun_ = false;
}

std::string TraceFile::header(std::size_t points) const
{
    std::string text = header_;
    widen(text, "WIDTH", points);
    widen(text, "POINTS", points);
    return text;
}

std::string TraceFile::text(const TraceRow& row) const
{
    std::ostringstream out;
    write_pcd_points(out, to_cloud({row}), units_, encoding_);
    std::string bytes = out.str();
    if (encoding_ == PcdEncoding::ascii) {
        bytes.pop_back();
        bytes.resize(kLine - 1, ' ');
        bytes += '\n';
    }
    return bytes;
}

void TraceFile::write(const std::string& bytes, std::size_t at)
{
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t n = ::pwrite(file_.get(), bytes.data() + done, bytes.size() - done, off_t(at + done));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) fail(path_);
        done += std::size_t(n);
    }
}

std::vector<TraceRow> read_trace(const std::string& path, const Units& units)
{
    const std::string bytes = read_whole(path), source = display_name(path);
    std::vector<TraceRow> rows = trace_of(parse_cloud(counted(bytes, source), source, units).cloud, source);
    const auto stops = [](Event e) { return e == Event::bound || e == Event::fault || e == Event::begun; };
    while (!rows.empty() && stops(rows.back().event)) rows.pop_back();
    return rows;
}

} // namespace fettle
