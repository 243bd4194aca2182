#pragma once

#include "fit/family.h"

#include <optional>
#include <string>
#include <vector>

namespace fettle::fit {

// Heights of a scan do not deviate from a family independently: part and scanner have waves. So they are
//     z = f(θ) + g + e
// with a family f, linear in θ near the fit, a Gaussian process g and noise e. The correlation and amplitude of g are
// integrated out as in process.h, and so is what the noise exceeds its estimate by.
//
// Nothing tells the part's waves from the scanner's. Those shorter than half of B cannot be predicted beneath it either
// way; they are taken for the part's and for the scanner's with the same probability, so that beside B the surface
// follows them half, and its standard deviation is that half.

/// A family with waves.
struct WavyFamily {
    FitCandidate with_waves;        ///< f + g on a bicubic B-spline grid; its score holds for both
    FitCandidate without_waves;     ///< f alone, wrong by what the waves pull it
    double scanner_probability = 0; ///< that `without_waves` is the part
};

/// @param grid  over B and the heights, the finest to be used    @param anomaly_size  longer side of B, mm
/// @return  nothing if the heights do not determine the family
std::optional<WavyFamily> fit_wavy_family(const std::string& name, const TouchSet& touches,
                                          const surface::Bspline& grid, double anomaly_size);

/// The standard deviation of the heights about any smooth surface, at least touches.sigma, mm: the most probable one
/// for a process on a quadratic.
double noise_about_process(const TouchSet& touches);

} // namespace fettle::fit
