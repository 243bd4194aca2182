#include "station/checkpoint.h"

#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <ostream>
#include <utility>

namespace fettle::station {
namespace {

/// At 1 in/s it is a fifth of an inch.
constexpr std::chrono::milliseconds kCheckpointPeriod{200};

} // namespace

std::string checkpoint_of(const std::string& trace) { return trace + ".checkpoint"; }

Checkpoint::Checkpoint(const std::string& trace) : trace_(trace), file_(::open(trace.c_str(), O_RDONLY | O_CLOEXEC))
{
    if (!file_.is_open()) throw core::InputError(trace, std::string("cannot open: ") + std::strerror(errno));
    thread_ = std::thread([this] { sync(); });
}

Checkpoint::~Checkpoint()
{
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void Checkpoint::follow(const strategy::TraceFile& journal)
{
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    next_ = now + kCheckpointPeriod;
    {
        const std::lock_guard lock(mutex_);
        due_ = journal.completed();
    }
    changed_.notify_one();
}

/// A disk that fails is noticed by the journal itself.
void Checkpoint::sync()
{
    for (;;) {
        strategy::TraceFile::Completed completed;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return due_ || ends_; });
            if (!due_) return;
            completed = *std::exchange(due_, std::nullopt);
        }
        if (::fdatasync(file_.get()) != 0) continue;
        try {
            core::OutputFile out(checkpoint_of(trace_));
            out.stream() << completed.rows << ' ' << completed.digest << '\n';
            out.commit();
        } catch (const core::InputError&) { // the one before still holds
        }
    }
}

strategy::RecordedTrace read_trace_or_checkpoint(const std::string& trace, const units::Units& units)
{
    try {
        strategy::RecordedTrace whole = strategy::read_recorded_trace(trace, units);
        if (!whole.cut.starts_with("cut short") || !std::filesystem::exists(checkpoint_of(trace))) return whole;
    } catch (const core::InputError&) {
        if (!std::filesystem::exists(checkpoint_of(trace))) throw;
    }
    const std::string text = core::read_file(checkpoint_of(trace));
    const std::vector<std::string_view> words = core::words(std::string_view(text).substr(0, text.find('\n')));
    const auto rows = words.size() == 2 ? core::parse_integer<std::size_t>(words[0]) : std::nullopt;
    if (!rows || words[1].size() != core::kDigestDigits)
        throw core::InputError(checkpoint_of(trace), "is no checkpoint of a trace");
    return strategy::read_recorded_trace(trace, units, {*rows, std::string(words[1])});
}

} // namespace fettle::station
