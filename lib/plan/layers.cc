#include "plan/layers.h"

#include <cmath>

namespace fettle::plan {

Layers compute_layers(const job::ForceRange& force)
{
    // Equal forces may differ by the rounding of the conversion from lbf.
    constexpr double kRelativeForceRounding = 1e-12;
    const double mean = 0.5 * (force.min + force.max);
    const bool equal = std::abs(force.down - mean) <= kRelativeForceRounding * force.max;
    const int overlap_case = equal ? 3 : (force.down > mean ? 1 : 2);
    return {(force.max - force.min) / force.stiffness, (force.max - force.down) / force.stiffness, overlap_case};
}

double reference_offset(const Layers& layers, int layer) { return (layer - 1) * layers.distance; }

} // namespace fettle::plan
