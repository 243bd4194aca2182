#include "plan/layers.h"

#include <cmath>

namespace fettle {

Layers layers_of(const ForceRange& force)
{
    // Forces in lbf or N that were meant to be equal differ by rounding.
    constexpr double kSameForce = 1e-12;
    const double mean = 0.5 * (force.min + force.max);
    const bool equal = std::abs(force.down - mean) <= kSameForce * force.max;
    return {(force.max - force.min) / force.stiffness, (force.max - force.down) / force.stiffness,
            equal               ? 3
            : force.down > mean ? 1
                                : 2};
}

double reference_offset(const Layers& layers, int layer) { return (layer - 1) * layers.distance; }

} // namespace fettle
