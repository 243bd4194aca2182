#pragma once

#include "cloud/pcd.h"
#include "core/descriptor.h"
#include "core/digest.h"
#include "strategy/run_identity.h"
#include "strategy/trace.h"

#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::strategy {

/// A trace as a write-ahead log: a row for the next action (event `in_progress`, with its target) is in the file before
/// the machine starts it, and is replaced by the result afterwards. Whenever the program is killed, the points that the
/// header counts are complete; one more point, or a part of it, may follow them, which read_trace() ignores. The file
/// is not synced to the disk: it survives the program, not a power failure. A comment in the header says which run
/// wrote the rows, and has a digest of those that are counted (docs/formats.md).
class TraceFile {
  public:
    /// Replaces the file at `path` by one with these rows.
    /// @throws InputError if it cannot be written
    TraceFile(const std::string& path, const units::Units& units, cloud::PcdEncoding encoding,
              const std::vector<TraceRow>& rows, const RunIdentity& identity = {});

    /// Appends the row of an action that is about to start. @throws InputError if it cannot be written
    void begin_row(const TraceRow& row);
    /// Replaces that row by the action's result; without begin_row, appends it. @throws as above
    void complete_row(const TraceRow& row);
    /// The rows that have their results, and their digest as the header has it.
    struct Completed {
        std::size_t rows = 0;
        std::string digest; ///< of these rows, core::kDigestDigits digits
    };
    Completed completed() const { return {count_ - (in_progress_ ? 1 : 0), digest_.text()}; }
    /// True if the last row could not be written. The rows that the file counts are whole nevertheless.
    bool has_failed() const { return failed_; }

  private:
    std::string header(std::size_t points, const std::string& digest) const;
    std::string digest_with(const std::string& row) const; ///< of the completed rows and this one
    std::string row_bytes(const TraceRow& row) const;
    std::size_t row_offset(std::size_t index) const { return header_size_ + index * row_size_; }
    void write(const std::string& bytes, std::size_t offset);

    std::string path_;
    units::Units units_;
    cloud::PcdEncoding encoding_;
    std::string empty_header_; ///< for 0 points
    core::FileDescriptor file_;
    std::size_t header_size_ = 0, row_size_ = 0; ///< bytes
    std::size_t count_ = 0;                      ///< rows
    core::Digest digest_;                        ///< of the rows that have their results
    bool in_progress_ = false;                   ///< the last row waits for its result
    bool failed_ = false;
};

/// The journal of a run at `path`; none if that is empty, "-", or a pipe or device, from which nothing can be resumed.
/// @param rows  of the run that is continued   @throws InputError if it cannot be written
std::unique_ptr<TraceFile> open_journal(const std::string& path, const units::Units& units, cloud::PcdEncoding encoding,
                                        const std::vector<TraceRow>& rows = {}, const RunIdentity& identity = {});

/// Writes the trace of a run that has ended.
void write_trace(std::ostream& out, const std::vector<TraceRow>& rows, const units::Units& units,
                 cloud::PcdEncoding encoding, const RunIdentity& identity);

/// The part of a PCD's bytes that a run has completed: its header, and the whole rows that this counts.
struct WholeRows {
    std::string pcd;
    std::string cut; ///< what is missing or left out, for messages; empty: nothing
};
/// @throws InputError for a bad header
WholeRows whole_rows(std::string_view bytes, const std::string& source);

/// A trace as a run left it.
struct RecordedTrace {
    std::vector<TraceRow> rows;
    RunIdentity identity; ///< without parts, if the file does not say which run wrote it
    std::string cut;      ///< as in WholeRows
};
/// Reads a trace, also that of a program that was killed. Rows at its end that record a stop, or an action without a
/// result, are left out.
/// @param units  required of the file
/// @throws InputError if it is not a trace, or if its rows are not those that the run has written
RecordedTrace read_recorded_trace(const std::string& path, const units::Units& units);
/// Reads the beginning of a journal whose end is lost: as many rows as are known to be complete.
/// @throws InputError also if they are not those that the run has written
RecordedTrace read_recorded_trace(const std::string& path, const units::Units& units,
                                  const TraceFile::Completed& completed);
/// The rows alone.
std::vector<TraceRow> read_trace(const std::string& path, const units::Units& units);

/// Checks that a trace is that of the run that is to be continued.
/// @throws InputError that names the parts which differ; also if the trace is incomplete, or does not say its run
void require_same_run(const RecordedTrace& trace, const RunIdentity& identity, const std::string& source);

} // namespace fettle::strategy
