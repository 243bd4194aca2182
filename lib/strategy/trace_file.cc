#include "strategy/trace_file.h"

#include "cloud/pcd_header.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sstream>
#include <unistd.h>

namespace fettle::strategy {
namespace {

/// All rows of an ASCII file have this length, so that one can replace another. It holds thirteen numbers.
constexpr std::size_t kLineLength = 240;
/// Digits of the number of points in the header; more points than a run can have.
constexpr std::size_t kCountDigits = 10;

[[noreturn]] void fail(const std::string& path)
{
    throw core::InputError(path, std::string("cannot write: ") + std::strerror(errno));
}

/// Sets the number after a keyword at the beginning of a line, padded with zeros to kCountDigits.
void set_count(std::string& header, const std::string& word, std::size_t points)
{
    const std::size_t offset = header.find("\n" + word + " ") + word.size() + 2;
    const std::string digits = std::to_string(points);
    header.replace(offset, header.find('\n', offset) - offset, std::string(kCountDigits - digits.size(), '0') + digits);
}

/// The comment of a trace: "run ", the parts of its identity, and the digest of its rows as one part more.
const std::string kRun = "run ", kRows = "rows";

std::string run_comment(const RunIdentity& identity, const std::string& digest)
{
    RunIdentity all = identity;
    all.parts.push_back({kRows, digest});
    return kRun + to_text(all);
}

/// The content of that comment; nothing if there is none.
RunIdentity identity_in(std::string_view header)
{
    core::Lines lines(header);
    while (lines.next())
        if (lines.line().starts_with("# " + kRun)) return parse_identity(lines.line().substr(2 + kRun.size()));
    return {};
}

void set_digest(std::string& header, const std::string& digest)
{
    const std::size_t offset = header.find(' ' + kRows + ':') + kRows.size() + 2;
    header.replace(offset, core::kDigestDigits, digest);
}

/// Digest of rows: of the bytes of a binary file, or of the lines without the blanks that they end in.
std::string_view without_trailing_blanks(std::string_view line)
{
    return line.substr(0, line.find_last_not_of(" \t\r\n") + 1);
}

void add_rows(core::Digest& digest, std::string_view rows, bool binary)
{
    if (binary) return void(digest.add(rows));
    core::Lines lines(rows);
    while (lines.next()) digest.add(without_trailing_blanks(lines.line())).add("\n");
}

std::string digest_of_rows(std::string_view rows, bool binary)
{
    core::Digest digest;
    add_rows(digest, rows, binary);
    return digest.text();
}

cloud::Cloud with_comment(cloud::Cloud cloud, const RunIdentity& identity, const std::string& digest)
{
    cloud.comment = run_comment(identity, digest);
    cloud.frame = identity.frame;
    return cloud;
}

/// Bytes of the whole rows at the beginning of a body, at most `max` rows; sets `rows` to their number.
std::size_t size_of_rows(const cloud::PcdHeader& header, std::string_view body, std::size_t& rows)
{
    if (header.data == cloud::PcdHeader::Data::binary) {
        rows = std::min(header.points, body.size() / header.stride());
        return rows * header.stride();
    }
    std::size_t end = 0;
    for (rows = 0; rows < header.points; ++rows) {
        const std::size_t newline = body.find('\n', end);
        if (newline == std::string_view::npos) break;
        end = newline + 1;
    }
    return end;
}

} // namespace

TraceFile::TraceFile(const std::string& path, const units::Units& units, cloud::PcdEncoding encoding,
                     const std::vector<TraceRow>& rows, const RunIdentity& identity)
    : path_(path), units_(units), encoding_(encoding), row_size_(row_bytes({}).size()), count_(rows.size())
{
    std::ostringstream plain;
    cloud::write_pcd_header(plain, with_comment(to_cloud({}), identity, digest_.text()), 0, units, encoding);
    empty_header_ = plain.str();
    header_size_ = header(0, digest_.text()).size();
    const std::string target = std::filesystem::exists(path) ? core::resolve_links(path) : path;
    const std::string name = core::temporary_name(target);
    ::unlink(name.c_str());
    file_ = core::FileDescriptor(::open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666));
    if (!file_.is_open()) fail(path);
    std::string all_rows;
    for (const TraceRow& row : rows) all_rows += row_bytes(row);
    add_rows(digest_, all_rows, encoding == cloud::PcdEncoding::binary);
    const std::string all = header(count_, digest_.text()) + all_rows;
    const bool written = core::write_all(file_, all) && ::rename(name.c_str(), target.c_str()) == 0;
    if (!written) {
        const int reason = errno;
        ::unlink(name.c_str());
        errno = reason;
        fail(path);
    }
}

