#include "machining/milling.h"

#include "machining/sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace fettle {
namespace {

/// Rows that one thread cuts at a time: half of what a cutter spans on a fine grid, and enough bands for all threads.
constexpr Eigen::Index kRowsOfBand = 64;

/// A move in a band of rows, and what it met there.
struct Visit {
    std::size_t move;
    Lowered cut{};
    double holder_depth = 0;
};

/// Rows of the field that a sweep can touch: first and end.
std::pair<Eigen::Index, Eigen::Index> rows_of(const HeightField& field, const Sweep& sweep)
{
    const auto bounded = [&](double row) {
        return static_cast<Eigen::Index>(std::clamp(row, 0.0, static_cast<double>(field.rows())));
    };
    const double first = std::ceil((sweep.low.y() - field.origin.y()) / field.cell - 0.5);
    const double last = std::floor((sweep.high.y() - field.origin.y()) / field.cell - 0.5);
    return {bounded(first), bounded(last + 1)};
}

Sweep sweep_of_cutter(const Cutter& cutter, const std::vector<CutterMove>& moves, std::size_t m)
{
    const bool goes_on = m + 1 < moves.size() && moves[m + 1].rapid() == moves[m].rapid();
    return sweep_of(cutter, moves[m], m == 0, goes_on ? &moves[m + 1] : nullptr);
}

/// All of the holder's way: what it passes over may be cut later.
Sweep sweep_of_holder(const Holder& holder, CutterMove move)
{
    move.from.z() += holder.height;
    move.to.z() += holder.height;
    return sweep_of({holder.radius, holder.radius, 0, holder.radius, 0}, move, true, nullptr);
}

void clear_floor(Eigen::Ref<Eigen::ArrayXXd> z, double floor)
{
    if (!std::isfinite(floor)) return;
    z = (z <= floor).select(std::numeric_limits<double>::quiet_NaN(), z);
}

class Milling {
  public:
    Milling(HeightField& stock, const Cutter& cutter, const std::vector<CutterMove>& moves,
            const MillingOptions& options)
        : stock_(stock), cutter_(cutter), moves_(moves), options_(options),
          bands_(static_cast<std::size_t>((stock.rows() + kRowsOfBand - 1) / kRowsOfBand))
    {
        for (std::size_t m = 0; m < moves.size(); ++m) {
            auto [first, end] = rows_of(stock, sweep_of_cutter(cutter, moves, m));
            if (options.holder) {
                const auto [also, till] = rows_of(stock, sweep_of_holder(*options.holder, moves[m]));
                if (also < till) {
                    first = first < end ? std::min(first, also) : also;
                    end = std::max(end, till);
                }
            }
            for (Eigen::Index j = first; j < end; j = (j / kRowsOfBand + 1) * kRowsOfBand)
                bands_[static_cast<std::size_t>(j / kRowsOfBand)].push_back({m});
        }
    }

    std::vector<Bite> cut()
    {
        tbb::parallel_for(std::size_t{0}, bands_.size(), [this](std::size_t band) { cut_band(band); });
        std::vector<Bite> bites(moves_.size());
        const double area = stock_.cell * stock_.cell;
        for (const auto& band : bands_) // in the order of bands, whatever the threads
            for (const Visit& visit : band) {
                Bite& bite = bites[visit.move];
                bite.volume += visit.cut.height * area;
                bite.depth = std::max(bite.depth, visit.cut.depth);
                bite.holder_depth = std::max(bite.holder_depth, visit.holder_depth);
            }
        return bites;
    }

  private:
    void cut_band(std::size_t band)
    {
        const Eigen::Index begin = static_cast<Eigen::Index>(band) * kRowsOfBand;
        const Eigen::Index end = std::min(begin + kRowsOfBand, stock_.rows());
        double top = -std::numeric_limits<double>::infinity(); // of the stock, before
        for (const double z : stock_.z.middleCols(begin, end - begin).reshaped())
            if (z > top) top = z;
        const auto within = [&](const Sweep& sweep) {
            const auto [first, last] = rows_of(stock_, sweep);
            return std::pair(std::max(first, begin), std::min(last, end));
        };
        for (Visit& visit : bands_[band]) {
            const CutterMove& move = moves_[visit.move];
            const double lowest = std::min(move.from.z(), move.to.z());
            if (!(lowest < top)) continue;
            const Sweep sweep = sweep_of_cutter(cutter_, moves_, visit.move);
            const auto [first, last] = within(sweep);
            if (first < last) visit.cut = lower(stock_, sweep, first, last, options_.floor);
            if (!options_.holder || !(lowest + options_.holder->height < top)) continue;
            const Sweep held = sweep_of_holder(*options_.holder, move);
            const auto [from, to] = within(held);
            if (from < to) visit.holder_depth = over_disc(stock_, held, from, to).depth;
        }
        clear_floor(stock_.z.middleCols(begin, end - begin), options_.floor);
    }

    HeightField& stock_;
    const Cutter& cutter_;
    const std::vector<CutterMove>& moves_;
    const MillingOptions& options_;
    std::vector<std::vector<Visit>> bands_;
};

} // namespace

std::vector<Bite> mill(HeightField& stock, const Cutter& cutter, const std::vector<CutterMove>& moves,
                       const MillingOptions& options)
{
    return Milling(stock, cutter, moves, options).cut();
}

void mill_each(std::vector<HeightField>& fields, const Cutter& cutter, const std::vector<CutterMove>& moves,
               double floor)
{
    std::vector<Sweep> sweeps;
    for (std::size_t m = 0; m < moves.size(); ++m) sweeps.push_back(sweep_of_cutter(cutter, moves, m));
    tbb::parallel_for(std::size_t{0}, fields.size(), [&](std::size_t f) {
        HeightField& field = fields[f];
        const double least = field.origin.x(), most = least + field.cell * static_cast<double>(field.columns());
        for (const Sweep& sweep : sweeps) {
            if (sweep.low.x() > most || sweep.high.x() < least) continue;
            const auto [first, end] = rows_of(field, sweep);
            if (first < end) lower(field, sweep, first, end, floor);
        }
        clear_floor(field.z, floor);
    });
}

} // namespace fettle
