#include "belt/belt_journal.h"

#include "belt/belt_journal_file.h"
#include "core/error.h"
#include "core/file.h"

#include <unistd.h>

#include <chrono>
#include <ostream>
#include <utility>

namespace fettle::belt {

namespace {

/// The journal of one run.
struct JournalFile {
    std::string path, digest; ///< of the run; an empty path: no journal

    void write(const BeltGrinding& grinding, const Surfels& surfels) const
    {
        core::OutputFile file(path);
        const std::string bytes = encode_journal(digest, {grinding.state(), surfels.displacement});
        file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        file.commit();
    }

    /// Continues from the journal, if there is one.
    void resume(BeltGrinding& grinding, Surfels& surfels, std::size_t path_length, Eigen::Index cells_per_side) const
    {
        if (path.empty() || ::access(path.c_str(), F_OK) != 0) return;
        const std::string bytes = core::read_file(path);
        BeltCheckpoint found = core::with_error_prefix(path, [&] {
            return decode_journal(bytes, digest, {grinding.state(), surfels.displacement}, path_length, cells_per_side);
        });
        surfels.displacement = std::move(found.displacement);
        grinding.restore(std::move(found.state));
    }
};

} // namespace

BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path, BeltOptions options,
              const BeltJournal& journal, const BeltListener& listener, PassSupervisor* supervisor,
              const core::Progress& progress)
{
    using Clock = std::chrono::steady_clock;
    const bool has_journal = !journal.file.empty();
    if (has_journal) options.keep_removals = false;
    const JournalFile file = {journal.file,
                              has_journal ? run_digest(surfels, wheel, path, options, journal.context_digest) : ""};
    BeltGrinding grinding(surfels, wheel, path, options);
    file.resume(grinding, surfels, path.size(), options.contact.cells_per_side);
    if (supervisor) supervisor->resume(grinding.run());
    if (listener) listener(grinding.run());
    Clock::time_point last_write = Clock::now();
    std::size_t pass_end = grinding.next_point();
    while (!grinding.is_done()) {
        core::report_progress(progress, grinding.progress());
        if (grinding.next_point() == pass_end) {
            pass_end = end_of_pass(path, pass_end);
            if (supervisor) supervisor->begin_pass(grinding, grinding.next_point(), pass_end);
        }
        grinding.step();
        const bool is_between_passes = grinding.next_point() == pass_end;
        if (supervisor && is_between_passes) grinding.add_pass(supervisor->end_pass(grinding.run()));
        if (listener) listener(grinding.run());
        if (supervisor && !is_between_passes) continue;
        const std::chrono::duration<double> since = Clock::now() - last_write;
        if (!has_journal || (since.count() < journal.interval && !grinding.is_done())) continue;
        file.write(grinding, surfels);
        last_write = Clock::now();
    }
    return grinding.run();
}

} // namespace fettle::belt
