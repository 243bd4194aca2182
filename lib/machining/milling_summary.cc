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

/// s
double time_of(const CutterMove& move, double rapid_rate)
{
    return length(move) / (move.rapid() ? rapid_rate : move.feed);
}

json::Value to_json(const Clash& clash)
{
    return json::Value().set("moves", clash.moves).set("first_place", clash.first_place).set("depth", clash.depth);
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
            sum.rapid_time += time_of(move, rapid_rate);
            note(sum.rapid_cuts, move, bite.depth);
            continue;
        }
        const double time = time_of(move, rapid_rate);
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

json::Value to_json(const MillingSummary& sum)
{
    return json::Value()
        .set("removed_volume", sum.volume)
        .set("time", sum.feed_time + sum.rapid_time)
        .set("feed_time", sum.feed_time)
        .set("rapid_time", sum.rapid_time)
        .set("cutting_time", sum.cutting_time)
        .set("feed_length", sum.feed_length)
        .set("rapid_length", sum.rapid_length)
        .set("deepest_cut", sum.deepest_cut)
        .set("mean_removal_rate", sum.mean_rate)
        .set("peak_removal_rate", sum.peak_rate)
        .set("rapid_volume", sum.rapid_volume)
        .set("rapid_cuts", to_json(sum.rapid_cuts))
        .set("holder_collisions", to_json(sum.holder));
}

Cloud trace_of(const std::vector<CutterMove>& moves, const std::vector<Bite>& bites, double rapid_rate)
{
    const auto count = static_cast<Eigen::Index>(moves.size());
    Cloud cloud;
    cloud.xyz.resize(3, count);
    Eigen::VectorXd t(count), feed(count), removed(count), volume(count), holder(count), place(count);
    double now = 0;
    for (Eigen::Index m = 0; m < count; ++m) {
        const CutterMove& move = moves[static_cast<std::size_t>(m)];
        const Bite& bite = bites[static_cast<std::size_t>(m)];
        cloud.xyz.col(m) = move.to;
        t[m] = now += time_of(move, rapid_rate);
        feed[m] = move.rapid() ? rapid_rate : move.feed;
        removed[m] = bite.depth;
        volume[m] = bite.volume;
        holder[m] = bite.holder_depth;
        place[m] = static_cast<double>(move.place);
    }
    constexpr int kDouble = 8; // times and lines beyond what a float tells apart
    set_field(cloud, "t", t, kDouble);
    set_field(cloud, "feed", feed);
    set_field(cloud, "removed", removed);
    set_field(cloud, "volume", volume);
    set_field(cloud, "holder", holder);
    set_field(cloud, "place", place, kDouble);
    return cloud;
}

} // namespace fettle
