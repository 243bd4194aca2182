#include "find/ring_fit.h"

#include "core/cholesky.h"
#include "core/decompositions.h"
#include "geometry/quantiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fettle::find {
namespace {

using Eigen::Index;

constexpr Index kMaxRingPoints = 450;     // more, evenly left out, change the surface by less than its own error
constexpr double kCorrelatedCells = 6;    // points that stand for an independent one: smoothing scanners correlate
constexpr double kMinPointsPerTerm = 2.5; // independent ones
constexpr std::size_t kHighestDegree = 4; // the highest
constexpr Index kMaxTerms = 15;           // of that

// The start: least median (here the 0.6 quantile) of absolute residuals (Rousseeuw 1984) over the whole ring and over
// eight rings with a third of the directions left out, as a part's edge lies on one side. A partial ring must be better
// by this factor, since it chose among eight.
constexpr int kSectors = 8;
constexpr double kSectorHalfAngle = std::numbers::pi / 3;
constexpr double kStartQuantile = 0.6, kQuantilePerSigma = 1.2;
constexpr double kPartialGain = 0.85;
constexpr int kStartIterations = 3, kRefineIterations = 6;
// The start is a quadratic from so many independent points on, and then a plane's or a quadratic's terms have at least
// so many points each: half of them may be outliers.
constexpr double kMinQuadraticPoints = 15, kMinStartPointsPerTerm = 3;
// The first refinements measure the spread of the start's inliers; by then the residuals can tell inliers themselves.
constexpr int kStartInlierIterations = 2;

constexpr double kStartCutoff = 5, kCutoff = 4.5, kInlierCutoff = 6; // Tukey's, in standard deviations
constexpr double kMinWeight = 0.05;                                  // below it a point is an outlier
constexpr double kMinSigmas = 0.5;                                   // a residual spread below half the noise is chance
constexpr double kMinShare = 1e-3;                                   // of a polynomial in the average
constexpr double kRingRidge = 1e-9;                                  // of the trace: fixes what few points leave open
constexpr double kMinSpread = 1e-9;       // mm: of a made ring that is fitted exactly, so that weights stay finite
constexpr double kMinEigenvalue = 1e-300; // above 0: the inverse stays finite where all weights are 0

Index terms_of(int degree) { return Index(degree + 1) * (degree + 2) / 2; }

/// Monomials x^a y^b of total degree up to `degree`; those of a lower degree come first.
void monomials(double x, double y, int degree, double* row)
{
    row[0] = 1;
    Index k = 1;
    for (int total = 1; total <= degree; ++total) { // each row of Pascal's triangle from the one above it
        const Index above = k - total;
        for (int b = 0; b < total; ++b) row[k++] = row[above + b] * x;
        row[k++] = row[above + total - 1] * y;
    }
}

Eigen::MatrixXd basis(const Eigen::Matrix2Xd& xy, int degree)
{
    Eigen::MatrixXd transposed(terms_of(degree), xy.cols());
    for (Index i = 0; i < xy.cols(); ++i) monomials(xy(0, i), xy(1, i), degree, transposed.col(i).data());
    return transposed.transpose();
}

Eigen::MatrixXd normal_matrix(const Eigen::MatrixXd& A, const Eigen::VectorXd& weights)
{
    // Of some hundred rows and no more than 15 columns, products of columns take half the time of a blocked one.
    Eigen::MatrixXd G(A.cols(), A.cols());
    Eigen::VectorXd weighted(A.rows());
    for (Index j = 0; j < A.cols(); ++j) {
        weighted = weights.cwiseProduct(A.col(j));
        for (Index i = j; i < A.cols(); ++i) G(i, j) = G(j, i) = A.col(i).dot(weighted);
    }
    G.diagonal().array() += kRingRidge * std::max(G.trace(), kRingRidge);
    return G;
}

/// Weighted least squares. LDLT: the ridge makes the matrix definite.
Eigen::VectorXd solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& z, const Eigen::VectorXd& weights)
{
    return core::solve_ldlt(normal_matrix(A, weights), A.transpose() * (weights.array() * z.array()).matrix());
}

double quantile_of_sizes(const Eigen::VectorXd& residuals, double share)
{
    std::vector<double> sizes(residuals.begin(), residuals.end());
    for (double& size : sizes) size = std::abs(size);
    return geometry::quantile(sizes, share);
}

Eigen::VectorXd biweights(const Eigen::VectorXd& residuals, double cutoff)
{
    return (1 - (residuals.array() / cutoff).square()).max(0).square();
}

struct Ring {
    Eigen::Matrix2Xd xy; // scaled
    Eigen::VectorXd z;   // about its median
    Eigen::VectorXd near;
    double sigma;
    double independent; // number of independent points
};

