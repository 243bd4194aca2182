#pragma once

#include "cloud/cloud.h"
#include "machining/cutter_path.h"
#include "machining/milling.h"
#include "machining/nc_program.h"
#include "removal/height_field.h"
#include "json/document.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fettle::machining {

/// Moves that collide with the stock.
struct Collisions {
    std::size_t moves = 0;
    std::size_t first_source_line = 0; ///< CutterMove::place of the first; 0: none
    double depth = 0;                  ///< largest penetration, mm
};

/// Totals of a machining run. Volumes mm³, times s, rates mm³/s, lengths mm.
struct MillingSummary {
    double volume = 0, rapid_volume = 0; ///< removed by all moves, and by the rapid moves among them
    double feed_length = 0, rapid_length = 0;
    double feed_time = 0, rapid_time = 0;
    double cutting_time = 0;      ///< of feed moves that cut
    double mean_rate = 0;         ///< mean removal rate while cutting
    double peak_rate = 0;         ///< largest removal rate of one move
    double deepest_cut = 0;       ///< largest depth of a feed move, mm
    Collisions rapid_cuts;        ///< rapid moves through material
    Collisions holder_collisions; ///< moves with the holder in material
};

/// @param rapid_rate  speed of rapid moves, mm/s, positive
MillingSummary summarise(const std::vector<CutterMove>& moves, const std::vector<MoveEngagement>& bites,
                         double rapid_rate);

/// The report of fettle-mill. @param left  the stock after the cut
json::Value to_json(const MillingSummary& summary, const NcProgram& program, const removal::HeightField& left);

/// "WHAT: N, the first to PLACE 12; up to 0.3 mm deep", for a warning. @param place  "line" or "point"
std::string describe(const Collisions& collisions, const std::string& what, const std::string& place);

/// One point for each move, at its end. Fields: t (s), feed (mm/s), removed (largest depth, mm), volume (mm³), holder
/// (depth of the holder in material, mm) and place (CutterMove::place).
cloud::Cloud trace_of(const std::vector<CutterMove>& moves, const std::vector<MoveEngagement>& bites,
                      double rapid_rate);

} // namespace fettle::machining