void TraceFile::begin_row(const TraceRow& row)
{
    // Both are formatted first, so that little time is between the two writes.
    const std::string line = row_bytes(row), head = header(count_ + 1, digest_with(line));
    write(line, row_offset(count_));
    write(head, 0);
    ++count_;
    in_progress_ = true;
}

void TraceFile::complete_row(const TraceRow& row)
{
    const std::string line = row_bytes(row);
    if (in_progress_) {
        // SIGKILL can end a write at the end of a page of the file, so a row that is counted is never overwritten.
        write(header(count_ - 1, digest_.text()), 0);
        write(line, row_offset(count_ - 1));
        write(header(count_, digest_with(line)), 0);
    } else {
        begin_row(row);
    }
    add_rows(digest_, line, encoding_ == cloud::PcdEncoding::binary);
    in_progress_ = false;
}

std::string TraceFile::digest_with(const std::string& row) const
{
    if (encoding_ == cloud::PcdEncoding::binary) return digest_.text(row);
    return digest_.text(std::string(without_trailing_blanks(row)) + '\n');
}

std::string TraceFile::header(std::size_t points, const std::string& digest) const
{
    std::string header = empty_header_;
    set_digest(header, digest);
    set_count(header, "WIDTH", points);
    set_count(header, "POINTS", points);
    return header;
}

std::string TraceFile::row_bytes(const TraceRow& row) const
{
    std::ostringstream out;
    cloud::write_pcd_points(out, to_cloud({row}), units_, encoding_);
    std::string bytes = out.str();
    if (encoding_ == cloud::PcdEncoding::ascii) {
        bytes.pop_back();
        bytes.resize(kLineLength - 1, ' ');
        bytes += '\n';
    }
    return bytes;
}

void TraceFile::write(const std::string& bytes, std::size_t offset)
{
    for (std::size_t written = 0; written < bytes.size();) {
        const ssize_t n =
            ::pwrite(file_.get(), bytes.data() + written, bytes.size() - written, off_t(offset + written));
        if (n < 0 && errno == EINTR) continue;
        failed_ = n <= 0;
        if (failed_) fail(path_);
        written += n;
    }
}

std::unique_ptr<TraceFile> open_journal(const std::string& path, const units::Units& units, cloud::PcdEncoding encoding,
                                        const std::vector<TraceRow>& rows, const RunIdentity& identity)
{
    namespace fs = std::filesystem;
    if (path.empty() || path == "-" || (fs::exists(path) && !fs::is_regular_file(path))) return nullptr;
    return std::make_unique<TraceFile>(path, units, encoding, rows, identity);
}

void write_trace(std::ostream& out, const std::vector<TraceRow>& rows, const units::Units& units,
                 cloud::PcdEncoding encoding, const RunIdentity& identity)
{
    const cloud::Cloud cloud = to_cloud(rows);
    std::ostringstream body;
    cloud::write_pcd_points(body, cloud, units, encoding);
    const std::string digest = digest_of_rows(body.view(), encoding == cloud::PcdEncoding::binary);
    cloud::write_pcd_header(out, with_comment(cloud, identity, digest), rows.size(), units, encoding);
    out << body.view();
}

