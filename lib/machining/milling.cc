#include "machining/milling.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "machining/limits.h"
#include "machining/sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace fettle::machining {
namespace {

/// Rows that one thread cuts at a time: half the rows that a cutter spans on a fine grid; enough bands for all threads.
constexpr Eigen::Index kBandRows = 64;

/// A move in a band of rows, and its engagement there.
struct Visit {
    std::size_t move;
    RemovedHeight cut{};
    double holder_depth = 0;
};

/// Range of rows of the field that a sweep can touch: first, and one past the last.
std::pair<Eigen::Index, Eigen::Index> row_range(const removal::HeightField& field, const Sweep& sweep)
{
    const auto bounded = [&](double row) {
        return static_cast<Eigen::Index>(std::clamp<double>(row, 0, field.rows()));
    };
    const double first = std::ceil((sweep.box_min.y() - field.origin.y()) / field.cell - 0.5);
    const double last = std::floor((sweep.box_max.y() - field.origin.y()) / field.cell - 0.5);
    return {bounded(first), bounded(last + 1)};
}

Sweep cutter_sweep(const Cutter& cutter, const std::vector<CutterMove>& moves, std::size_t m)
{
    const bool continues = m + 1 < moves.size() && moves[m + 1].rapid() == moves[m].rapid();
    return make_sweep(cutter, moves[m], m == 0, continues ? &moves[m + 1] : nullptr);
}

/// The holder's sweep is the whole move: following moves may cut the material that it would have collided with.
Sweep holder_sweep(const Holder& holder, CutterMove move)
{
    move.from.z() += holder.height;
    move.to.z() += holder.height;
    return make_sweep({holder.radius, holder.radius, 0, holder.radius, 0}, move, true, nullptr);
}

void clear_floor(Eigen::Ref<Eigen::ArrayXXd> z, double floor)
{
    if (!std::isfinite(floor)) return;
    z = (z <= floor).select(core::kNaN, z);
}

class Milling {
  public:
    Milling(removal::HeightField& stock, const Cutter& cutter, const std::vector<CutterMove>& moves,
            const MillingOptions& options)
        : stock_(stock), cutter_(cutter), moves_(moves), options_(options),
          bands_((stock.rows() + kBandRows - 1) / kBandRows)
    {
        for (std::size_t m = 0; m < moves.size(); ++m) {
            auto [first, end] = row_range(stock, cutter_sweep(cutter, moves, m));
            if (options.holder) {
                const auto [holder_first, holder_end] = row_range(stock, holder_sweep(*options.holder, moves[m]));
                if (holder_first < holder_end) {
                    first = first < end ? std::min(first, holder_first) : holder_first;
                    end = std::max(end, holder_end);
                }
            }
            for (Eigen::Index j = first; j < end; j = (j / kBandRows + 1) * kBandRows)
                bands_[j / kBandRows].push_back({m});
        }
    }

    std::vector<MoveEngagement> cut()
    {
        tbb::parallel_for(std::size_t{0}, bands_.size(), [this](std::size_t band) { cut_band(band); });
        std::vector<MoveEngagement> bites(moves_.size());
        const double area = stock_.cell * stock_.cell;
        for (const auto& band : bands_) // summed in the order of the bands: independent of the threads
            for (const Visit& visit : band) {
                MoveEngagement& bite = bites[visit.move];
                bite.volume += visit.cut.height * area;
                bite.depth = std::max(bite.depth, visit.cut.depth);
                bite.holder_depth = std::max(bite.holder_depth, visit.holder_depth);
            }
        return bites;
    }

  private:
    void cut_band(std::size_t band)
    {
        const Eigen::Index begin = band * kBandRows, end = std::min(begin + kBandRows, stock_.rows());
        double top = -core::kInfinity; // highest stock before the cut
        for (const double z : stock_.z.middleCols(begin, end - begin).reshaped())
            if (z > top) top = z;
        const auto within = [&](const Sweep& sweep) {
            const auto [first, last] = row_range(stock_, sweep);
            return std::pair(std::max(first, begin), std::min(last, end));
        };
        for (Visit& visit : bands_[band]) {
            const CutterMove& move = moves_[visit.move];
            const double lowest = std::min(move.from.z(), move.to.z());
            if (!(lowest < top)) continue;
            const Sweep sweep = cutter_sweep(cutter_, moves_, visit.move);
            const auto [first, last] = within(sweep);
            if (first < last) visit.cut = cut_rows(stock_, sweep, first, last, options_.floor);
            if (!options_.holder || !(lowest + options_.holder->height < top)) continue;
            const Sweep holder = holder_sweep(*options_.holder, move);
            const auto [from, to] = within(holder);
            if (from < to) visit.holder_depth = height_above_disc(stock_, holder, from, to).depth;
        }
        clear_floor(stock_.z.middleCols(begin, end - begin), options_.floor);
    }

    removal::HeightField& stock_;
    const Cutter& cutter_;
    const std::vector<CutterMove>& moves_;
    const MillingOptions& options_;
    std::vector<std::vector<Visit>> bands_;
};

} // namespace

std::vector<MoveEngagement> mill(removal::HeightField& stock, const Cutter& cutter,
                                 const std::vector<CutterMove>& moves, const MillingOptions& options)
{
    return Milling(stock, cutter, moves, options).cut();
}

void mill_fields(std::vector<removal::HeightField>& fields, const Cutter& cutter, const std::vector<CutterMove>& moves,
                 double floor)
{
    std::vector<Sweep> sweeps;
    for (std::size_t m = 0; m < moves.size(); ++m) sweeps.push_back(cutter_sweep(cutter, moves, m));
    tbb::parallel_for(std::size_t{0}, fields.size(), [&](std::size_t f) {
        removal::HeightField& field = fields[f];
        const double min_x = field.origin.x(), max_x = min_x + field.cell * field.columns();
        for (const Sweep& sweep : sweeps) {
            if (sweep.box_min.x() > max_x || sweep.box_max.x() < min_x) continue;
            const auto [first, end] = row_range(field, sweep);
            if (first < end) cut_rows(field, sweep, first, end, floor);
        }
        clear_floor(field.z, floor);
    });
}

Holder parse_holder(const std::string& text)
{
    const Eigen::VectorXd numbers = core::parse_number_list(text, {"the diameter", "the height over the tip"});
    if (!(numbers[0] > 0 && numbers[1] > 0)) throw core::InputError("both must be positive, got " + text);
    require_within("the diameter", numbers[0], kLengthRange);
    require_within("the height", numbers[1], kLengthRange);
    return {numbers[0] / 2, numbers[1]};
}

} // namespace fettle::machining
