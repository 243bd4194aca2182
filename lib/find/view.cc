#include "find/view.h"

#include "align/oriented_points.h"
#include "core/direction.h"
#include "core/error.h"
#include "geometry/bounding_box.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::find {
namespace {

using Eigen::Index;

constexpr Index kMaxViewPoints = 20000;   // samples of a surface from which views are chosen
constexpr Index kMaxOwnSidePoints = 4000; // of a cloud without normals, whose normals are estimated first
constexpr int kDirections = 200;          // tried: neighbours are about 14 degrees apart
constexpr double kMinCosine = 0.5;        // of the angle between normal and view: 60 degrees
constexpr double kSeenShare = 0.98;       // of what any direction sees
constexpr double kMinGain = 0.01;         // of the samples, that a further view must add
constexpr double kOwnSideShare = 0.5;     // of a cloud without normals, seen from +z: then there is no other view
constexpr double kFaceCosine = 0.9;       // normals within 26 degrees of a direction are of one face
constexpr int kShifts = 4;                // after which the mean hardly moves
constexpr double kMaxSideCells = 1000;    // of a part: bounds the memory where one point lies far off
constexpr double kOcclusionCells = 3;     // samples deeper beneath the highest of a cell are occluded

struct Samples {
    align::OrientedPoints points;
    double spacing; // about, mm
    bool is_outward;
};

Samples samples_of(const mesh::CloudMesh& part)
{
    Samples samples;
    if (part.is_mesh()) {
        samples.points = align::oriented_points({part.points.xyz, part.triangles}, kMaxViewPoints);
        samples.is_outward = true;
    } else {
        samples.is_outward = cloud::has_normals(part.points);
        const Index max_points = samples.is_outward ? kMaxViewPoints : kMaxOwnSidePoints;
        samples.points = align::oriented_points(
            cloud::select_points(part.points, align::scattered_indices(part.points.size(), max_points)));
    }
    const Index count = samples.points.xyz.cols();
    if (count < 3) throw core::InputError("no surface: fewer than three points are finite");
    const Eigen::Vector3d sizes = geometry::bounding_box(samples.points.xyz).sizes();
    // A surface is about as large as the box's two larger sides span.
    const double area = sizes.prod() > 0 ? sizes.prod() / sizes.minCoeff() : sizes.squaredNorm();
    samples.spacing = std::sqrt(area / double(count));
    return samples;
}

/// Directions spread evenly over the sphere: Fibonacci's lattice; +z is the first.
std::vector<Eigen::Vector3d> directions()
{
    std::vector<Eigen::Vector3d> result{Eigen::Vector3d::UnitZ()};
    for (int axis = 0; axis < 3; ++axis)
        for (const int sign : {1, -1})
            if (axis < 2 || sign < 0) result.push_back(sign * Eigen::Vector3d::Unit(axis));
    for (int i = 0; i < kDirections; ++i) {
        const double z = 1 - (2 * i + 1.0) / kDirections, turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        result.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    }
    return result;
}

View view_from(const Eigen::Vector3d& direction)
{
    return View(core::rotation_between(direction, Eigen::Vector3d::UnitZ()));
}

/// Marks the samples that are seen from a direction: those that face it and are not occluded.
std::vector<char> seen_from(const Samples& samples, const Eigen::Vector3d& direction)
{
    const Eigen::Matrix3Xd placed = view_from(direction) * samples.points.xyz;
    const Eigen::Vector3d min = placed.rowwise().minCoeff(), max = placed.rowwise().maxCoeff();
    const double cell = std::max(3 * samples.spacing, (max - min).head<2>().maxCoeff() / kMaxSideCells);
    if (!(cell > 0)) return std::vector<char>(std::size_t(placed.cols())); // all points at one place are no surface
    const auto columns = Index((max.x() - min.x()) / cell) + 1, rows = Index((max.y() - min.y()) / cell) + 1;
    std::vector<double> top(std::size_t(columns * rows), -std::numeric_limits<double>::infinity());
    const auto cell_of = [&](Index i) {
        return std::size_t(Index((placed(1, i) - min.y()) / cell) * columns + Index((placed(0, i) - min.x()) / cell));
    };
    for (Index i = 0; i < placed.cols(); ++i) top[cell_of(i)] = std::max(top[cell_of(i)], placed(2, i));
    std::vector<char> is_seen(std::size_t(placed.cols()));
    for (Index i = 0; i < placed.cols(); ++i) {
        const double cosine = samples.points.normals.col(i).dot(direction);
        is_seen[std::size_t(i)] = (samples.is_outward ? cosine : std::abs(cosine)) >= kMinCosine &&
                                  placed(2, i) > top[cell_of(i)] - kOcclusionCells * cell;
    }
    return is_seen;
}

/// The nearest mode of the normals by mean shift, so that a face is seen along its own normal. In an oblique view the
/// points of a cell differ much in height.
Eigen::Vector3d towards_face(const Samples& samples, Eigen::Vector3d direction, const std::vector<char>& is_covered)
{
    for (int step = 0; step < kShifts; ++step) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (Index i = 0; i < samples.points.xyz.cols(); ++i) {
            const auto normal = samples.points.normals.col(i);
            if (!is_covered[std::size_t(i)] && normal.dot(direction) >= kFaceCosine) sum += normal;
        }
        if (sum.norm() > 0) direction = sum.normalized();
    }
    return direction;
}