WholeRows whole_rows(std::string_view bytes, const std::string& source)
{
    const cloud::PcdHeader header = cloud::parse_pcd_header(bytes, source);
    if (header.data == cloud::PcdHeader::Data::compressed || header.height != 1) return {std::string(bytes), ""};
    std::string head(bytes.substr(0, header.body));
    const std::string_view body = bytes.substr(header.body);
    std::size_t rows = 0;
    const std::size_t size = size_of_rows(header, body, rows);
    const std::size_t more = without_trailing_blanks(body.substr(size)).size();
    WholeRows whole;
    if (rows < header.points) {
        whole.cut = "cut short: " + std::to_string(rows) + " whole points of " + std::to_string(header.points);
        for (const char* word : {"WIDTH", "POINTS"})
            if (head.find("\n" + std::string(word) + ' ') != std::string::npos) set_count(head, word, rows);
    } else if (more > 0) {
        whole.cut = "the run was killed: after " + std::to_string(rows) + " points " + std::to_string(more) +
                    " bytes of another one are left out";
    }
    whole.pcd = head + std::string(body.substr(0, size));
    return whole;
}

static RecordedTrace parse_recorded_trace(std::string_view bytes, const std::string& source, const units::Units& units)
{
    const WholeRows whole = whole_rows(bytes, source);
    const cloud::PcdHeader header = cloud::parse_pcd_header(whole.pcd, source);
    RecordedTrace trace{trace_from_cloud(cloud::parse_cloud(whole.pcd, source, units).cloud, source),
                        identity_in(std::string_view(whole.pcd).substr(0, header.body)), whole.cut};
    const auto rows = std::ranges::find(trace.identity.parts, kRows, &RunIdentity::Part::name);
    if (rows != trace.identity.parts.end()) {
        const bool complete = !whole.cut.starts_with("cut short");
        const bool binary = header.data == cloud::PcdHeader::Data::binary;
        if (complete && digest_of_rows(std::string_view(whole.pcd).substr(header.body), binary) != rows->digest)
            throw core::InputError(source, "its points are not those that the run has written");
        trace.identity.parts.erase(rows);
    }
    const auto stops = [](Event e) {
        return e == Event::limit_reached || e == Event::fault || e == Event::in_progress || e == Event::stopped;
    };
    while (!trace.rows.empty() && stops(trace.rows.back().event)) trace.rows.pop_back();
    return trace;
}

RecordedTrace read_recorded_trace(const std::string& path, const units::Units& units)
{
    return parse_recorded_trace(core::read_file(path), core::display_name(path), units);
}

RecordedTrace read_recorded_trace(const std::string& path, const units::Units& units,
                                  const TraceFile::Completed& completed)
{
    const std::string bytes = core::read_file(path), source = core::display_name(path);
    const cloud::PcdHeader header = cloud::parse_pcd_header(bytes, source);
    std::string head = bytes.substr(0, header.body);
    if (head.find(' ' + kRows + ':') == std::string::npos)
        throw core::InputError(source, "does not say which run wrote it");
    set_digest(head, completed.digest);
    set_count(head, "WIDTH", completed.rows);
    set_count(head, "POINTS", completed.rows);
    const std::size_t row = header.data == cloud::PcdHeader::Data::binary ? header.stride() : kLineLength;
    RecordedTrace trace = parse_recorded_trace(head + bytes.substr(header.body, completed.rows * row), source, units);
    if (trace.cut.empty()) trace.cut = "its last rows are lost: " + std::to_string(completed.rows) + " are kept";
    return trace;
}

std::vector<TraceRow> read_trace(const std::string& path, const units::Units& units)
{
    return read_recorded_trace(path, units).rows;
}

void require_same_run(const RecordedTrace& trace, const RunIdentity& identity, const std::string& source)
{
    if (trace.cut.starts_with("cut short")) throw core::InputError(source, trace.cut);
    if (trace.identity.parts.empty())
        throw core::InputError(source, "does not say which run wrote it: no '# run' line in its header");
    const std::vector<std::string> names = differing_parts(identity, trace.identity);
    if (names.empty()) return;
    throw core::InputError(source, "does not match this plan and these options: another " + core::join(names, ", "));
}

} // namespace fettle::strategy
