#include "find/slow_field.h"

#include "core/cholesky.h"
#include "geometry/bounding_box.h"
#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>

namespace fettle::find {
namespace {

using Eigen::Index;

constexpr int kFieldDegree = 5;
constexpr Index kMonomials = 56; // of three variables, up to that degree
constexpr int kFieldIterations = 8;
// Ridge as a share of the mean diagonal: motions along the surface, which no distance shows, stay small.
constexpr double kFieldRidge = 1e-4, kMinRidge = 1e-12; // the latter where no point has a weight
// Prior: strains have this standard deviation, and together the weight of so many points. It determines what a few
// points on the walls and ledges of a plate do not, and hardly changes what thousands show, such as shrinkage.
constexpr double kStrainSd = 0.01, kStrainWeight = 50;
constexpr Index kStrainPoints = 500;                            // at which the strains are taken
constexpr double kMinFieldScale = 1e-9, kMinFieldCutoff = 1e-9; // mm: points at one place, residuals all 0

using Monomials = Eigen::Matrix<double, kMonomials, 1>;

Monomials monomials_of(const Eigen::Vector3d& p)
{
    Eigen::Matrix<double, 3, kFieldDegree + 1> powers;
    powers.col(0).setOnes();
    for (int k = 0; k < kFieldDegree; ++k) powers.col(k + 1) = powers.col(k).cwiseProduct(p);
    Monomials result;
    Index k = 0;
    for (int total = 0; total <= kFieldDegree; ++total)
        for (int a = 0; a <= total; ++a)
            for (int b = 0; a + b <= total; ++b) result[k++] = powers(0, a) * powers(1, b) * powers(2, total - a - b);
    return result;
}

/// Partial derivative of the monomials along an axis.
Monomials derivative_of_monomials(const Eigen::Vector3d& p, int axis)
{
    Monomials result;
    Index k = 0;
    for (int total = 0; total <= kFieldDegree; ++total)
        for (int a = 0; a <= total; ++a)
            for (int b = 0; a + b <= total; ++b) {
                Eigen::Vector3i powers(a, b, total - a - b);
                const int factor = powers[axis]--;
                double term = factor;
                for (int i = 0; i < 3 && factor > 0; ++i) term *= std::pow(p[i], powers[i]);
                result[k++] = term;
            }
    return result;
}

/// Metal bends, and hardly strains: the quadratic form, in the coefficients of x of all monomials, y, z, whose value is
/// the sum over some of the points of the squared strains (Frobenius norm of the symmetric gradient).
Eigen::MatrixXd strain_energy(const Eigen::Matrix3Xd& points, const SlowField& field)
{
    const Index step = std::max<Index>(1, points.cols() / kStrainPoints), count = (points.cols() + step - 1) / step;
    Eigen::MatrixXd strains = Eigen::MatrixXd::Zero(3 * kMonomials, 6 * count);
    Index row = 0;
    for (Index i = 0; i < points.cols(); i += step) {
        const Eigen::Vector3d p = (points.col(i) - field.centre) / field.scale;
        Eigen::Matrix<double, kMonomials, 3> gradient;
        for (int axis = 0; axis < 3; ++axis) gradient.col(axis) = derivative_of_monomials(p, axis) / field.scale;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b <= a; ++b, ++row) {
                // A shear occurs twice in the symmetric gradient, as the mean of two derivatives.
                const double factor = a == b ? 1 : std::sqrt(0.5);
                strains.col(row).segment(a * kMonomials, kMonomials) += factor * gradient.col(b);
                if (a != b) strains.col(row).segment(b * kMonomials, kMonomials) += factor * gradient.col(a);
            }
    }
    Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(3 * kMonomials, 3 * kMonomials);
    energy.selfadjointView<Eigen::Lower>().rankUpdate(strains);
    return energy / double(count);
}

/// Robust standard deviation of the finite residuals; 0 if there is none.
double spread_of(const Eigen::VectorXd& residuals)
{
    std::vector<double> sizes;
    for (const double r : residuals)
        if (std::isfinite(r)) sizes.push_back(std::abs(r));
    return sizes.empty() ? 0 : geometry::kMedianToSigma * geometry::median(sizes);
}

/// Tukey's weights of residuals; 0 where there is none.
Eigen::VectorXd weights_of(const Eigen::VectorXd& residuals)
{
    std::vector<double> defined;
    for (const double r : residuals)
        if (std::isfinite(r)) defined.push_back(r);
    if (defined.empty()) return Eigen::VectorXd::Zero(residuals.size());
    const double middle = geometry::median(defined);
    for (double& r : defined) r = std::abs(r - middle);
    const double limit = geometry::kTukeyCutoff * geometry::kMedianToSigma * geometry::median(defined) +
                         std::abs(middle) + kMinFieldCutoff;
    Eigen::VectorXd weights(residuals.size());
    for (Index i = 0; i < residuals.size(); ++i) {
        const double rest = 1 - residuals[i] * residuals[i] / (limit * limit);
        weights[i] = rest > 0 ? rest * rest : 0; // 0 for NaN, too
    }
    return weights;
}

} // namespace

