#include "margin/field_draws.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "margin/waves.h"
#include "surface/precision.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <variant>
#include <vector>

namespace fettle::margin {

namespace {

/// F with F Fᵀ = covariance by pivoted Cholesky decomposition (Golub and Van Loan 2013, 4.2.8), truncated where
/// rounding makes pivots negative. Smooth fields need few columns.
Eigen::MatrixXd covariance_root(const Eigen::MatrixXd& covariance)
{
    constexpr double kPivotTolerance = 1e-10; // of variances scaled to 1
    // Parameters differ in unit (lengths, angles, curvatures), so they are scaled by their standard deviations.
    const Eigen::VectorXd size = covariance.diagonal().cwiseMax(0).cwiseSqrt();
    const Eigen::VectorXd inverse = size.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; });
    Eigen::VectorXd left = covariance.diagonal().cwiseProduct(inverse.cwiseAbs2());
    Eigen::MatrixXd L(covariance.rows(), covariance.cols());
    Eigen::Index rank = 0, largest = 0;
    for (; rank < L.cols() && left.maxCoeff(&largest) > kPivotTolerance; ++rank) {
        Eigen::VectorXd column = covariance.col(largest).cwiseProduct(inverse) * inverse[largest];
        column.noalias() -= L.leftCols(rank) * L.row(largest).head(rank).transpose();
        L.col(rank) = column / std::sqrt(left[largest]);
        left -= L.col(rank).cwiseAbs2();
        left[largest] = 0;
    }
    return size.asDiagonal() * L.leftCols(rank);
}

/// F with F Fᵀ = the covariance of the heights Gᵀ θ, along the principal axes of the heights, so that a rotated job has
/// the same draws. With B any root, Bᵀ B is small, and B times its eigenvectors is the root with perpendicular columns.
Eigen::MatrixXd field_root(const Eigen::MatrixXd& gradients, const Eigen::MatrixXd& covariance)
{
    const Eigen::MatrixXd B = gradients.transpose() * covariance_root(covariance);
    if (B.cols() == 0) return B; // known exactly
    const core::SymmetricEigen<Eigen::Dynamic> axes = core::symmetric_eigen<Eigen::Dynamic>(B.transpose() * B);
    Eigen::MatrixXd field = B * axes.vectors;
    // The sign of an eigenvector is arbitrary. These weights define it; they have no symmetry, so that they do not
    // cancel.
    const Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(field.rows(), 1, field.rows()).array().sin();
    for (Eigen::Index k = 0; k < field.cols(); ++k)
        if (field.col(k).dot(weights) < 0) field.col(k) *= -1;
    return field;
}

/// Number of parameters of a process's trend, a quadratic.
constexpr Eigen::Index kTrendParameters = 6;
/// Fewer degrees of freedom would leave Student's t without a fourth moment, as few touches leave no process.
constexpr Eigen::Index kMinFreedom = 5;

/// Degrees of freedom of the touches less the parameters of a process's trend.
double process_freedom(const surface::Surface& surface)
{
    const Eigen::Index used = surface.touches.cols() - Eigen::Index(surface.outliers.size());
    return double(std::max(used - kTrendParameters, kMinFreedom));
}

/// Random factor of mean square 1 that gives heights Student's t distribution if the size of the errors was estimated
/// with these degrees of freedom: a possible size relative to the root mean square of the covariance.
double draw_noise_factor(double freedom, std::mt19937_64& random)
{
    if (!std::isfinite(freedom)) return 1;
    std::chi_squared_distribution<double> squares(freedom);
    return std::sqrt((freedom - 2) / squares(random));
}

/// A member of the mixture that fields are drawn from.
struct Component {
    double weight;
    Eigen::VectorXd offset; ///< its mean minus the mixture's
    Eigen::MatrixXd root;   ///< F with F Fᵀ its covariance
    double freedom;         ///< degrees of freedom of its size
};

/// Adds waves about a member, the last of the components, whose weight is reduced by theirs.
void add_waves(std::vector<Component>& all, const surface::WeightedShape& member, const surface::Surface& surface,
               const Eigen::Matrix2Xd& xy, const ScanWaves* scan)
{
    const Component alone = all.back();
    for (Waves& one : waves_about(member, surface, xy, scan)) {
        if (!one.root.allFinite() || !one.offset.allFinite()) continue;
        all.back().weight -= one.probability * alone.weight;
        all.insert(all.end() - 1, {one.probability * alone.weight, alone.offset + one.offset, std::move(one.root),
                                   surface.touch_sigma_dof});
    }
}

