#pragma once

#include "cloud/cloud.h"
#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "machining/patch_error.h"
#include "machining/tool_path.h"
#include "mesh/mesh.h"
#include "json/document.h"

#include <cstddef>
#include <iosfwd>
#include <vector>

namespace fettle::machining {

/// A corrected path, and how many tips were moved. The tips are samples of the feed moves, no farther apart than the
/// machined vertices.
struct CorrectedPath {
    std::vector<CutterMove> moves; ///< `place` is that of the original move
    std::size_t shifted = 0;       ///< tips that were moved
    std::size_t blocked = 0;       ///< tips that could not be moved as wanted: the cutter would gouge the design
    std::size_t in_air = 0;        ///< tips where the cutter is farther than `reach` above the surface: air cuts
    std::size_t unknown = 0;       ///< tips without an error: undefined, or not above both machined surface and design
    double max_shift = 0;          ///< mm
};

/// Corrects a path by the errors of the surface that it machined (Guan & Xiong: errors of NC code are to be found and
/// corrected before the part is cut). At each tip the error mu is interpolated where the cutter touches the design
/// first, and the tip moves by -mu along the normal of that patch; tips without an error move as their neighbours do.
/// Then the tip is lifted, if necessary, so that the cutter does not gouge the design. This corrects wrong tip
/// positions: offsets, a forgotten allowance, chords between too few points, a path for another cutter or design. It
/// cannot correct what does not depend on tip positions: scallops between passes, material left in corners that are
/// too narrow for the cutter.
/// @param cutter   the cutter that made `machined`
/// @param errors   patch_errors(machined, design)
/// @param reach    largest distance, along the normal, of the cutter from the surface that it cut; the grid has such
///                 errors; mm
CorrectedPath correct(const std::vector<CutterMove>& moves, const Cutter& cutter, const mesh::Mesh& machined,
                      const mesh::Mesh& design, const PatchErrors& errors, double reach);

/// The numbers of moves and tips, and the largest shift.
json::Value to_json(const CorrectedPath& corrected);

/// The corrected tips with the fields of the original points, and `feed`. Contact points lose their fields, which
/// describe the contacts.
/// @param contacts  the path was given as contact points (CC)
cloud::Cloud corrected_points(const ToolPath& path, const CorrectedPath& corrected, bool contacts);

/// Writes the program with the corrected moves. Line numbers, F and the words of coordinates and motions are written
/// anew (G90, G17); everything else, comments included, is copied.
void write_corrected(std::ostream& out, const ToolPath& path, const CorrectedPath& corrected);

} // namespace fettle::machining
