#include "machining/milling_summary.h"

#include "core/text.h"

#include <algorithm>

namespace fettle::machining {
namespace {

/// Smaller depths are rounding, as when a cutter passes again over its own surface, mm.
constexpr double kMinDepth = 1e-6;

void add_collision(Collisions& collisions, const CutterMove& move, double depth)
{
    if (!(depth > kMinDepth)) return;
    if (collisions.moves++ == 0) collisions.first_source_line = move.source_line;
    collisions.depth = std::max(collisions.depth, depth);
}

/// Duration of a move, s.
double duration(const CutterMove& move, double rapid_rate)
{
    return length(move) / (move.rapid() ? rapid_rate : move.feed);
}

json::Value to_json(const Collisions& collisions)
{
    return json::Value()
        .set("moves", collisions.moves)
        .set("first_place", collisions.first_source_line)
        .set("depth", collisions.depth);
}

} // namespace

MillingSummary summarise(const std::vector<CutterMove>& moves, const std::vector<MoveEngagement>& bites,
                         double rapid_rate)
{
    MillingSummary sum;
    double feed_volume = 0;
    for (std::size_t m = 0; m < moves.size(); ++m) {
        const CutterMove& move = moves[m];
        const MoveEngagement& bite = bites[m];
        const double distance = length(move), time = duration(move, rapid_rate);
        sum.volume += bite.volume;
        add_collision(sum.holder_collisions, move, bite.holder_depth);
        if (move.rapid()) {
            sum.rapid_volume += bite.volume;
            sum.rapid_length += distance;
            sum.rapid_time += time;
            add_collision(sum.rapid_cuts, move, bite.depth);
            continue;
        }
        sum.feed_length += distance;
        sum.feed_time += time;
        sum.deepest_cut = std::max(sum.deepest_cut, bite.depth);
        if (!(bite.depth > kMinDepth)) continue;
        sum.cutting_time += time;
        feed_volume += bite.volume;
        if (time > 0) sum.peak_rate = std::max(sum.peak_rate, bite.volume / time);
    }
    if (sum.cutting_time > 0) sum.mean_rate = feed_volume / sum.cutting_time;
    return sum;
}

json::Value to_json(const MillingSummary& sum, const NcProgram& program, const removal::HeightField& left)
{
    json::Value words;
    for (const auto& [word, count] : program.non_motion_words) words.set(word, count);
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
        .set("holder_collisions", to_json(sum.holder_collisions))
        .set("moves", program.moves.size())
        .set("unplaced_rapids", program.unplaced_rapids.size())
        .set("chorded_arcs", program.chorded_arcs)
        .set("arc_chord_error", kArcChordTolerance)
        .set("words_without_motion", words)
        .set("columns", static_cast<int>(left.columns()))
        .set("rows", static_cast<int>(left.rows()))
        .set("step", left.cell)
        .set("cells_without_material", static_cast<double>(left.z.isNaN().count()));
}

std::string describe(const Collisions& collisions, const std::string& what, const std::string& place)
{
    return what + ": " + std::to_string(collisions.moves) + ", the first to " + place + " " +
           std::to_string(collisions.first_source_line) + "; up to " + core::to_short_text(collisions.depth) +
           " mm deep";
}

cloud::Cloud trace_of(const std::vector<CutterMove>& moves, const std::vector<MoveEngagement>& bites, double rapid_rate)
{
    const Eigen::Index count = moves.size();
    cloud::Cloud cloud;
    cloud.xyz.resize(3, count);
    Eigen::VectorXd t(count), feed(count), removed(count), volume(count), holder(count), place(count);
    double now = 0;
    for (Eigen::Index m = 0; m < count; ++m) {
        const CutterMove& move = moves[m];
        const MoveEngagement& bite = bites[m];
        cloud.xyz.col(m) = move.to;
        t[m] = now += duration(move, rapid_rate);
        feed[m] = move.rapid() ? rapid_rate : move.feed;
        removed[m] = bite.depth;
        volume[m] = bite.volume;
        holder[m] = bite.holder_depth;
        place[m] = move.source_line;
    }
    constexpr int kDouble = 8; // bytes: a float is too coarse for times and line numbers
    cloud::set_field(cloud, "t", t, kDouble);
    cloud::set_field(cloud, "feed", feed);
    cloud::set_field(cloud, "removed", removed);
    cloud::set_field(cloud, "volume", volume);
    cloud::set_field(cloud, "holder", holder);
    cloud::set_field(cloud, "place", place, kDouble);
    return cloud;
}

} // namespace fettle::machining
