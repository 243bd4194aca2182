#pragma once

#include "machining/cutter_path.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::machining {

/// Largest deviation of the chords that replace helices, spirals and arcs outside horizontal planes, mm.
inline constexpr double kArcChordTolerance = 1e-4;

/// The path of the cutter's tip in an NC program.
struct NcProgram {
    std::vector<CutterMove> moves; ///< the first one is the first known position; rapid moves are straight
    /// Words without effect on the path ("M3", "S", "G54") and their counts.
    std::map<std::string, std::size_t> non_motion_words;
    /// A rapid move before all coordinates are known: it cannot be simulated.
    struct UnplacedRapid {
        Eigen::Vector3d to;      ///< mm; NaN: not known
        std::size_t source_line; ///< line of the program
    };
    std::vector<UnplacedRapid> unplaced_rapids;
    std::size_t chorded_arcs = 0; ///< number of arcs replaced by chords
    std::size_t assumed_unit = 0; ///< line of the first coordinates before any G20 or G21: read as mm; 0: none
    std::size_t tool_change = 0;  ///< line of the first change of the tool (M6) after a feed move; 0: none
};

/// A warning if the program has coordinates before it says their unit; else empty. A control takes them in a unit that
/// its configuration sets.
std::string unit_warning(const NcProgram& program);

/// Reads G-code (ISO 6983; NIST RS274/NGC): G0 to G3 with a centre (I J K, relative to the start) or radius (R), G17 to
/// G19, G20 and G21, G90 and G91, F in length per minute, comments, line numbers, %. Accepted without effect: M0 to M9,
/// M30, M48, M49, M60, S, T, G4 (with P), G40, G61, G61.1, G64 (with P and Q), G80, G91.1, G94, G97 to G99. If the ends
/// of an arc are not equally far from its centre, within the rounding of their digits, they are joined by a spiral.
///
/// Positions are those of the tip in the program's coordinate system (G54 to G59), with the tool length offset that it
/// sets (G43 with H, G49). Offsets are in the control's tables and not in the program: all moves must be in one
/// coordinate system, and all with a known Z under one length offset.
/// @param start  the tip before the first move, mm, in the program's coordinates; nothing: not known
/// @throws InputError with the line, for any other word and for ambiguous input
NcProgram parse_nc_program(std::string_view text, const std::string& source,
                           const std::optional<Eigen::Vector3d>& start = std::nullopt);

/// Whether a text begins like an NC program, rather than a list of points.
bool looks_like_nc_program(std::string_view text);

} // namespace fettle::machining
