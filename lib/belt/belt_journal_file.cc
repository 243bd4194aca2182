#include "belt/belt_journal_file.h"

#include "core/digest.h"
#include "core/error.h"

#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace fettle::belt {

namespace {

using Eigen::Index;

constexpr std::string_view kTitle = "fettle-belt journal 4\n";
constexpr std::string_view kTitleOfAnyVersion = "fettle-belt journal ";
constexpr std::size_t kDigestLine = 64 + 1;           // hexadecimal digits of SHA-256, and the end of the line
constexpr double kMaxExactInteger = 9007199254740992; // 2^53: a double holds all integers up to it

[[noreturn]] void refuse_as_corrupt()
{
    throw core::InputError("the journal is corrupt: without it the run starts again");
}

/// Serialization archive of doubles. The same serialize() functions write and read, so that both use one order.
class Archive {
  public:
    /// An empty archive for writing.
    Archive() : is_writing_(true) {}
    /// An archive for reading. Each serialize() throws InputError if the values end or are invalid.
    explicit Archive(std::vector<double> values) : is_writing_(false), values_(std::move(values)) {}

    void serialize(double& value)
    {
        if (is_writing_) {
            values_.push_back(value);
        } else {
            if (is_at_end()) refuse_as_corrupt();
            value = values_[position_++];
        }
    }
    template <typename Count>
    requires std::is_integral_v<Count>
    void serialize(Count& count)
    {
        auto value = static_cast<double>(count);
        serialize(value);
        const bool is_count = value >= 0 && value <= kMaxExactInteger && value == std::floor(value);
        if (!is_count || std::signbit(value)) refuse_as_corrupt(); // -0 is no count either
        count = static_cast<Count>(value);
    }
    template <typename Derived>
    void serialize(Eigen::PlainObjectBase<Derived>& matrix)
    {
        Index rows = matrix.rows(), columns = matrix.cols();
        serialize(rows);
        serialize(columns);
        check_matrix_size(rows, columns, Derived::RowsAtCompileTime, Derived::ColsAtCompileTime);
        matrix.resize(rows, columns);
        for (double& value : matrix.reshaped()) serialize(value);
    }
    template <typename Item, typename SerializeItem>
    void serialize(std::vector<Item>& items, const SerializeItem& serialize_item)
    {
        std::size_t count = items.size();
        serialize(count);
        if (!is_writing_ && count > remaining()) refuse_as_corrupt(); // before memory is allocated
        items.resize(count);
        for (Item& item : items) serialize_item(item);
    }

    template <typename... Values>
    void serialize_all(Values&... values)
    {
        (serialize(values), ...);
    }

    bool is_at_end() const { return position_ == values_.size(); }
    const std::vector<double>& values() const { return values_; }

  private:
    std::size_t remaining() const { return values_.size() - position_; }

    // The elements must be in the archive, and a vector must be one, before memory is allocated.
    void check_matrix_size(Index rows, Index columns, Index fixed_rows, Index fixed_columns) const
    {
        if (is_writing_) return;
        const bool fits = columns == 0 || rows <= static_cast<Index>(remaining()) / columns;
        const bool has_shape = (fixed_rows == Eigen::Dynamic || rows == fixed_rows) &&
                               (fixed_columns == Eigen::Dynamic || columns == fixed_columns);
        if (!fits || !has_shape) refuse_as_corrupt();
    }

