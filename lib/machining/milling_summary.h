#pragma once

#include "cloud/cloud.h"
#include "machining/cutter_path.h"
#include "machining/milling.h"
#include "json/document.h"

#include <cstddef>
#include <vector>

namespace fettle {

/// Moves that met what they must not.
struct Clash {
    std::size_t moves = 0;
    std::size_t first_place = 0; ///< CutterMove::place of the first; 0: none
    double depth = 0;            ///< greatest, mm
};

/// What a machining run came to. Volumes mm³, times s, rates mm³/s, lengths mm.
struct MillingSummary {
    double volume = 0, rapid_volume = 0; ///< removed by all moves, and by rapid ones among them
    double feed_length = 0, rapid_length = 0;
    double feed_time = 0, rapid_time = 0;
    double cutting_time = 0; ///< of feed moves that met material
    double mean_rate = 0;    ///< of removal while cutting
    double peak_rate = 0;    ///< of one move
    double deepest_cut = 0;  ///< of a feed move
    Clash rapid_cuts, holder;
};

/// @param rapid_rate  mm/s, positive
MillingSummary summarise(const std::vector<CutterMove>& moves, const std::vector<Bite>& bites, double rapid_rate);

json::Value to_json(const MillingSummary& summary);

/// A point where each move ends: when it is there (t, s), the feed there, the greatest height removed at one place, the
/// volume removed, how deep the holder was in material (mm, mm³), and the place in the program.
Cloud trace_of(const std::vector<CutterMove>& moves, const std::vector<Bite>& bites, double rapid_rate);

} // namespace fettle
