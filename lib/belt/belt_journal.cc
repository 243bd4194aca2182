#include "belt/belt_journal.h"

#include "core/error.h"
#include "core/file.h"

#include <unistd.h>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ostream>
#include <span>
#include <type_traits>
#include <utility>

namespace fettle {

namespace {

using Eigen::Index;

constexpr char kTitle[] = "fettle-belt journal 1\n";
constexpr char kBroken[] = "the journal is broken";
constexpr double kMost = 9007199254740992; // the whole numbers that a double holds end at 2^53

/// Numbers in the order in which they are told or asked for: one text for both ways.
class Numbers {
  public:
    /// To be filled.
    Numbers() : is_writing_(true) {}
    /// To be read. @throws InputError, later, if there are too few
    explicit Numbers(std::vector<double> values) : is_writing_(false), values_(std::move(values)) {}

    void pass(double& value)
    {
        if (is_writing_) {
            values_.push_back(value);
        } else {
            if (at_ == values_.size()) throw InputError("the journal is too short");
            value = values_[at_++];
        }
    }
    template <typename Count>
    requires std::is_integral_v<Count>
    void pass(Count& count)
    {
        auto value = static_cast<double>(count);
        pass(value);
        if (!(value >= 0 && value <= kMost && value == std::floor(value))) throw InputError(kBroken);
        count = static_cast<Count>(value);
    }
    template <typename Derived>
    void pass(Eigen::PlainObjectBase<Derived>& matrix)
    {
        Index rows = matrix.rows(), columns = matrix.cols();
        pass(rows);
        pass(columns);
        if (rows > 0) check(columns, rows);
        matrix.resize(rows, columns);
        for (double& value : matrix.reshaped()) pass(value);
    }
    template <typename Item, typename PassItem>
    void pass(std::vector<Item>& items, const PassItem& pass_item)
    {
        std::size_t count = items.size();
        pass(count);
        check(static_cast<Index>(count), 1);
        items.resize(count);
        for (Item& item : items) pass_item(item);
    }

    bool is_at_end() const { return at_ == values_.size(); }
    const std::vector<double>& values() const { return values_; }

  private:
    // No more can follow than there are.
    void check(Index count, Index each) const
    {
        if (!is_writing_ && count > static_cast<Index>(values_.size()) / each) throw InputError(kBroken);
    }

    bool is_writing_;
    std::vector<double> values_;
    std::size_t at_ = 0;
};

void pass(Numbers& numbers, BeltTrace& trace)
{
    for (double BeltTrace::*member :
         {&BeltTrace::time, &BeltTrace::duration, &BeltTrace::force, &BeltTrace::indentation, &BeltTrace::peak_pressure,
          &BeltTrace::area, &BeltTrace::removed})
        numbers.pass(trace.*member);
}

void pass(Numbers& numbers, BeltError& error)
{
    for (Index BeltError::*member : {&BeltError::gouge, &BeltError::within, &BeltError::undercut})
        numbers.pass(error.*member);
    for (double BeltError::*member : {&BeltError::mean, &BeltError::rms, &BeltError::least})
        numbers.pass(error.*member);
}

void pass(Numbers& numbers, RunningError& error)
{
    AssessmentCounts& counts = error.counts;
    for (Index* count : {&counts.gouge, &counts.within, &counts.undercut, &counts.undefined}) numbers.pass(*count);
    for (double* value : {&error.sum, &error.squares, &error.least}) numbers.pass(*value);
}

void pass(Numbers& numbers, BeltState& state, Surfels& surfels)
{
    BeltRun& run = state.run;
    numbers.pass(state.next);
    numbers.pass(surfels.displacement);
    numbers.pass(run.removed);
    numbers.pass(run.trace, [&](BeltTrace& trace) { pass(numbers, trace); });
    numbers.pass(run.errors, [&](BeltError& error) { pass(numbers, error); });
    numbers.pass(run.removed_volume);
    numbers.pass(run.work);
    numbers.pass(run.near_edge);
    if (state.error) pass(numbers, *state.error);
    numbers.pass(state.press.cells.cell);
    numbers.pass(state.press.cells.rows);
    numbers.pass(state.press.cells.columns);
    numbers.pass(state.press.pressure);
    numbers.pass(state.press.last);
}

/// Of all that a run depends on: FNV-1a, 64 bits at a time. It tells mistakes, not forgeries.
class Fingerprint {
  public:
    void add(double value) { value_ = (value_ ^ std::bit_cast<std::uint64_t>(value)) * kPrime; }
    void add(std::span<const double> values)
    {
        for (const double value : values) add(value);
    }
    template <typename Matrix>
    void add_all(const Matrix& matrix)
    {
        add(std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size())));
    }
    double value() const { return static_cast<double>(value_ >> 11); } // what a double holds