/// Points by direction: 1, or 0 within a sector.
Eigen::VectorXd outside_sector(const Ring& ring, int sector)
{
    const double turn = sector * 2 * std::numbers::pi / kSectors;
    const Eigen::RowVector2d middle(std::cos(turn), std::sin(turn));
    const Eigen::RowVectorXd along = middle * ring.xy, limit = std::cos(kSectorHalfAngle) * ring.xy.colwise().norm();
    return (along.array() < limit.array()).cast<double>().transpose();
}

/// Weights to start from.
Eigen::VectorXd start_weights(const Ring& ring)
{
    const Eigen::MatrixXd A = basis(ring.xy, ring.independent > kMinQuadraticPoints ? 2 : 1);
    Eigen::VectorXd best;
    double best_quantile = std::numeric_limits<double>::infinity();
    for (int sector = -1; sector < kSectors; ++sector) {
        const Eigen::VectorXd chosen = sector < 0 ? Eigen::VectorXd::Ones(ring.z.size()) : outside_sector(ring, sector);
        if (chosen.sum() < kMinStartPointsPerTerm * double(A.cols())) continue;
        Eigen::VectorXd weights = chosen, residuals;
        for (int iteration = 0; iteration < kStartIterations; ++iteration) {
            residuals = ring.z - A * solve(A, ring.z, weights.cwiseProduct(ring.near));
            if (iteration + 1 == kStartIterations) break;
            std::vector<double> sizes;
            for (Index i = 0; i < residuals.size(); ++i)
                if (chosen[i] > 0) sizes.push_back(std::abs(residuals[i]));
            const double spread =
                std::max({geometry::kMedianToSigma * geometry::median(sizes), kMinSigmas * ring.sigma, kMinSpread});
            weights.array() /= (residuals.array().abs() / spread).max(1); // Huber's
        }
        const double quantile = quantile_of_sizes(residuals, kStartQuantile);
        if (quantile >= best_quantile * (sector < 0 ? 1 : kPartialGain)) continue;
        best_quantile = quantile;
        const double sd =
            std::max(geometry::kMedianToSigma * quantile_of_sizes(residuals, 0.5), kMinSigmas * ring.sigma);
        best = biweights(residuals, kStartCutoff * std::max(sd, quantile / kQuantilePerSigma));
    }
    return best;
}

struct FittedPolynomial {
    RingPolynomial polynomial;
    Eigen::VectorXd residuals, weights;
};

FittedPolynomial fit_polynomial(const Ring& ring, int degree, Eigen::VectorXd weights)
{
    const Eigen::MatrixXd A = basis(ring.xy, degree);
    FittedPolynomial fit{{degree, {}, {}, 0, 0, 0}, {}, {}};
    double sd = 0;
    for (int iteration = 0; iteration < kRefineIterations; ++iteration) {
        fit.polynomial.coefficients = solve(A, ring.z, weights.cwiseProduct(ring.near));
        fit.residuals = ring.z - A * fit.polynomial.coefficients;
        std::vector<double> sizes;
        for (Index i = 0; i < weights.size(); ++i) {
            const double size = std::abs(fit.residuals[i]);
            if (iteration < kStartInlierIterations ? weights[i] > kMinWeight : size < kInlierCutoff * sd)
                sizes.push_back(size);
        }
        const double spread = sizes.empty() ? sd : geometry::kMedianToSigma * geometry::median(sizes);
        sd = std::max({spread, kMinSigmas * ring.sigma, kMinSpread});
        weights = biweights(fit.residuals, kCutoff * sd);
    }
    fit.weights = weights;
    fit.polynomial.sd = sd;
    fit.polynomial.inliers = double((weights.array() > kMinWeight).count()) / double(weights.size());
    return fit;
}

/// Sets the root of the coefficients' covariance.
void set_covariance(FittedPolynomial& fit, const Ring& ring)
{
    const Eigen::MatrixXd A = basis(ring.xy, fit.polynomial.degree);
    const double repeats = double(ring.z.size()) / ring.independent;
    // Semidefinite where few points are left: the root by eigenvalues exists for any.
    const auto [values, vectors] =
        core::symmetric_eigen<Eigen::Dynamic>(normal_matrix(A, fit.weights.cwiseProduct(ring.near)));
    const Eigen::VectorXd scales =
        (repeats / values.array().max(kRingRidge * values.maxCoeff() + kMinEigenvalue)).sqrt();
    fit.polynomial.covariance_root = fit.polynomial.sd * vectors * scales.asDiagonal();
}

/// Shares by the Bayesian information criterion, with residuals cut off at the same size for all.
void set_shares(std::vector<FittedPolynomial>& fits, double independent)
{
    double sd = std::numeric_limits<double>::infinity();
    for (const FittedPolynomial& fit : fits) sd = std::min(sd, fit.polynomial.sd);
    Eigen::VectorXd criteria(fits.size());
    for (std::size_t k = 0; k < fits.size(); ++k) {
        const double limit = kInlierCutoff * sd;
        const double mean = fits[k].residuals.array().square().min(limit * limit).mean();
        criteria[Index(k)] = independent * std::log(mean + kMinSpread * kMinSpread) +
                             double(fits[k].polynomial.coefficients.size()) * std::log(independent);
    }
    Eigen::VectorXd shares = (-0.5 * (criteria.array() - criteria.minCoeff())).exp();
    shares = (shares.array() < kMinShare).select(0, shares);
    shares /= shares.sum();
    for (std::size_t k = 0; k < fits.size(); ++k) fits[k].polynomial.share = shares[Index(k)];
}

