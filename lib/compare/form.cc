#include "compare/form.h"

#include "compare/chebyshev.h"
#include "compare/form_start.h"
#include "core/error.h"

#include <Eigen/Dense>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace fettle {

namespace {

// Levenberg's damping, times the diagonal: below the first a step is Newton's, above the second it is nothing.
constexpr double kHardlyDamped = 1e-6;
constexpr double kStuck = 1e6;
constexpr Eigen::Index kGrain = 4096; // points a task; fixed, so that the sums come in one order

// Gauss-Newton from a near start converges in a few steps; noise and short arcs cost some more.
constexpr int kMostSteps = 200;
// A step shorter than this share of the part's size is roundoff.
constexpr double kStill = 1e-14;
// Beyond this many part sizes a radius is indistinguishable from none in float coordinates.
constexpr double kLargestRadius = 1e6;

// A zone that the best motion would narrow by less than this share is the narrowest: roundoff of the programme.
constexpr double kLeastGain = 1e-11;
// Points a side that a programme starts with: more than can hold the zone, few enough to be quick.
constexpr std::size_t kWatched = 100;

/// JᵀJ, Jᵀr and the sum of squares.
struct Normal {
    FormMatrix A;
    FormVector b;
    double square = 0;
};

Normal normal_equations(const FormElement& element, const FormMotion& motion, const Eigen::Matrix3Xd& points)
{
    const Eigen::Index m = motion.parameters();
    const Normal nothing{FormMatrix::Zero(m, m), FormVector::Zero(m), 0};
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<Eigen::Index>(0, points.cols(), kGrain), nothing,
        [&](const tbb::blocked_range<Eigen::Index>& range, Normal sum) {
            for (Eigen::Index i = range.begin(); i < range.end(); ++i) {
                const double r = deviation(element, points.col(i));
                const FormVector g = motion.gradient(points.col(i));
                sum.A.noalias() += g * g.transpose();
                sum.b += r * g;
                sum.square += r * r;
            }
            return sum;
        },
        [](Normal a, const Normal& b) {
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
    double damping = 1e-3; // Marquardt's first value; it only steers how the way begins
    Normal normal = normal_equations(element, FormMotion(element, scale), points);
    for (int step = 0; step < kMostSteps && !zone.converged; ++step) {
        FormMatrix A = normal.A;
        A.diagonal() *= 1 + damping;
        const FormVector motion = -A.ldlt().solve(normal.b);
        const FormElement next = FormMotion(element, scale).moved(motion);
        const Normal there = normal_equations(next, FormMotion(next, scale), points);
        zone.converged = motion.norm() <= kStill * scale;
        if (there.square <= normal.square) {
            const bool flat = normal.square - there.square <= std::numeric_limits<double>::epsilon() * normal.square;
            zone.converged |= flat && damping < kHardlyDamped;
            element = next;
            normal = there;
            damping /= 10;
        } else {
            zone.converged |= damping > kStuck; // only roundoff is left to gain
            damping *= 10;
        }
        if (element.radius > kLargestRadius * scale) throw InputError("the points show no curvature to fit");
    }
    zone.element = element;
    const Eigen::VectorXd d = deviations(element, points);
    zone.width = d.maxCoeff() - d.minCoeff();
    return zone;
}

// Puts the element into the middle of its zone; returns half the zone's width.
double centre(FormElement& element, const Eigen::VectorXd& d)
{
    const double middle = (d.maxCoeff() + d.minCoeff()) / 2;
    if (is_flat(element.kind))
        element.point += middle * element.direction;
    else
        element.radius += middle;
    return (d.maxCoeff() - d.minCoeff()) / 2;
}

// Adds the points nearest either side of the zone. Returns whether any was new.
bool add_extremes(const Eigen::VectorXd& d, std::set<Eigen::Index>& watched)
{
    const std::size_t before = watched.size();
    std::vector<Eigen::Index> order(static_cast<std::size_t>(d.size()));
    std::iota(order.begin(), order.end(), 0);
    const auto few = std::min(order.size(), kWatched);
    for (const double side : {1.0, -1.0}) {
        const auto outer = [&](Eigen::Index a, Eigen::Index b) {
            return d[a] != d[b] ? side * d[a] > side * d[b] : a < b;
        };
        std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(few - 1), order.end(), outer);
        watched.insert(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(few));
    }
    return watched.size() > before;
}

// The zone is narrowed by linear programmes over the points that came near its sides so far: each gives the motion that
// would be best if the deviations were linear. A motion that does not help was too far, or another point stood in its
// way; that one is watched from then on.
FormZone minimum_zone(const FormZone& start, const Eigen::Matrix3Xd& points, double scale)
{
    FormZone zone = start;
    zone.converged = false;
    Eigen::VectorXd d = deviations(zone.element, points);
    double half = centre(zone.element, d);
    double reach = 2 * half;
    std::set<Eigen::Index> watched;
    add_extremes(d, watched);
    for (int step = 0; step < kMostSteps && !zone.converged; ++step) {
        const std::vector<Eigen::Index> chosen(watched.begin(), watched.end());
        const FormMotion motion(zone.element, scale);
        Eigen::MatrixXd G(motion.parameters(), static_cast<Eigen::Index>(chosen.size()));
        Eigen::VectorXd r(G.cols());
        for (Eigen::Index i = 0; i < r.size(); ++i) {
            const Eigen::Vector3d point = points.col(chosen[static_cast<std::size_t>(i)]);
            r[i] = deviation(zone.element, point);
            G.col(i) = motion.gradient(point);
        }
        const ChebyshevStep best = chebyshev_step(r, G, reach);
        zone.contacts.clear();
        for (const Eigen::Index i : best.contacts) zone.contacts.push_back(chosen[static_cast<std::size_t>(i)]);
        zone.converged = best.solved && half - best.largest <= kLeastGain * half + kStill * scale;
        if (zone.converged) break;

        FormElement next = motion.moved(best.x);
        d = deviations(next, points);
        const double next_half = centre(next, d);
        const bool new_points = add_extremes(d, watched);
        if (next_half < half) {
            zone.element = next;
            half = next_half;
            if (best.bounded) reach *= 2;
        } else if (!new_points) {
            reach = best.x.cwiseAbs().maxCoeff() / 4;
        }
    }
    std::sort(zone.contacts.begin(), zone.contacts.end());
    zone.width = 2 * half;
    return zone;
}

// One of the two signs of a direction, whatever the rounding: its largest component is positive.
void orient(FormElement& element)
{
    Eigen::Index largest = 0;
    element.direction.cwiseAbs().maxCoeff(&largest);
    if (element.direction[largest] < 0) element.direction *= -1;
}

// What the deviations say, with the element where it is.
void measure(FormZone& zone, const Eigen::Matrix3Xd& points)
{
    const Eigen::VectorXd d = deviations(zone.element, points);
    zone.peak = d.maxCoeff();
    zone.valley = -d.minCoeff();
    zone.rms = std::sqrt(d.squaredNorm() / static_cast<double>(d.size()));
}

/// The points about their centroid, and the element of least squares there.
struct Start {
    Eigen::Vector3d centroid;
    Eigen::Matrix3Xd about;
    double scale = 0;
    FormZone zone;
};

Start start_of(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section)
{
    Start start;
    start.centroid = points.cols() > 0 ? Eigen::Vector3d(points.rowwise().mean()) : Eigen::Vector3d::Zero();
    start.about = points.colwise() - start.centroid;
    FormElement element = form_start(kind, start.about, section);
    orient(element);
    start.scale = start.about.colwise().norm().maxCoeff();
    start.zone = least_squares(element, start.about, start.scale);
    return start;
}

double median_size(Eigen::VectorXd d)
{
    d = d.cwiseAbs().eval();
    std::nth_element(d.begin(), d.begin() + d.size() / 2, d.end());
    return d[d.size() / 2];
}

} // namespace

