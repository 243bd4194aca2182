#pragma once

#include "fit/process_spectrum.h"
#include "surface/surface.h"

#include <array>
#include <vector>

namespace fettle::fit {

/// Likelihoods of the correlations and amplitudes, relative to the largest one.
struct ProcessWeights {
    std::vector<std::array<double, kNumRatios>> relative; ///< for each correlation and amplitude; 0 where negligible
    double sum = 0;
    double cell = 0; ///< cell side that represents all correlations that matter, mm
};

ProcessWeights mixture_weights(const std::vector<Spectrum>& spectra);

/// A grid over the same rectangle with cells up to `max_side` mm, but no finer than before.
surface::Bspline coarsen(const surface::Bspline& grid, double max_side);

} // namespace fettle::fit
