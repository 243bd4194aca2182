#include "find/ring_fit.h"

#include "find/crease.h"

#include "geometry/quantiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace fettle::find {
namespace {

using Eigen::Index;

constexpr Index kMaxStartPoints = 200;    // more points yield the same start
constexpr Index kMaxRingPoints = 450;     // more points change the surface by less than its own error
constexpr double kCorrelatedCells = 6;    // as informative as one independent point: scanners smooth
constexpr double kMinPointsPerTerm = 2.5; // independent ones

// The start: least median (here the 0.6 quantile) of absolute residuals (Rousseeuw 1984) over the whole ring and over
// eight rings with a third of the directions left out, as a part's edge lies on one side. A partial ring must be better
// by this factor, since it chose among eight.
constexpr int kSectors = 8;
constexpr double kSectorHalfAngle = std::numbers::pi / 3;
constexpr double kStartQuantile = 0.6, kQuantilePerSigma = 1.2;
constexpr double kPartialGain = 0.85;
constexpr int kStartIterations = 3, kRefineIterations = 6;
// The start is a quadratic if there are more than kMinQuadraticPoints independent points, else a plane. Each term needs
// kMinStartPointsPerTerm points, half of which may be outliers.
constexpr int kMaxStartDegree = 2;
constexpr double kMinQuadraticPoints = 15, kMinStartPointsPerTerm = 3;
// The first iterations measure the spread of the start's inliers; later ones define inliers by their own residuals.
constexpr int kStartInlierIterations = 2;
constexpr double kMinSpreadChange = 1e-3; // relative change below which the iteration has converged

constexpr double kCutoff = 4.5, kInlierCutoff = 6; // Tukey's, in standard deviations
constexpr double kMinWeight = 0.05;                // below it a point is an outlier
// A crease is sought where the best polynomial leaves more than this multiple of the noise, or too few inliers.
constexpr double kMinCreaseSigmas = 1.5, kMaxSmoothInliers = 0.85;
constexpr int kMaxCreasedDegree = 3;
constexpr double kMinShare = 1e-3; // of a polynomial in the average

Eigen::VectorXd biweights(const Eigen::VectorXd& residuals, double cutoff)
{
    return (1 - (residuals.array() / cutoff).square()).max(0).square();
}

/// Weights of the points outside of a sector of directions: 1, within it 0.
Eigen::VectorXd outside_sector(const Ring& ring, int sector)
{
    const double turn = sector * 2 * std::numbers::pi / kSectors;
    const Eigen::RowVector2d middle(std::cos(turn), std::sin(turn));
    const Eigen::RowVectorXd along = middle * ring.xy, limit = std::cos(kSectorHalfAngle) * ring.xy.colwise().norm();
    return (along.array() < limit.array()).cast<double>().transpose();
}

/// Coefficients that fit the chosen points, by Huber's weights.
RingCoefficients robust_coefficients(const Ring& ring, const RingColumns& A, const Eigen::VectorXd& chosen)
{
    Eigen::VectorXd weights = chosen;
    RingCoefficients coefficients;
    for (int iteration = 0; iteration < kStartIterations; ++iteration) {
        coefficients = A.solve(ring.z, weights.cwiseProduct(ring.near));
        if (iteration + 1 < kStartIterations)
            reweigh(weights, A.residuals(ring.z, coefficients), chosen,
                    std::max(kMinRingSigmas * ring.sigma, kMinRingSpread));
    }
    return coefficients;
}

/// First weights of the ring's points, about a robust start; empty if there are too few points.
Eigen::VectorXd start_weights(const Ring& whole, const RingBasis& basis)
{
    const Ring ring = thinned(whole, kMaxStartPoints);
    const int degree = ring.independent > kMinQuadraticPoints ? kMaxStartDegree : 1;
    const RingBasis own(ring.xy, degree);
    const RingColumns A = own.of(degree, false);
    RingCoefficients best;
    double best_quantile = std::numeric_limits<double>::infinity();
    for (int sector = -1; sector < kSectors; ++sector) {
        const Eigen::VectorXd chosen = sector < 0 ? Eigen::VectorXd::Ones(ring.z.size()) : outside_sector(ring, sector);
        if (chosen.sum() < kMinStartPointsPerTerm * double(A.count())) continue;
        const RingCoefficients coefficients = robust_coefficients(ring, A, chosen);
        const double quantile = quantile_of_sizes(A.residuals(ring.z, coefficients), kStartQuantile);
        if (quantile >= best_quantile * (sector < 0 ? 1 : kPartialGain)) continue;
        best_quantile = quantile;
        best = coefficients;
    }
    if (best.size() == 0) return {};
    const Eigen::VectorXd residuals = basis.of(degree, false).residuals(whole.z, best);
    const double sd = std::max({geometry::kMedianToSigma * quantile_of_sizes(residuals, 0.5),
                                kMinRingSigmas * ring.sigma, best_quantile / kQuantilePerSigma});
    return biweights(residuals, kRingStartCutoff * sd);
}

/// A polynomial of total degree `degree`, or two that meet in the ring's crease.
struct RingPolynomial {
    int degree;
    bool is_creased;
    RingCoefficients coefficients; ///< of the crease's terms, then of the monomials
    RingMatrix covariance;         ///< of these, mm²
    double sd;                     ///< of the points about it, mm
    double inliers;                ///< share of points with a weight
    double share;                  ///< in the average
};

struct FittedPolynomial {
    RingPolynomial polynomial;
    Eigen::VectorXd residuals, weights;
};

/// First weights, and the normal equations of the highest degree with them, which include those of lower degrees.
struct RingStart {
    Eigen::VectorXd weights;
    RingColumns::NormalEquations equations;