/// Number of samples that a direction would add to the covered ones: a face seen along its normal has weight 1, one
/// seen at 60 degrees 1/16.
double gain_of(const Samples& samples, const Eigen::Vector3d& direction, const std::vector<char>& is_seen,
               const std::vector<char>& is_covered)
{
    double gain = 0;
    for (std::size_t i = 0; i < is_seen.size(); ++i)
        if (is_seen[i] && !is_covered[i]) gain += std::pow(samples.points.normals.col(Index(i)).dot(direction), 4);
    return gain;
}

/// Whether a cloud without normals is seen from this direction alone: the back of its points need not be a surface.
bool is_own_side(const Samples& samples, const Eigen::Vector3d& direction)
{
    const std::vector<char> is_seen = seen_from(samples, direction);
    const auto count = double(is_seen.size());
    return gain_of(samples, direction, is_seen, std::vector<char>(is_seen.size(), 0)) >= kMinGain * count &&
           double(std::ranges::count(is_seen, 1)) > kOwnSideShare * count;
}

} // namespace

std::vector<View> choose_views(const mesh::CloudMesh& part)
{
    const Samples samples = samples_of(part);
    const std::vector<Eigen::Vector3d> all = directions();
    if (!samples.is_outward && is_own_side(samples, all[0])) return {view_from(all[0])};
    std::vector<std::vector<char>> seen(all.size());
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t d) { seen[d] = seen_from(samples, all[d]); });
    const auto count = std::size_t(samples.points.xyz.cols());
    std::vector<char> is_covered(count, 0);
    std::size_t coverable = 0, covered = 0;
    for (std::size_t i = 0; i < count; ++i)
        coverable += std::ranges::any_of(seen, [&](const std::vector<char>& one) { return one[i]; });
    std::vector<View> views;
    while (double(covered) < kSeenShare * double(coverable)) {
        std::size_t best = 0;
        double best_gain = gain_of(samples, all[0], seen[0], is_covered);
        // A cloud's own direction is +z.
        if (samples.is_outward || !views.empty() || best_gain < kMinGain * double(count))
            for (std::size_t d = 1; d < all.size(); ++d)
                if (const double gain = gain_of(samples, all[d], seen[d], is_covered); gain > best_gain)
                    best = d, best_gain = gain;
        if (best_gain < kMinGain * double(count)) break;
        const Eigen::Vector3d direction = samples.is_outward ? towards_face(samples, all[best], is_covered) : all[best];
        const std::vector<char> is_seen = seen_from(samples, direction);
        const std::size_t before = covered;
        for (std::size_t i = 0; i < count; ++i) {
            covered += (is_seen[i] || seen[best][i]) && !is_covered[i];
            is_covered[i] |= is_seen[i] | seen[best][i];
        }
        if (covered == before) break;
        views.push_back(view_from(direction));
        if (views.size() == 1 && !samples.is_outward && double(covered) > kOwnSideShare * double(count)) break;
    }
    if (views.empty()) views.push_back(View::Identity());
    return views;
}

} // namespace fettle::find
