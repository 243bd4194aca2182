#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/shift.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace fettle {

namespace {

// The surface bends between touches that are several cells of this grid apart: a finer one changes the extremes by
// less than the draws' scatter.
constexpr int kAcross = 16;
// Each draw is used with both signs. The 99 % quantile of 8192 then scatters by about 1 % of itself.
constexpr int kDraws = 4096;

// The field is smooth, so a few factors carry it: those below this share of the largest variance are rounding.
constexpr double kRounding = 1e-10;

/// F with F Fᵀ = covariance, few columns. By eigenvalues: rounding makes the small pivots of a factorisation negative.
Eigen::MatrixXd root(const Eigen::MatrixXd& covariance)
{
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance); // ascending
    const Eigen::VectorXd& variance = eigen.eigenvalues();
    const Eigen::Index rank = (variance.array() > kRounding * variance.maxCoeff()).count();
    return eigen.eigenvectors().rightCols(rank) * variance.tail(rank).cwiseSqrt().asDiagonal();
}

double quantile(std::vector<double> values, double share)
{
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

} // namespace

Prediction predict_by_posterior(const Surface& surface, const Job& job, double confidence, std::uint64_t seed,
                                const std::string& source)
{
    if (surface.covariance.size() == 0)
        throw InputError(source, "the surface has no covariance, so its error cannot be foreseen; use the method wang");
    const Eigen::Matrix2Xd grid = anomaly_grid(job, kAcross);
    const Eigen::MatrixXd gradients = height_gradients(surface.shape, grid);
    for (Eigen::Index i = 0; i < grid.cols(); ++i)
        if (!gradients.col(i).allFinite())
            throw InputError(source, "the surface does not cover the anomaly: it is not defined at " +
                                         place(grid.col(i), job.units));

    const Eigen::MatrixXd field = root(gradients.transpose() * surface.covariance * gradients);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> below, bands;
    Eigen::VectorXd errors(grid.cols());
    Eigen::VectorXd unit(field.cols());
    for (int draw = 0; draw < kDraws; ++draw) {
        for (double& number : unit) number = normal(random);
        errors.noalias() = field * unit;
        below.push_back(shift_distance(errors));
        below.push_back(errors.maxCoeff()); // of the opposite draw
        bands.push_back(error_band(errors));
    }
    return {"posterior", confidence, quantile(bands, confidence), quantile(below, confidence), false};
}

} // namespace fettle
