#pragma once

#include "belt/press.h"
#include "core/progress.h"

#include <vector>

namespace fettle {

/// A contact point of a belt path.
struct BeltPoint {
    Eigen::Isometry3d T_part_tool; ///< NaN: the wheel is off the part; the next point begins another run
    Pressing pressing;
    double feed = 0;  ///< V_w, mm/s
    double dwell = 0; ///< time that it stands there, besides, s
};

/// What happened at a contact point; NaN where the wheel is off the part.
struct BeltTrace {
    double time = 0; ///< since the start, at the point's end, s
    double duration = 0, force = 0, indentation = 0, peak_pressure = 0, area = 0;
    double removed = 0; ///< mm³, by the law over the contact
};

/// The account of a run.
struct BeltRun {
    std::vector<BeltTrace> trace;
    Eigen::VectorXd removed;    ///< of each surfel, mm along its normal
    double removed_volume = 0;  ///< mm³
    Eigen::Index near_edge = 0; ///< points whose contact is near the layer's free edge
};

/// Grinds along a path. At each point the surfels that touch lose depth along their normals by the wheel's law, in the
/// time that half the ways to its neighbours take; the others stay as they are. The law gives the depth normal to the
/// tangent plane, so that the pressure's sum is the force's work whatever the surfels' normals (Ren et al. 2006, 4).
/// @param worn  what the belt has removed before, mm³
/// @throws InputError naming the point if nothing is under the wheel, or the contact is not found
BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
              const PressOptions& options, double worn = 0, const Progress& progress = {});

} // namespace fettle
