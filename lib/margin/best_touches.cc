#include "margin/best_touches.h"

#include "job/boundary.h"
#include "margin/known_band.h"
#include "sampling/freeform.h"

#include <cmath>

namespace fettle {

BestTouches best_touches(const Scan& surface, const Job& job, const TouchSearch& search)
{
    HillClimb settings;
    settings.touches = search.touches > 0 ? search.touches : plan_freeform(job).size();
    settings.mutations = search.mutations;
    settings.sharpness = search.sharpness.value_or(std::log(100) / job.probe.accuracy);
    settings.seed = search.seed;
    // as fit_griddata: half the mean distance of the touches
    const double spacing = std::sqrt(area(boundaries(job).sampling) / static_cast<double>(settings.touches)) / 2;
    const KnownSurface known = touch_known_surface(surface, job, search.spacing);
    const SubsetError band = search.method == "griddata" ? griddata_band(known, spacing) : tensor_bspline_band(known);
    BestTouches best;
    best.candidates = known.candidates.cols();
    best.found = hill_climb(best.candidates, band, settings);
    best.plan = plan_of(job, known.candidates(Eigen::all, best.found.chosen).topRows<2>());
    return best;
}

} // namespace fettle
