#pragma once

#include "cloud/cloud.h"
#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "machining/patch_error.h"
#include "machining/tool_path.h"
#include "mesh/mesh.h"

#include <cstddef>
#include <iosfwd>
#include <vector>

namespace fettle {

/// A path whose errors are taken back, and what became of its tips: those of feed moves, no farther apart than the
/// machined vertices.
struct CorrectedPath {
    std::vector<CutterMove> moves; ///< places are those of the moves that they stand for
    std::size_t shifted = 0;       ///< tips that go elsewhere
    std::size_t held = 0; ///< of them, those that the design keeps, by more than `reach`, from going where they should
    std::size_t in_air = 0;    ///< tips that are not those that cut what is under them
    std::size_t unknown = 0;   ///< tips whose error is not known: undefined, or not over machined surface and design
    double greatest_shift = 0; ///< mm
};

/// Corrects a path by the errors of what it machined (Guan & Xiong: errors of NC code are to be found and corrected
/// before the part is cut). Where the cutter, at a tip, touches the design first, the part's error mu, out of the
/// errors at the machined vertices around, shifts the tip by -mu along the normal of the patch; where it is not known
/// tips go as their neighbours do. Then the tip goes up, if it has to, so that the cutter does not dig into the design.
/// This takes back what is wrong with the tips' places: offsets, an allowance that was forgotten, chords of too few
/// points, a path that was made for another cutter or design. It cannot take back what the tips' places do not decide:
/// ridges between passes, rests in corners that are too narrow for the cutter.
/// @param cutter   the one that cut
/// @param errors   patch_errors(machined, design)
/// @param reach    how far, along the normal, the cutter may be from what it cut, by the grid's errors; mm
CorrectedPath correct(const std::vector<CutterMove>& moves, const Cutter& cutter, const Mesh& machined,
                      const Mesh& design, const PatchErrors& errors, double reach);

/// The corrected tips in the place of a path's points, with their fields, and `feed`. Of contact points only the feeds
/// are kept.
Cloud corrected_points(const ToolPath& path, const CorrectedPath& corrected, bool contacts);

/// The program with the corrected moves: all else stays as it stands, comments, too, but for line numbers, F, and the
/// words of places and motions, which are written anew (G90, G17).
void write_corrected(std::ostream& out, const ToolPath& path, const CorrectedPath& corrected);

} // namespace fettle
