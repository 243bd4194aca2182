#include "find/view.h"

#include "align/oriented_points.h"
#include "core/error.h"
#include "geometry/bounding_box.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::find {
namespace {

using Eigen::Index;

constexpr Index kMaxViewPoints = 20000; // samples of a surface from which views are chosen
constexpr int kDirections = 200;        // tried: neighbours are about 14 degrees apart
constexpr double kMinCosine = 0.5;      // of the angle between normal and view: 60 degrees
constexpr double kSeenShare = 0.98;     // of what any direction sees
constexpr double kMinGain = 0.01;       // a view that adds less is none
constexpr double kOcclusionCells = 3;   // what lies deeper beneath what is seen is hidden

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
        const cloud::Cloud some =
            cloud::select_points(part.points, align::evenly_spaced_indices(part.points.size(), kMaxViewPoints));
        samples.points = align::oriented_points(some);
        samples.is_outward = cloud::has_normals(part.points);
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
    return View(Eigen::Quaterniond::FromTwoVectors(direction, Eigen::Vector3d::UnitZ()));
}

/// Which samples are seen from a direction: those that face it, beneath no other.
std::vector<char> seen_from(const Samples& samples, const Eigen::Vector3d& direction)
{
    const Eigen::Matrix3Xd placed = view_from(direction) * samples.points.xyz;
    const Eigen::Vector3d min = placed.rowwise().minCoeff(), max = placed.rowwise().maxCoeff();
    const double cell = 3 * samples.spacing;
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

} // namespace

std::vector<View> choose_views(const mesh::CloudMesh& part)
{
    const Samples samples = samples_of(part);
    const std::vector<Eigen::Vector3d> all = directions();
    std::vector<std::vector<char>> seen(all.size());
    for (std::size_t d = 0; d < all.size(); ++d) seen[d] = seen_from(samples, all[d]);
    const auto count = std::size_t(samples.points.xyz.cols());
    std::vector<char> is_covered(count, 0);
    std::size_t coverable = 0, covered = 0;
    for (std::size_t i = 0; i < count; ++i)
        coverable += std::ranges::any_of(seen, [&](const std::vector<char>& one) { return one[i]; });
    std::vector<View> views;
    const auto gain_of = [&](std::size_t d) {
        std::size_t gain = 0;
        for (std::size_t i = 0; i < count; ++i) gain += seen[d][i] && !is_covered[i];
        return gain;
    };
    while (double(covered) < kSeenShare * double(coverable)) {
        std::size_t best = 0, best_gain = gain_of(0);
        if (!views.empty() || double(best_gain) < kMinGain * double(count))
            for (std::size_t d = 1; d < all.size(); ++d)
                if (const std::size_t gain = gain_of(d); gain > best_gain) best = d, best_gain = gain;
        if (double(best_gain) < kMinGain * double(count)) break;
        for (std::size_t i = 0; i < count; ++i) is_covered[i] |= seen[best][i];
        covered += best_gain;
        views.push_back(view_from(all[best]));
        // A cloud's own direction is +z: without normals nothing says that what lies under it is a surface.
        if (views.size() == 1 && !samples.is_outward && double(covered) > 0.5 * double(count)) break;
    }
    if (views.empty()) views.push_back(View::Identity());
    return views;
}

} // namespace fettle::find
