#pragma once

#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "removal/height_field.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fettle::machining {

/// Tool holder: a cylinder about the cutter's axis, upwards from `height`, that must not touch the stock.
struct Holder {
    double radius = 0; ///< mm
    double height = 0; ///< height of its lower side above the tip, mm
};

/// Parses "D,HEIGHT", mm. @throws InputError
Holder parse_holder(const std::string& text);

struct MillingOptions {
    double floor = -std::numeric_limits<double>::infinity(); ///< bottom of the stock: nothing is cut below this z, mm
    std::optional<Holder> holder;
};

/// Engagement of one move. Within a run of feed moves, or of rapid moves, each column of material is assigned to the
/// move that comes nearest to it.
struct MoveEngagement {
    double volume = 0;       ///< removed volume, mm³
    double depth = 0;        ///< largest height removed in one cell, mm
    double holder_depth = 0; ///< largest height of material above the holder's lower side, after the cut, mm
};

/// Cuts the stock along the moves, one after the other. The height at each cell's centre becomes the lowest z at which
/// the cutter's lower side passes over it. That is computed from the whole move, not from samples of it: in closed form
/// except for bull-nose cutters on slopes, whose quartic equation is solved by Newton's method. Cells at or below the
/// floor become empty (NaN).
/// @param stock  frame M (theta 0)
/// @return  one entry for each move; the sum of the volumes is the volume lost by the stock
std::vector<MoveEngagement> mill(removal::HeightField& stock, const Cutter& cutter,
                                 const std::vector<CutterMove>& moves, const MillingOptions& options = {});

/// Cuts several height fields of the same stock along the same moves, without results for the moves.
void mill_fields(std::vector<removal::HeightField>& fields, const Cutter& cutter, const std::vector<CutterMove>& moves,
                 double floor);

} // namespace fettle::machining