  private:
    static constexpr std::uint64_t kPrime = 0x100000001b3;
    std::uint64_t value_ = 0xcbf29ce484222325;
};

double fingerprint(const Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                   const BeltOptions& options)
{
    Fingerprint print;
    print.add_all(surfels.position);
    print.add_all(surfels.normal);
    print.add_all(surfels.displacement);
    for (const BeltPoint& point : path) {
        print.add_all(point.T_part_tool.matrix());
        print.add(std::to_array<double>({double(point.pressing.by_force), point.pressing.amount, point.feed,
                                         point.dwell, double(point.begins_run)}));
    }
    const BeltLaw& law = wheel.law;
    const ContactWheel::Serration& serration = wheel.serration;
    print.add(std::to_array({wheel.radius, wheel.width, wheel.crown_radius, wheel.layer.thickness, wheel.layer.young,
                             wheel.layer.poisson, wheel.belt_speed, serration.pitch, serration.land, serration.depth,
                             serration.angle, law.coefficient, law.pressure, law.speed, law.feed, law.threshold,
                             law.dwell, law.wear_work}));
    const ToleranceRange range = options.range.value_or(ToleranceRange{0, 0});
    print.add(std::to_array({static_cast<double>(options.press.gridding), static_cast<double>(options.press.cells),
                             options.press.tolerance, static_cast<double>(options.model), options.worn,
                             options.range ? 1.0 : 0.0, range.lower, range.upper}));
    return print.value();
}

void write_journal(const std::string& path, double print, BeltState state, Surfels& surfels)
{
    Numbers numbers;
    numbers.pass(print);
    pass(numbers, state, surfels);
    OutputFile file(path);
    file.stream() << kTitle;
    file.stream().write(reinterpret_cast<const char*>(numbers.values().data()),
                        static_cast<std::streamsize>(numbers.values().size() * sizeof(double)));
    file.commit();
}

/// @param state  as it is before the first point   @param path_length  points of the path
void read_journal(const std::string& bytes, double print, BeltState& state, Surfels& surfels, std::size_t path_length)
{
    constexpr std::size_t kBegin = sizeof kTitle - 1;
    if (!bytes.starts_with(kTitle) || (bytes.size() - kBegin) % sizeof(double) != 0)
        throw InputError("this is no journal of fettle-belt");
    std::vector<double> values((bytes.size() - kBegin) / sizeof(double));
    std::memcpy(values.data(), bytes.data() + kBegin, bytes.size() - kBegin);
    Numbers numbers(std::move(values));
    double found = 0;
    numbers.pass(found);
    if (found != print)
        throw InputError("this is the journal of another run: of other surfels, another path, wheel or options");
    pass(numbers, state, surfels);
    if (!numbers.is_at_end() || surfels.displacement.size() != surfels.position.cols() || state.next > path_length)
        throw InputError(kBroken);
}

} // namespace

BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path, BeltOptions options,
              const BeltJournal& journal, const BeltListener& listener, const Progress& progress)
{
    using Clock = std::chrono::steady_clock;
    options.keeps_losses = false;
    BeltGrinding grinding(surfels, wheel, path, options);
    const double print = journal.file.empty() ? 0 : fingerprint(surfels, wheel, path, options);
    if (!journal.file.empty() && ::access(journal.file.c_str(), F_OK) == 0) {
        BeltState state = grinding.state();
        const std::string bytes = read_whole(journal.file);
        try {
            read_journal(bytes, print, state, surfels, path.size());
        } catch (const InputError& error) {
            throw InputError(journal.file, error.what());
        }
        grinding.go_on(std::move(state));
    }
    if (listener) listener(grinding.run());
    Clock::time_point kept = Clock::now();
    while (!grinding.is_done()) {
        tell(progress, static_cast<double>(grinding.run().trace.size()) / static_cast<double>(path.size()));
        grinding.step();
        if (listener) listener(grinding.run());
        const std::chrono::duration<double> since = Clock::now() - kept;
        if (journal.file.empty() || (since.count() < journal.every && !grinding.is_done())) continue;
        write_journal(journal.file, print, grinding.state(), surfels);
        kept = Clock::now();
    }
    BeltRun run = grinding.run();
    run.losses.clear();
    return run;
}

} // namespace fettle
