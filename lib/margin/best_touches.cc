#include "margin/best_touches.h"

#include "job/boundary.h"
#include "margin/known_band.h"
#include "sampling/freeform.h"

#include <cmath>

namespace fettle::margin {

BestTouches best_touches(const sampling::Scan& surface, const job::Job& job, const TouchSearch& search)
{
    sampling::HillClimbOptions settings;
    settings.touches = search.touches > 0 ? search.touches : sampling::plan_freeform(job).size();
    settings.mutations = search.mutations;
    settings.sharpness = search.sharpness.value_or(std::log(100) / job.probe.accuracy);
    settings.seed = search.seed;
    // The default of fit_griddata(): half the mean distance of the touches.
    const double spacing = std::sqrt(job::area(job::working_boundaries(job).sampling) / settings.touches) / 2;
    const KnownSurface known = touch_known_surface(surface, job, search.spacing);
    const sampling::SubsetError band =
        search.method == "griddata" ? griddata_band(known, spacing) : tensor_bspline_band(known);
    BestTouches best;
    best.candidates = known.candidates.cols();
    best.search_result = sampling::hill_climb(best.candidates, band, settings);
    best.plan = sampling::make_touch_plan(job, known.candidates(Eigen::all, best.search_result.chosen).topRows<2>());
    return best;
}

} // namespace fettle::margin