    RingStart(const Ring& ring, const RingColumns& highest, Eigen::VectorXd start)
        : weights(std::move(start)), equations(highest.normal_equations(ring.z, weights.cwiseProduct(ring.near)))
    {
    }
};

FittedPolynomial fit_polynomial(const Ring& ring, const RingBasis& basis, int degree, bool is_creased,
                                const RingStart& start)
{
    const RingColumns A = basis.of(degree, is_creased);
    FittedPolynomial fit{{degree, is_creased, start.equations.head(A.count()).solution(), {}, 0, 0, 0}, {}, {}};
    fit.weights = start.weights;
    double sd = 0;
    for (int iteration = 0; iteration < kRefineIterations; ++iteration) {
        if (iteration > 0) fit.polynomial.coefficients = A.solve(ring.z, fit.weights.cwiseProduct(ring.near));
        fit.residuals = A.residuals(ring.z, fit.polynomial.coefficients);
        ChosenSizes sizes(fit.weights.size());
        for (Index i = 0; i < fit.weights.size(); ++i)
            sizes.add(fit.residuals[i], iteration < kStartInlierIterations
                                            ? fit.weights[i] > kMinWeight
                                            : std::abs(fit.residuals[i]) < kInlierCutoff * sd);
        const double spread = sizes.empty() ? sd : geometry::kMedianToSigma * sizes.median();
        const double before = std::exchange(sd, std::max({spread, kMinRingSigmas * ring.sigma, kMinRingSpread}));
        fit.weights = biweights(fit.residuals, kCutoff * sd);
        if (iteration > kStartInlierIterations && std::abs(sd - before) < kMinSpreadChange * sd) break;
    }
    fit.polynomial.sd = sd;
    fit.polynomial.inliers = double((fit.weights.array() > kMinWeight).count()) / double(fit.weights.size());
    return fit;
}

/// Sets the coefficients' covariance.
void set_covariance(FittedPolynomial& fit, const Ring& ring, const RingBasis& basis)
{
    const RingColumns A = basis.of(fit.polynomial.degree, fit.polynomial.is_creased);
    const double repeats = double(ring.z.size()) / ring.independent;
    fit.polynomial.covariance = fit.polynomial.sd * fit.polynomial.sd * repeats *
                                A.normal_equations(ring.z, fit.weights.cwiseProduct(ring.near)).inverse();
}

/// The highest degree up to `max_degree` whose terms, and `more`, have enough independent points each; 0: none has.
int affordable_degree(const Ring& ring, int max_degree, Index more)
{
    int degree = 0;
    while (degree < max_degree && ring.independent >= kMinPointsPerTerm * double(terms_of(degree + 1) + more)) ++degree;
    return degree;
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
        const Index unknowns = fits[k].polynomial.coefficients.size() + (fits[k].polynomial.is_creased ? 2 : 0);
        criteria[Index(k)] =
            independent * std::log(mean + kMinRingSpread * kMinRingSpread) + double(unknowns) * std::log(independent);
    }
    Eigen::VectorXd shares = (-0.5 * (criteria.array() - criteria.minCoeff())).exp();
    shares = (shares.array() < kMinShare).select(0, shares);
    shares /= shares.sum();
    for (std::size_t k = 0; k < fits.size(); ++k) fits[k].polynomial.share = shares[Index(k)];
}

Ring scaled_ring(const RingPoints& points, double sigma, RingFit& fit)
{
    Ring ring;
    const Index all = points.z.size(), count = count_in_lanes(std::min(all, kMaxRingPoints));
    ring.xy.resize(2, count);
    ring.z.resize(count);
    ring.near.resize(count);
    for (Index k = 0; k < count; ++k) {
        const Index i = k * (all - 1) / (count - 1);
        ring.xy.col(k) = points.xy.col(i);
        ring.z[k] = points.z[i];
        ring.near[k] = points.weights[i];
    }
    fit.centre = ring.xy.rowwise().mean();
    fit.scale = (ring.xy.rowwise().maxCoeff() - ring.xy.rowwise().minCoeff()).maxCoeff() / 2 + kMinRingSpread;
    std::vector<double> heights(ring.z.begin(), ring.z.end());
    fit.height = geometry::median(heights);
    ring.xy = (ring.xy.colwise() - fit.centre) / fit.scale;
    ring.z.array() -= fit.height;
    ring.sigma = sigma;
    ring.independent = std::max(1.0, std::min(double(all) / kCorrelatedCells, double(count)));
    return ring;
}

