#pragma once

#include "machining/cutter_path.h"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// Chords stand in for arcs out of the level and for helices; none is farther from its arc than this, mm.
inline constexpr double kArcChord = 1e-4;

/// A machine program as the cutter's tip follows it.
struct NcProgram {
    std::vector<CutterMove> moves; ///< the first stands at the first place that is known; rapids go straight
    std::map<std::string, std::size_t> without_motion; ///< words accepted as such ("M3", "S", "G54"), and how often
    /// Rapids while some coordinate was not known yet: not simulated.
    struct Unplaced {
        Eigen::Vector3d to; ///< NaN: not known
        std::size_t place;  ///< line
    };
    std::vector<Unplaced> unplaced;
    std::size_t chorded = 0; ///< arcs that were cut into chords
};

/// Reads G-code (ISO 6983, as NIST's RS274/NGC has it): G0 to G3 with centres (I J K, relative to the start) or radius
/// (R), G17 to G19, G20 and G21, G90 and G91, F in length a minute, comments, line numbers, %. Without motion: M3 to
/// M9, M30, S, T, G40, G43 (and H), G49, G54 to G59, G64 (and P), G80, G94. Ends of an arc that are not equally far
/// from its centre, but for the rounding of their digits, are joined by a spiral.
/// @throws InputError with the line, for any other word and whatever has no clear meaning
NcProgram parse_nc_program(std::string_view text, const std::string& source);

/// Does a text begin like a program, rather than a list of points?
bool looks_like_nc_program(std::string_view text);

} // namespace fettle