Form form(FormKind kind, const Eigen::Matrix3Xd& points, const Eigen::Vector3d& section)
{
    const Start start = start_of(kind, points, section);
    Form form;
    form.least_squares = start.zone;
    form.minimum_zone = minimum_zone(form.least_squares, start.about, start.scale);
    for (FormZone* zone : {&form.least_squares, &form.minimum_zone}) {
        measure(*zone, start.about);
        zone->element.point += start.centroid;
        if (kind == FormKind::cylindricity) // the axis point beside the middle of the points
            zone->element.point +=
                zone->element.direction.dot(start.centroid - zone->element.point) * zone->element.direction;
    }
    return form;
}

std::vector<Eigen::Index> without_outliers(FormKind kind, const Eigen::Matrix3Xd& points, double sigmas,
                                           const Eigen::Vector3d& section)
{
    constexpr double kMedianToSigma = 1.4826; // of a normal distribution
    constexpr int kMostRounds = 50;           // a few do, unless points go in and out at the bound
    std::vector<Eigen::Index> kept(static_cast<std::size_t>(points.cols()));
    std::iota(kept.begin(), kept.end(), 0);
    for (int round = 0; round < kMostRounds; ++round) {
        Start start = start_of(kind, points(Eigen::all, kept), section);
        start.zone.element.point += start.centroid;
        const Eigen::VectorXd d = deviations(start.zone.element, points);
        // Of all points: those left out by mistake come back.
        const double bound = std::max(sigmas * kMedianToSigma * median_size(d), kStill * start.scale);
        std::vector<Eigen::Index> within;
        for (Eigen::Index i = 0; i < d.size(); ++i)
            if (std::abs(d[i]) <= bound) within.push_back(i);
        if (within == kept) break;
        kept = within;
    }
    return kept;
}

} // namespace fettle
