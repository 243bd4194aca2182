#include "compare/form.h"

#include "compare/chebyshev.h"
#include "compare/form_start.h"
#include "core/error.h"
#include "geometry/quantiles.h"

#include <Eigen/Dense>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace fettle::compare {

namespace {

// Levenberg's damping relative to the diagonal: below the first a step is practically Gauss-Newton's, above the second
// it is zero.
constexpr double kMaxNewtonDamping = 1e-6, kMaxDamping = 1e6;
constexpr Eigen::Index kPointsPerTask = 4096; // fixed, so that the sums have a fixed order

// Gauss-Newton from a near start converges in a few steps; noise and short arcs cost some more.
constexpr int kMaxSteps = 200;
// A step shorter than this share of the part's size is roundoff.
constexpr double kRelativeStepTolerance = 1e-14;
// Beyond this many part sizes a radius is indistinguishable from a plane in float coordinates.
constexpr double kMaxRelativeRadius = 1e6;

// A zone that the best motion would narrow by less than this share is the narrowest: roundoff of the programme.
constexpr double kMinRelativeGain = 1e-11;
// Points on each side in the first programme: more than can determine the zone, few enough to be quick.
constexpr std::size_t kPointsPerSide = 100;

/// JᵀJ, Jᵀr and rᵀr.
struct FormEquations {
    FormMatrix A;
    FormVector b;
    double square = 0;
};

FormEquations normal_equations(const FormElement& element, const FormMotion& motion, const Eigen::Matrix3Xd& points)
{
    const Eigen::Index m = motion.parameter_count();
    const FormEquations zero{FormMatrix::Zero(m, m), FormVector::Zero(m), 0};
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<Eigen::Index>(0, points.cols(), kPointsPerTask), zero,
        [&](const tbb::blocked_range<Eigen::Index>& range, FormEquations sum) {
            for (Eigen::Index i = range.begin(); i < range.end(); ++i) {
                const double r = deviation(element, points.col(i));
                const FormVector g = motion.gradient(points.col(i));
                sum.A.noalias() += g * g.transpose();
                sum.b += r * g;
                sum.square += r * r;
            }
            return sum;
        },
        [](FormEquations a, const FormEquations& b) {
            a.A += b.A;
            a.b += b.b;
            a.square += b.square;
            return a;
        });
}

// Levenberg-Marquardt on the orthogonal distances.
FormZone least_squares(FormElement element, const Eigen::Matrix3Xd& points, double scale)
{
    FormZone zone;
    double damping = 1e-3; // Marquardt's first value
    FormEquations normal = normal_equations(element, FormMotion(element, scale), points);
    for (int step = 0; step < kMaxSteps && !zone.converged; ++step) {
        FormMatrix A = normal.A;
        A.diagonal() *= 1 + damping;
        const FormVector motion = -A.ldlt().solve(normal.b);
        const FormElement next = FormMotion(element, scale).apply(motion);
        const FormEquations next_normal = normal_equations(next, FormMotion(next, scale), points);
        zone.converged = motion.norm() <= kRelativeStepTolerance * scale;
        if (next_normal.square <= normal.square) {
            const double decrease = normal.square - next_normal.square;
            const bool flat = decrease <= std::numeric_limits<double>::epsilon() * normal.square;
            zone.converged |= flat && damping < kMaxNewtonDamping;
            element = next;
            normal = next_normal;
            damping /= 10;
        } else {
            zone.converged |= damping > kMaxDamping; // only roundoff is left to gain
            damping *= 10;
        }
        if (element.radius > kMaxRelativeRadius * scale) throw core::InputError("the points show no curvature to fit");
    }
    zone.element = element;
    const Eigen::VectorXd d = deviations(element, points);
    zone.width = d.maxCoeff() - d.minCoeff();
    return zone;
}

// Moves the element to the middle of its zone. Returns half the zone's width.
double centre_in_zone(FormElement& element, const Eigen::VectorXd& d)
{
    const double middle = (d.maxCoeff() + d.minCoeff()) / 2;
    if (is_flat(element.kind))
        element.point += middle * element.direction;
    else
        element.radius += middle;
    return (d.maxCoeff() - d.minCoeff()) / 2;
}

// Adds the points nearest to either side of the zone. Returns whether any of them was new.
bool add_extremes(const Eigen::VectorXd& d, std::set<Eigen::Index>& working_set)
{
    const std::size_t before = working_set.size();
    std::vector<Eigen::Index> order(d.size());
    std::iota(order.begin(), order.end(), 0);
    const auto end = order.begin() + std::min(order.size(), kPointsPerSide);
    for (const double side : {1.0, -1.0}) {
        const auto outer = [&](Eigen::Index a, Eigen::Index b) {
            return d[a] != d[b] ? side * d[a] > side * d[b] : a < b;
        };
        std::nth_element(order.begin(), end - 1, order.end(), outer);
        working_set.insert(order.begin(), end);
    }
    return working_set.size() > before;
}