Eigen::Vector3d SlowField::at(const Eigen::Vector3d& point) const
{
    if (coefficients.cols() == 0) return Eigen::Vector3d::Zero();
    return coefficients * monomials_of((point - centre) / scale);
}

double SlowField::sd_along(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const
{
    if (coefficients.cols() == 0) return 0;
    const Monomials basis = monomials_of((point - centre) / scale);
    Eigen::VectorXd gradient(3 * kMonomials);
    for (int axis = 0; axis < 3; ++axis) gradient.segment(axis * kMonomials, kMonomials) = direction[axis] * basis;
    root.triangularView<Eigen::Lower>().solveInPlace(gradient);
    return sd * gradient.norm();
}

SlowField fit_slow_field(const Eigen::Matrix3Xd& points, const compare::Reference& reference, Stiffness stiffness)
{
    SlowField field;
    const Eigen::AlignedBox3d box = geometry::bounding_box(points);
    field.centre = box.center();
    field.scale = std::max(box.sizes().maxCoeff() / 2, kMinFieldScale);
    Eigen::Matrix<double, kMonomials, Eigen::Dynamic> basis(kMonomials, points.cols());
    for (Index i = 0; i < points.cols(); ++i) basis.col(i) = monomials_of((points.col(i) - field.centre) / field.scale);
    field.coefficients = Eigen::Matrix3Xd::Zero(3, kMonomials);
    Eigen::MatrixXd strains = Eigen::MatrixXd::Zero(3 * kMonomials, 3 * kMonomials);
    if (stiffness == Stiffness::metal) strains = kStrainWeight / (kStrainSd * kStrainSd) * strain_energy(points, field);
    for (int iteration = 0; iteration < kFieldIterations; ++iteration) {
        const Eigen::Matrix3Xd shifts = field.coefficients * basis;
        const compare::ErrorMap map = reference(points - shifts);
        const Eigen::VectorXd weights = weights_of(map.error);
        Eigen::MatrixXd A(3 * kMonomials, points.cols()); // rows: x of all monomials, y, z; times the weights' roots
        Eigen::VectorXd b(points.cols());
        for (Index i = 0; i < points.cols(); ++i) {
            const double root = std::sqrt(weights[i]);
            const Eigen::Vector3d n = root > 0 ? Eigen::Vector3d(map.normal.col(i)) : Eigen::Vector3d::Zero();
            for (int axis = 0; axis < 3; ++axis)
                A.col(i).segment(axis * kMonomials, kMonomials) = root * n[axis] * basis.col(i);
            b[i] = root > 0 ? root * (map.error[i] + n.dot(shifts.col(i))) : 0;
        }
        Eigen::MatrixXd N = Eigen::MatrixXd::Zero(A.rows(), A.rows());
        N.selfadjointView<Eigen::Lower>().rankUpdate(A);
        field.sd = spread_of(map.error);
        N += field.sd * field.sd * strains;
        N.diagonal().array() += kFieldRidge * N.trace() / double(A.rows()) + kMinRidge;
        // LLT: the ridge makes the matrix definite.
        const core::Cholesky cholesky(N);
        const Eigen::VectorXd solution = cholesky.solve(A * b);
        field.root = cholesky.L();
        for (int axis = 0; axis < 3; ++axis)
            field.coefficients.row(axis) = solution.segment(axis * kMonomials, kMonomials).transpose();
    }
    return field;
}

} // namespace fettle::find
