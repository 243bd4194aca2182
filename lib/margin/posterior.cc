#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/field_draws.h"
#include "margin/shift.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle {

namespace {

// The surface bends between touches that are several cells of this grid apart: a finer one changes the extremes by
// less than the draws' scatter.
constexpr int kAcross = 16;
// The 99 % quantile of so many then scatters by about 1 % of itself.
constexpr int kDraws = 8192;

double quantile(std::vector<double> values, double share)
{
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

/// @throws InputError if the most probable shape is not defined all over B
void refuse_gaps(const Surface& surface, const Eigen::Matrix2Xd& grid, const Units& units, const std::string& source)
{
    const Eigen::MatrixXd gradients = height_gradients(surface.shape, grid);
    for (Eigen::Index i = 0; i < grid.cols(); ++i)
        if (!gradients.col(i).allFinite())
            throw InputError(source, "the surface does not cover the anomaly: it is not defined at " +
                                         place(grid.col(i), units));
}

} // namespace

Prediction predict_by_posterior(const Surface& surface, const Job& job, double confidence, std::uint64_t seed,
                                const std::string& source)
{
    if (!knows_sigma(surface))
        throw InputError(source, "the surface has no covariance, so its error cannot be foreseen; use the method wang");
    const Eigen::Matrix2Xd grid = anomaly_grid(job, kAcross);
    refuse_gaps(surface, grid, job.units, source);
    const Eigen::MatrixXd fields = draw_fields(surface, grid, kDraws, seed);
    std::vector<double> below, bands;
    for (const auto& field : fields.colwise()) {
        below.push_back(field.maxCoeff()); // the shift distance of its opposite: the mean's error against it
        bands.push_back(error_band(field));
    }
    return {"posterior", confidence, quantile(bands, confidence), quantile(below, confidence), false};
}

} // namespace fettle
