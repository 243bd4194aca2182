#include "reconstruct/stars.h"

#include "geometry/point_index.h"
#include "geometry/spacing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::reconstruct {
namespace {

constexpr Eigen::Index kNeighbours = 40; // of a star; six of them stay on average
constexpr double kMinNormalCosine = 0.5; // of joined points: beyond is another side of a wall, or an edge

/// A neighbour in the plane of a star.
struct Spoke {
    Eigen::Vector2d place;
    double half_square; ///< of its distance, with both points' weights
    double angle;
    int point;
};

/// Weight of a point, 0 to 1, by its index: four points on a circle, as in every square of a raster, have two Delaunay
/// triangulations, of which weights let all stars take the same.
double weight_of(Eigen::Index point)
{
    constexpr double kGolden = 0.6180339887498949; // its multiples modulo 1 differ
    const double multiple = static_cast<double>(point) * kGolden;
    return multiple - std::floor(multiple);
}
// Weights relative to the squared spacing: more than noise of a twentieth of the spacing changes, too little to hide a
// point.
constexpr double kWeightScale = 5e-3;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Whether the spoke between two others, which follow it on either side, is no edge of the Delaunay star: the bisectors
/// of its neighbours meet before its own.
bool is_hidden(const Spoke& before, const Spoke& spoke, const Spoke& after)
{
    const double turn = cross(before.place, after.place);
    if (turn <= 0) return false; // they enclose half a turn or more: a border
    // Centre of the circle through the star's point and both.
    const double b = before.half_square, a = after.half_square;
    const Eigen::Vector2d centre((b * after.place.y() - a * before.place.y()) / turn,
                                 (a * before.place.x() - b * after.place.x()) / turn);
    return spoke.place.dot(centre) <= spoke.half_square;
}

/// The neighbours of a point in the Delaunay triangulation of its surroundings, counter-clockwise.
std::vector<Spoke> star_of(Eigen::Index i, const geometry::PointIndex<3>& index, const Eigen::Matrix3Xd& xyz,
                           const Eigen::Matrix3Xd& normals, double max_gap, double weight_scale)
{
    const Eigen::Vector3d normal = normals.col(i), u = normal.unitOrthogonal(), v = normal.cross(u);
    std::vector<Spoke> spokes;
    for (const Eigen::Index k : index.nearest(xyz.col(i), kNeighbours)) {
        const Eigen::Vector3d to = xyz.col(k) - xyz.col(i);
        const double length = to.norm();
        if (k == i || length > max_gap || normals.col(k).dot(normal) < kMinNormalCosine) continue;
        // The distance is kept, so that the slope of the surface does not make neighbours nearer.
        const Eigen::Vector2d flat(u.dot(to), v.dot(to));
        if (!(flat.norm() > 0)) continue;
        const Eigen::Vector2d place = flat * (length / flat.norm());
        const double weight = weight_scale * (weight_of(i) - weight_of(k));
        spokes.push_back(
            {place, (length * length + weight) / 2, std::atan2(place.y(), place.x()), static_cast<int>(k)});
    }
    // The nearest spoke of several in one direction comes first, and stays.
    std::ranges::stable_sort(spokes, {}, &Spoke::angle);
    const auto repeated = std::ranges::unique(spokes, {}, &Spoke::angle);
    spokes.erase(repeated.begin(), repeated.end());
    for (bool has_changed = true; has_changed && spokes.size() > 3;) {
        has_changed = false;
        for (std::size_t k = 0; k < spokes.size() && spokes.size() > 3;) {
            const std::size_t n = spokes.size();
            if (is_hidden(spokes[(k + n - 1) % n], spokes[k], spokes[(k + 1) % n])) {
                spokes.erase(spokes.begin() + static_cast<std::ptrdiff_t>(k));
                has_changed = true;
            } else {
                ++k;
            }
        }
    }
    return spokes;
}

/// Triangles of a star, each with its smallest corner first.
std::vector<std::array<int, 3>> triangles_of(int centre, const std::vector<Spoke>& star)
{
    std::vector<std::array<int, 3>> triangles;
    for (std::size_t k = 0; k < star.size(); ++k) {
        const Spoke &first = star[k], &second = star[(k + 1) % star.size()];
        if (star.size() < 2 || cross(first.place, second.place) <= 0) continue; // half a turn: a border
        std::array<int, 3> corners = {centre, first.point, second.point};
        std::ranges::rotate(corners, std::ranges::min_element(corners));
        triangles.push_back(corners);
    }
    return triangles;
}

} // namespace

std::vector<Eigen::Vector3i> star_triangles(const Eigen::Matrix3Xd& xyz, const Eigen::Matrix3Xd& normals,
                                            double max_gap)
{
    const geometry::PointIndex<3> index(xyz);
    const double weight_scale = kWeightScale * std::pow(geometry::point_spacing(xyz), 2);
    std::vector<std::vector<std::array<int, 3>>> stars(static_cast<std::size_t>(xyz.cols()));
    tbb::parallel_for(std::size_t{0}, stars.size(), [&](std::size_t i) {
        const auto point = static_cast<Eigen::Index>(i);
        if (normals.col(point).isZero(0)) return;
        stars[i] = triangles_of(static_cast<int>(i), star_of(point, index, xyz, normals, max_gap, weight_scale));
    });
    std::vector<std::array<int, 3>> all;
    for (const auto& star : stars) all.insert(all.end(), star.begin(), star.end());
    std::ranges::sort(all);
    std::vector<Eigen::Vector3i> agreed;
    for (std::size_t k = 0; k + 2 < all.size(); ++k)
        if (all[k] == all[k + 2]) agreed.emplace_back(all[k][0], all[k][1], all[k][2]);
    return agreed;
}

} // namespace fettle::reconstruct
