#pragma once

#include "job/job.h"

namespace fettle::plan {

/// Heights of the layers above the desired surface (Wang 2007, 5.3.1). A layer is a raised copy of the surface.
struct Layers {
    double thickness = 0; ///< (F_max - F_min)/k, eq. 5-1, mm
    double distance = 0;  ///< between the lower boundaries of adjacent layers, (F_max - F_down)/k, eq. 5-2, mm
    /// 1: F_down is above the mean of F_min and F_max, the layers overlap more; 2: below it, they overlap less; 3:
    /// equal.
    int overlap_case = 3;
};

Layers compute_layers(const job::ForceRange& force);

/// Height of the reference surface of a layer (1, 2, …) above the desired surface, mm (eq. 5-3).
double reference_offset(const Layers& layers, int layer);

} // namespace fettle::plan
