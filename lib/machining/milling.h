#pragma once

#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "removal/height_field.h"

#include <limits>
#include <optional>
#include <vector>

namespace fettle {

/// What is above the cutter: a cylinder about its axis that must not touch.
struct Holder {
    double radius = 0; ///< mm
    double height = 0; ///< of its lower side over the tip, mm
};

struct MillingOptions {
    double floor = -std::numeric_limits<double>::infinity(); ///< there is nothing to cut below this z, mm
    std::optional<Holder> holder;
};

/// What one move met. Material goes to the move that comes nearest to it while the cutter is in one run of feed moves,
/// or of rapid ones.
struct Bite {
    double volume = 0;       ///< removed, mm³
    double depth = 0;        ///< greatest height removed at one place, mm
    double holder_depth = 0; ///< greatest height of material above the holder's lower side, after the cut, mm
};

/// Cuts the stock along the moves, one after the other. Each cell's centre comes to the lowest z at which the cutter's
/// lower side passes over it, which is computed from the whole move, not from positions along it: in closed form
/// but for bull-nose cutters on slopes, whose equation of degree four is solved by Newton's method. Where that is at or
/// below the floor nothing is left (NaN).
/// @param stock  in M (theta 0)
/// @return  of each move; volumes over all are those that the stock has lost
std::vector<Bite> mill(HeightField& stock, const Cutter& cutter, const std::vector<CutterMove>& moves,
                       const MillingOptions& options = {});

/// Cuts other maps of the same stock, without an account.
void mill_each(std::vector<HeightField>& fields, const Cutter& cutter, const std::vector<CutterMove>& moves,
               double floor);

} // namespace fettle