/// All members of the mixture that are defined at all of xy.
std::vector<Component> make_components(const surface::Surface& surface, const Eigen::Matrix2Xd& xy, Tails tails,
                                       UnseenWaves waves, const Eigen::Matrix3Xd& scan)
{
    const Eigen::VectorXd mean = surface::heights(surface, xy).array() - surface.shift;
    std::optional<ScanWaves> scan_waves;
    if (scan.cols() > 0) scan_waves.emplace(scan, wave_lengths(surface));
    std::vector<Component> all;
    if (surface.precision) {
        const Eigen::MatrixXd covariance =
            surface::height_covariance(std::get<surface::Bspline>(surface.shape), *surface.precision, xy);
        all.push_back({1, Eigen::VectorXd::Zero(xy.cols()), covariance_root(covariance), surface.touch_sigma_dof});
    }
    for (const surface::WeightedShape& member : surface::weighted_shapes(surface)) {
        if (member.covariance.size() == 0) continue;
        const Eigen::MatrixXd gradients = surface::height_gradients(member.shape, xy);
        const Eigen::VectorXd offset = surface::heights(member.shape, xy) - mean;
        if (!gradients.allFinite() || !offset.allFinite()) continue;
        const bool is_process = std::holds_alternative<surface::Bspline>(member.shape);
        all.push_back({member.weight, offset, field_root(gradients, member.covariance),
                       is_process && tails == Tails::student
                           ? std::min(surface.touch_sigma_dof, process_freedom(surface))
                           : surface.touch_sigma_dof});
        if (waves == UnseenWaves::possible && (!is_process || scan_waves))
            add_waves(all, member, surface, xy, scan_waves ? &*scan_waves : nullptr);
    }
    return all;
}

struct Random {
    std::mt19937_64 engine;
    std::normal_distribution<double> normal = {};
};

/// Visits pairs of draws from one component.
void visit_pairs(const Component& one, Eigen::Index pairs, Random& random, const FieldVisitor& visit)
{
    constexpr Eigen::Index kBlock = 32; // pairs at a time, whose fields stay in the cache
    Eigen::MatrixXd unit(one.root.cols(), pairs);
    for (double& number : unit.reshaped()) number = random.normal(random.engine);
    Eigen::MatrixXd about;
    Eigen::VectorXd field;
    for (Eigen::Index first = 0; first < pairs; first += kBlock) {
        about.noalias() = one.root * unit.middleCols(first, std::min(kBlock, pairs - first));
        for (const auto& error : about.colwise()) {
            const double noise = draw_noise_factor(one.freedom, random.engine);
            field = one.offset + noise * error;
            visit(field);
            field = one.offset - noise * error;
            visit(field);
        }
    }
}

} // namespace

void visit_fields(const surface::Surface& surface, const Eigen::Matrix2Xd& xy, int draws, std::uint64_t seed,
                  Tails tails, UnseenWaves waves, const Eigen::Matrix3Xd& scan, const FieldVisitor& visit)
{
    const std::vector<Component> all = make_components(surface, xy, tails, waves, scan);
    double sum = 0;
    for (const Component& one : all) sum += one.weight;
    // No member that has weight is defined at all of xy, or the squares of the heights overflow or underflow.
    if (!(sum > 0) || !std::isfinite(sum))
        throw core::InputError("touches", "the surface fitted to them has no covariance that is finite all over the "
                                          "anomaly, so its error cannot be predicted");
    Random random{std::mt19937_64(seed)};
    double due = 0; // cumulative number of pairs of draws up to this component, before rounding
    Eigen::Index visited = 0;
    for (const Component& one : all) {
        due += one.weight / sum * draws / 2;
        const Eigen::Index pairs = std::lround(due) - visited;
        visit_pairs(one, pairs, random, visit);
        visited += pairs;
    }
}

Eigen::MatrixXd draw_fields(const surface::Surface& surface, const Eigen::Matrix2Xd& xy, int draws, std::uint64_t seed)
{
    Eigen::MatrixXd fields(xy.cols(), draws);
    Eigen::Index column = 0;
    visit_fields(surface, xy, draws, seed, Tails::normal, UnseenWaves::none, {},
                 [&](const Eigen::VectorXd& field) { fields.col(column++) = field; });
    return fields;
}

} // namespace fettle::margin