Ring scaled_ring(const RingPoints& points, double sigma, RingFit& fit)
{
    Ring ring;
    const Index all = points.z.size(), count = std::min(all, kMaxRingPoints);
    ring.xy.resize(2, count);
    ring.z.resize(count);
    ring.near.resize(count);
    for (Index k = 0; k < count; ++k) {
        const Index i = count == 1 ? 0 : k * (all - 1) / (count - 1);
        ring.xy.col(k) = points.xy.col(i);
        ring.z[k] = points.z[i];
        ring.near[k] = points.weights[i];
    }
    fit.centre = ring.xy.rowwise().mean();
    fit.scale = (ring.xy.rowwise().maxCoeff() - ring.xy.rowwise().minCoeff()).maxCoeff() / 2 + kMinSpread;
    std::vector<double> heights(ring.z.begin(), ring.z.end());
    fit.height = geometry::median(heights);
    ring.xy = (ring.xy.colwise() - fit.centre) / fit.scale;
    ring.z.array() -= fit.height;
    ring.sigma = sigma;
    ring.independent = std::max(1.0, std::min(double(all) / kCorrelatedCells, double(count)));
    return ring;
}

} // namespace

RingFit::Value RingFit::at(double x, double y) const
{
    double row[kMaxTerms];
    const double u = (x - centre.x()) / scale, v = (y - centre.y()) / scale;
    monomials(u, v, polynomials.back().degree, row);
    double first = 0, square = 0;
    for (const RingPolynomial& polynomial : polynomials) {
        const Eigen::Map<const Eigen::VectorXd> powers(row, polynomial.coefficients.size());
        const double z = powers.dot(polynomial.coefficients);
        first += polynomial.share * z;
        square += polynomial.share * (z * z + (polynomial.covariance_root.transpose() * powers).squaredNorm());
    }
    return {height + first, std::sqrt(std::max(0.0, square - first * first))};
}

double RingFit::z_at(double x, double y) const
{
    double row[kMaxTerms];
    monomials((x - centre.x()) / scale, (y - centre.y()) / scale, polynomials.back().degree, row);
    return height + mean.dot(Eigen::Map<const Eigen::VectorXd>(row, mean.size()));
}

void RingFit::add_row(double y, double factor, std::span<float> row) const
{
    // In x along the row: coefficients of its powers, from those of total degree up to 4.
    std::array<double, kHighestDegree + 1> powers{};
    const double v = (y - centre.y()) / scale;
    Index k = 0;
    for (std::size_t total = 0; k < mean.size(); ++total) {
        double power = 1;
        for (std::size_t b = 0; b <= total; ++b, power *= v) powers[total - b] += power * mean[k++];
    }
    powers[0] += height;
    for (std::size_t x = 0; x < row.size(); ++x) {
        const double u = (double(x) - centre.x()) / scale;
        double z = powers[kHighestDegree];
        for (std::size_t i = kHighestDegree; i-- > 0;) z = z * u + powers[i];
        row[x] = float(row[x] + factor * z);
    }
}

std::optional<RingFit> fit_ring(const RingPoints& points, double sigma, int max_degree)
{
    if (points.z.size() == 0) return std::nullopt;
    RingFit fit;
    const Ring ring = scaled_ring(points, sigma, fit);
    const Eigen::VectorXd start = start_weights(ring);
    if (start.size() == 0) return std::nullopt;
    std::vector<FittedPolynomial> fits;
    for (int degree = 1; degree <= max_degree; ++degree) {
        if (ring.independent < kMinPointsPerTerm * double(terms_of(degree))) break;
        fits.push_back(fit_polynomial(ring, degree, start));
    }
    if (fits.empty()) return std::nullopt;
    set_shares(fits, ring.independent);
    double max_share = 0;
    for (FittedPolynomial& fitted : fits) {
        RingPolynomial& polynomial = fitted.polynomial;
        if (polynomial.share == 0) continue;
        set_covariance(fitted, ring);
        fit.sd += polynomial.share * polynomial.sd;
        fit.inliers += polynomial.share * polynomial.inliers;
        if (polynomial.share > max_share) {
            max_share = polynomial.share;
            fit.degree = polynomial.degree;
        }
        fit.polynomials.push_back(std::move(polynomial));
    }
    fit.mean = Eigen::VectorXd::Zero(terms_of(fit.polynomials.back().degree));
    for (const RingPolynomial& polynomial : fit.polynomials)
        fit.mean.head(polynomial.coefficients.size()) += polynomial.share * polynomial.coefficients;
    return fit;
}

} // namespace fettle::find