/// Sets the average of the polynomials, its covariance, and the averages of their other results.
void set_average(RingFit& fit, const std::vector<FittedPolynomial>& fits)
{
    bool is_creased = false;
    for (const FittedPolynomial& fitted : fits) {
        fit.highest_degree = std::max(fit.highest_degree, fitted.polynomial.degree);
        is_creased |= fitted.polynomial.is_creased;
    }
    if (!is_creased) fit.crease.reset();
    const Index monomials = terms_of(fit.highest_degree), count = monomials + (is_creased ? kCreaseTerms : 0);
    std::vector<std::vector<Index>> places; // indices of a polynomial's coefficients among all
    fit.mean = Eigen::VectorXd::Zero(count);
    double max_share = 0;
    for (const FittedPolynomial& fitted : fits) {
        const RingPolynomial& polynomial = fitted.polynomial;
        std::vector<Index>& place = places.emplace_back(std::size_t(polynomial.coefficients.size()));
        for (Index k = 0; k < Index(place.size()); ++k)
            place[std::size_t(k)] = !polynomial.is_creased ? k : k < kCreaseTerms ? monomials + k : k - kCreaseTerms;
        fit.mean(place) += polynomial.share * polynomial.coefficients;
        fit.sd += polynomial.share * polynomial.sd;
        fit.inliers += polynomial.share * polynomial.inliers;
        if (polynomial.share > max_share) max_share = polynomial.share, fit.degree = polynomial.degree;
    }
    fit.covariance = Eigen::MatrixXd::Zero(count, count);
    for (std::size_t k = 0; k < fits.size(); ++k) {
        const RingPolynomial& polynomial = fits[k].polynomial;
        Eigen::VectorXd off = -fit.mean;
        off(places[k]) += polynomial.coefficients;
        fit.covariance += polynomial.share * off * off.transpose();
        fit.covariance(places[k], places[k]) += polynomial.share * polynomial.covariance;
    }
}

/// Fits polynomials on both sides of a crease where a single polynomial leaves more than noise.
void add_creased(std::vector<FittedPolynomial>& fits, const Ring& ring, RingBasis& basis, int max_degree,
                 const CreaseSearch& creases, RingFit& fit)
{
    if (!creases.is_sought && !creases.known) return;
    const auto best = std::ranges::min_element(fits, {}, [](const FittedPolynomial& f) { return f.polynomial.sd; });
    if (best->polynomial.sd < kMinCreaseSigmas * ring.sigma && best->polynomial.inliers > kMaxSmoothInliers) return;
    if (creases.known)
        fit.crease =
            Crease{creases.known->across, (creases.known->offset - creases.known->across.dot(fit.centre)) / fit.scale};
    if (creases.is_sought) fit.crease = find_crease(ring, fit.crease);
    const int highest = affordable_degree(ring, std::min(max_degree, kMaxCreasedDegree), kCreaseTerms + 2);
    if (!fit.crease || highest == 0) return;
    basis.set_crease(ring.xy, *fit.crease);
    const RingStart start(ring, basis.of(highest, true), crease_weights(ring, *fit.crease));
    for (int degree = 1; degree <= highest; ++degree) {
        FittedPolynomial fitted = fit_polynomial(ring, basis, degree, true, start);
        const double bend = -fitted.polynomial.coefficients[0] / fit.scale;
        if (bend > creases.min_bend && bend < creases.max_bend) fits.push_back(std::move(fitted));
    }
}

} // namespace

std::optional<RingFit> fit_ring(const RingPoints& points, double sigma, int max_degree, const CreaseSearch& creases)
{
    if (count_in_lanes(points.z.size()) == 0) return std::nullopt;
    RingFit fit;
    const Ring ring = scaled_ring(points, sigma, fit);
    RingBasis basis(ring.xy, std::max(max_degree, kMaxStartDegree));
    const int highest = affordable_degree(ring, max_degree, 0);
    if (highest == 0) return std::nullopt;
    Eigen::VectorXd weights = start_weights(ring, basis);
    if (weights.size() == 0) return std::nullopt;
    const RingStart start(ring, basis.of(highest, false), std::move(weights));
    std::vector<FittedPolynomial> fits;
    for (int degree = 1; degree <= highest; ++degree) fits.push_back(fit_polynomial(ring, basis, degree, false, start));
    add_creased(fits, ring, basis, max_degree, creases, fit);
    set_shares(fits, ring.independent);
    std::erase_if(fits, [](const FittedPolynomial& fitted) { return fitted.polynomial.share == 0; });
    for (FittedPolynomial& fitted : fits) set_covariance(fitted, ring, basis);
    set_average(fit, fits);
    return fit;
}

} // namespace fettle::find