// Sequential linear programming with a trust region and a working set of the points that came near the sides so far:
// each programme gives the motion that would be best if the deviations were linear. Where a motion widens the zone,
// either a point outside the working set was in the way, which then joins it, or the motion was too long.
FormZone minimum_zone(const FormZone& start, const Eigen::Matrix3Xd& points, double scale)
{
    FormZone zone = start;
    zone.converged = false;
    Eigen::VectorXd d = deviations(zone.element, points);
    double half_width = centre_in_zone(zone.element, d);
    double trust_radius = 2 * half_width;
    std::set<Eigen::Index> working_set;
    add_extremes(d, working_set);
    for (int step = 0; step < kMaxSteps && !zone.converged; ++step) {
        const std::vector<Eigen::Index> chosen(working_set.begin(), working_set.end());
        const FormMotion motion(zone.element, scale);
        Eigen::MatrixXd G(motion.parameter_count(), chosen.size());
        Eigen::VectorXd r(G.cols());
        for (Eigen::Index i = 0; i < r.size(); ++i) {
            const Eigen::Vector3d point = points.col(chosen[i]);
            r[i] = deviation(zone.element, point);
            G.col(i) = motion.gradient(point);
        }
        const ChebyshevStep best = chebyshev_step(r, G, trust_radius);
        zone.contacts.clear();
        for (const Eigen::Index i : best.contacts) zone.contacts.push_back(chosen[i]);
        const double tolerance = kMinRelativeGain * half_width + kRelativeStepTolerance * scale;
        zone.converged = best.solved && half_width - best.largest <= tolerance;
        if (zone.converged) break;

        FormElement next = motion.apply(best.x);
        d = deviations(next, points);
        const double next_half_width = centre_in_zone(next, d);
        const bool new_points = add_extremes(d, working_set);
        if (next_half_width < half_width) {
            zone.element = next;
            half_width = next_half_width;
            if (best.bounded) trust_radius *= 2;
        } else if (!new_points) {
            trust_radius = best.x.cwiseAbs().maxCoeff() / 4;
        }
    }
    std::sort(zone.contacts.begin(), zone.contacts.end());
    zone.width = 2 * half_width;
    return zone;
}

// Fixes the sign of the direction, whatever the rounding: its largest component is positive.
void orient(FormElement& element)
{
    Eigen::Index largest = 0;
    element.direction.cwiseAbs().maxCoeff(&largest);
    if (element.direction[largest] < 0) element.direction *= -1;
}

void set_deviation_statistics(FormZone& zone, const Eigen::Matrix3Xd& points)
{
    const Eigen::VectorXd d = deviations(zone.element, points);
    zone.peak = d.maxCoeff();
    zone.valley = -d.minCoeff();
    zone.rms = std::sqrt(d.squaredNorm() / d.size());
}

/// Points relative to their centroid, and their least squares element in these coordinates.
struct CentredFit {
    Eigen::Vector3d centroid;
    Eigen::Matrix3Xd points;
    double scale = 0; ///< largest distance of a point from the centroid, mm
    FormZone zone;
};

CentredFit fit_centred(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section)
{
    CentredFit fit;
    fit.centroid = points.cols() > 0 ? Eigen::Vector3d(points.rowwise().mean()) : Eigen::Vector3d::Zero();
    fit.points = points.colwise() - fit.centroid;
    FormElement element = initial_element(kind, fit.points, section);
    orient(element);
    fit.scale = fit.points.colwise().norm().maxCoeff();
    fit.zone = least_squares(element, fit.points, fit.scale);
    return fit;
}

} // namespace

Form evaluate_form(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section)
{
    const CentredFit fit = fit_centred(kind, points, section);
    Form form;
    form.least_squares = fit.zone;
    form.minimum_zone = minimum_zone(form.least_squares, fit.points, fit.scale);
    for (FormZone* zone : {&form.least_squares, &form.minimum_zone}) {
        set_deviation_statistics(*zone, fit.points);
        FormElement& element = zone->element;
        element.point += fit.centroid;
        if (kind == FormKind::cylindricity) // the axis point closest to the centroid
            element.point += element.direction.dot(fit.centroid - element.point) * element.direction;
    }
    return form;
}

std::vector<Eigen::Index> without_outliers(FormKind kind, const Eigen::Matrix3Xd& points, double sigmas,
                                           const Eigen::Vector3d& section)
{
    constexpr int kMaxRounds = 50; // a few suffice, unless points alternate at the bound
    std::vector<Eigen::Index> kept(points.cols());
    std::iota(kept.begin(), kept.end(), 0);
    for (int round = 0; round < kMaxRounds; ++round) {
        CentredFit fit = fit_centred(kind, points(Eigen::all, kept), section);
        fit.zone.element.point += fit.centroid;
        const Eigen::VectorXd d = deviations(fit.zone.element, points);
        // The deviations are those of all points, so that points rejected by mistake return.
        const double bound = std::max(sigmas * geometry::kMedianToSigma * geometry::median_absolute(d),
                                      kRelativeStepTolerance * fit.scale);
        std::vector<Eigen::Index> within;
        for (Eigen::Index i = 0; i < d.size(); ++i)
            if (std::abs(d[i]) <= bound) within.push_back(i);
        if (within == kept) break;
        kept = within;
    }
    return kept;
}

} // namespace fettle::compare
