#pragma once

#include "fit/process_spectrum.h"
#include "surface/surface.h"

#include <array>
#include <vector>

namespace fettle::fit {

/// Likelihoods of the correlations and amplitudes to some power, relative to the largest one.
struct ProcessWeights {
    std::vector<std::array<double, kNumRatios>> relative; ///< for each correlation and amplitude; 0 where negligible
    double sum = 0;
    double cell = 0; ///< cell side that represents all correlations that matter, mm
};

ProcessWeights mixture_weights(const std::vector<Spectrum>& spectra, double power = 1);

/// Number of touches whose evidence about waves counts in full: those of Wang's layout of two lines each way, with
/// which the margin of a process is calibrated on scans.
inline constexpr int kFullEvidenceTouches = 16;

/// Power of the restricted likelihood of waves by which it has no more degrees of freedom than that of
/// kFullEvidenceTouches (coarsened posterior: Miller and Dunson 2019). A part is not stationary: more touches beside B
/// determine the waves there ever better, but hardly those inside it.
/// @param trend  number of parameters of what the waves are about
double evidence_power(Eigen::Index touches, Eigen::Index trend);

/// A grid over the same rectangle with cells up to `max_side` mm, but no finer than before.
surface::Bspline coarsen(const surface::Bspline& grid, double max_side);

} // namespace fettle::fit
