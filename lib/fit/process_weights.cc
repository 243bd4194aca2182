#include "fit/process_weights.h"

#include "fit/bspline.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace fettle::fit {

namespace {

/// The longest cell side that represents a process. The rms error of the quasi-interpolant is 0.08 τ (h/ℓ)⁴ for the
/// squared exponential, limited to a tenth of σ, and 0.38 τ (h/ℓ)^(5/2) for Matérn's kernel, limited to 0.4 σ: it is
/// rougher within a cell than touches can resolve.
double max_cell_side(const Correlation& correlation, double ratio)
{
    return correlation.length *
           (correlation.kernel == Kernel::squared_exponential ? std::pow(ratio / 1.2, -0.25) : std::pow(ratio, -0.4));
}

} // namespace

surface::Bspline coarsen(const surface::Bspline& grid, double max_side)
{
    constexpr double kMinCells = 4;
    const Eigen::Array2d before = cell_counts(grid);
    const Eigen::Array2d side = before * grid.cell.array();
    return with_cell_counts(grid, (side / max_side).ceil().max(kMinCells).min(before));
}

ProcessWeights mixture_weights(const std::vector<Spectrum>& spectra)
{
    constexpr double kMinWeight = 0.01; // relative to the largest
    constexpr double kMinShare = 0.01;  // of the sum, for a correlation to matter
    const double best = min_score(spectra);
    ProcessWeights weights{std::vector<std::array<double, kNumRatios>>(spectra.size()), 0,
                           std::numeric_limits<double>::infinity()};
    std::vector<double> sums(spectra.size(), 0);
    for (std::size_t k = 0; k < spectra.size(); ++k)
        for (int i = 0; i < kNumRatios; ++i) {
            const double weight = std::exp((best - spectra[k].score[i]) / 2);
            sums[k] += weight;
            weights.relative[k][i] = weight < kMinWeight ? 0 : weight;
        }
    weights.sum = std::accumulate(sums.begin(), sums.end(), 0.0);
    for (std::size_t k = 0; k < spectra.size(); ++k)
        for (int i = 0; i < kNumRatios; ++i)
            if (sums[k] >= kMinShare * weights.sum && weights.relative[k][i] > 0)
                weights.cell = std::min(weights.cell, max_cell_side(spectra[k].correlation, amplitude_ratio(i)));
    return weights;
}

} // namespace fettle::fit