    bool is_writing_;
    std::vector<double> values_;
    std::size_t position_ = 0;
};

void serialize(Archive& archive, BeltTrace& trace)
{
    archive.serialize_all(trace.time, trace.duration, trace.force, trace.indentation, trace.peak_pressure, trace.area,
                          trace.removed_volume);
}

void serialize(Archive& archive, BeltError& error)
{
    archive.serialize_all(error.gouge, error.within, error.undercut, error.mean, error.rms, error.min);
}

void serialize(Archive& archive, RunningError& error)
{
    AssessmentCounts& counts = error.counts;
    archive.serialize_all(counts.gouge, counts.within, counts.undercut, counts.undefined);
    archive.serialize_all(error.sum, error.sum_squares, error.min);
}

void serialize(Archive& archive, removal::RemovalTrial& trial)
{
    archive.serialize_all(trial.force, trial.speed, trial.feed, trial.duration, trial.prior_work, trial.volume,
                          trial.deviation);
}

void serialize(Archive& archive, MeasuredPass& pass)
{
    serialize(archive, pass.trial);
    archive.serialize_all(pass.contact_volume, pass.sensitivity, pass.work, pass.feed_factor);
    archive.serialize(pass.parts, [&](removal::RemovalTrial& part) { serialize(archive, part); });
}

void serialize(Archive& archive, BeltCheckpoint& checkpoint)
{
    BeltState& state = checkpoint.state;
    BeltRun& run = state.run;
    WheelContactState& contact = state.contact;
    archive.serialize_all(state.next_point, checkpoint.displacement, run.removed);
    archive.serialize(run.trace, [&](BeltTrace& trace) { serialize(archive, trace); });
    archive.serialize(run.errors, [&](BeltError& error) { serialize(archive, error); });
    archive.serialize(run.passes, [&](MeasuredPass& pass) { serialize(archive, pass); });
    archive.serialize_all(run.removed_volume, run.work, run.near_edge, run.coarse_grids, run.max_cell_spacings);
    if (state.error) serialize(archive, *state.error);
    archive.serialize_all(contact.grid.cell_size, contact.grid.rows, contact.grid.columns, contact.pressure,
                          contact.previous);
}

std::string bytes_of(const std::vector<double>& values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

std::vector<double> values_of(std::string_view bytes)
{
    if (bytes.size() % sizeof(double) != 0) refuse_as_corrupt();
    std::vector<double> values(bytes.size() / sizeof(double));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

// Grid and pressures are those of a solver that has `cells` along each side, or has not yet solved a contact.
bool is_consistent(const WheelContactState& contact, Index cells)
{
    const ContactGrid& grid = contact.grid;
    const auto is_on_grid = [&](const Eigen::MatrixXd& pressure) {
        return pressure.size() == 0 || (pressure.rows() == grid.rows && pressure.cols() == grid.columns);
    };
    // A long contact's grid may have twice as many rows (press.cc), rounded up to multiples of eight.
    constexpr Index kMaxStretch = 2, kMaxRounding = 4;
    const bool has_grid = grid.rows > 0 && grid.rows <= kMaxStretch * cells + kMaxRounding && grid.columns > 0 &&
                          grid.columns <= cells + kMaxRounding && grid.cell_size.allFinite() &&
                          grid.cell_size.minCoeff() > 0;
    return (has_grid || (grid.rows == 0 && grid.columns == 0)) && is_on_grid(contact.pressure) &&
           is_on_grid(contact.previous);
}

bool is_consistent(const BeltCheckpoint& found, const BeltCheckpoint& initial, std::size_t path_length, Index cells)
{
    const BeltState& state = found.state;
    const BeltRun& run = state.run;
    const Index surfels = initial.displacement.size();
    return state.next_point <= path_length && run.trace.size() == state.next_point &&
           run.errors.size() == (initial.state.error ? state.next_point : 0) && run.removed.size() == surfels &&
           found.displacement.size() == surfels && is_consistent(state.contact, cells);
}

} // namespace

std::string run_digest(const Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                       const BeltOptions& options, const std::string& context)
{
    std::vector<double> values;
    const auto add = [&](auto... numbers) { (values.push_back(static_cast<double>(numbers)), ...); };
    const auto add_all = [&](const auto& matrix) {
        add(matrix.rows(), matrix.cols());
        for (const double value : matrix.reshaped()) values.push_back(value);
    };
    add_all(surfels.position);
    add_all(surfels.normal);
    add_all(surfels.displacement);
    add(path.size());
    for (const BeltPoint& point : path) {
        add_all(point.T_part_tool.matrix());
        add(point.load.by_force, point.load.value, point.feed, point.dwell, point.touches_down);
    }
    const BeltLaw& law = wheel.law;
    const ContactWheel::Serration& serration = wheel.serration;
    add(wheel.radius, wheel.width, wheel.crown_radius, wheel.layer.thickness, wheel.layer.young, wheel.layer.poisson,
        wheel.belt_speed, serration.pitch, serration.land, serration.depth, serration.angle, law.coefficient,
        law.pressure_exponent, law.speed_exponent, law.feed_exponent, law.threshold, law.dwell_exponent, law.wear_work);
    const ToleranceRange range = options.range.value_or(ToleranceRange{0, 0});
    const WheelContactOptions& contact = options.contact;
    add(contact.gridding, contact.cells_per_side, contact.tolerance, contact.solver, contact.elements, options.model,
        options.prior_work, options.range.has_value(), range.lower, range.upper);
    return core::sha256(bytes_of(values) + context);
}

std::string seal_journal(const std::string& digest, std::string_view numbers)
{
    const std::string contents = digest + '\n' + std::string(numbers);
    return std::string(kTitle) + core::sha256(contents) + '\n' + contents;
}

std::string encode_journal(const std::string& digest, BeltCheckpoint checkpoint)
{
    Archive archive;
    serialize(archive, checkpoint);
    return seal_journal(digest, bytes_of(archive.values()));
}

BeltCheckpoint decode_journal(std::string_view journal, const std::string& digest, const BeltCheckpoint& initial,
                              std::size_t path_length, Index cells_per_side)
{
    if (!journal.starts_with(kTitle))
        throw core::InputError(journal.starts_with(kTitleOfAnyVersion)
                                   ? "the journal is corrupt, or of another version of fettle-belt"
                                   : "not a journal of fettle-belt");
    journal.remove_prefix(kTitle.size());
    if (journal.size() < 2 * kDigestLine) refuse_as_corrupt();
    const std::string_view contents = journal.substr(kDigestLine);
    if (journal.substr(0, kDigestLine) != core::sha256(contents) + '\n') refuse_as_corrupt();
    if (contents.substr(0, kDigestLine) != digest + '\n')
        throw core::InputError("this is the journal of another run: its surfels, path, wheel or options differ");
    Archive archive(values_of(contents.substr(kDigestLine)));
    BeltCheckpoint found = initial;
    serialize(archive, found);
    if (!archive.is_at_end() || !is_consistent(found, initial, path_length, cells_per_side)) refuse_as_corrupt();
    return found;
}

} // namespace fettle::belt
