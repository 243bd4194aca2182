#include "machining/milling_summary.h"

#include <algorithm>

namespace fettle {
namespace {

/// A cutter that goes back over its own surface meets it, by rounding, a little; no cut is as thin. mm
constexpr double kContact = 1e-6;

void note(Clash& clash, const CutterMove& move, double depth)
{
    if (!(depth > kContact)) return;
    if (clash.moves++ == 0) clash.first_place = move.place;
    clash.depth = std::max(clash.depth, depth);
}

} // namespace

MillingSummary summarise(const std::vector<CutterMove>& moves, const std::vector<Bite>& bites, double rapid_rate)
{
    MillingSummary sum;
    double cut_by_feed = 0;
    for (std::size_t m = 0; m < moves.size(); ++m) {
        const CutterMove& move = moves[m];
        const Bite& bite = bites[m];
        const double way = length(move);
        sum.volume += bite.volume;
        note(sum.holder, move, bite.holder_depth);
        if (move.rapid()) {
            sum.rapid_volume += bite.volume;
            sum.rapid_length += way;
            sum.rapid_time += way / rapid_rate;
            note(sum.rapid_cuts, move, bite.depth);
            continue;
        }
        const double time = way / move.feed;
        sum.feed_length += way;
        sum.feed_time += time;
        sum.deepest_cut = std::max(sum.deepest_cut, bite.depth);
        if (!(bite.depth > kContact)) continue;
        sum.cutting_time += time;
        cut_by_feed += bite.volume;
        if (time > 0) sum.peak_rate = std::max(sum.peak_rate, bite.volume / time);
    }
    if (sum.cutting_time > 0) sum.mean_rate = cut_by_feed / sum.cutting_time;
    return sum;
}

} // namespace fettle
