#include "belt/charts.h"
#include "belt/sampling.h"
#include "core/error.h"
#include "geometry/point_index.h"
#include "geometry/quantiles.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::belt {
namespace {

// Neighbours of a surfel for growing charts: two rings of a hexagonal lattice have 18, of which a border cuts some off.
constexpr Eigen::Index kNeighbours = 12;
// Distance beyond which neighbours are separated by a gap, in multiples of the median nearest-neighbour distance.
constexpr double kGapDistanceRatio = 3;

/// Indices of points none of which is closer to an earlier one than the spacing.
std::vector<Eigen::Index> thin_points(const Eigen::Matrix3Xd& points, double spacing)
{
    const geometry::PointIndex<3> index(points);
    std::vector<bool> is_dropped(points.cols());
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector3d p = points.col(i);
        if (is_dropped[i] || !p.allFinite()) continue;
        kept.push_back(i);
        for (const Eigen::Index other : index.radius_search(p, spacing))
            if ((points.col(other) - p).squaredNorm() < spacing * spacing) is_dropped[other] = true;
    }
    return kept;
}

/// Neighbours of each point, and the distance of nearest neighbours.
struct Neighbourhood {
    Adjacency adjacency;
    double distance = 0; ///< median, at least the spacing, mm
};

Neighbourhood neighbourhood(const Eigen::Matrix3Xd& points, double spacing)
{
    const geometry::PointIndex<3> neighbours(points);
    std::vector<std::vector<Eigen::Index>> near(points.cols());
    tbb::parallel_for(Eigen::Index{0}, points.cols(),
                      [&](Eigen::Index i) { near[i] = neighbours.nearest(points.col(i), kNeighbours + 1); });
    std::vector<double> distances = {0};
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (near[i].size() > 1) distances.push_back((points.col(near[i][1]) - points.col(i)).norm());
    Neighbourhood found{{}, std::max(spacing, geometry::median(distances))};
    Adjacency& adjacency = found.adjacency;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        adjacency.first.push_back(static_cast<int>(adjacency.next.size()));
        for (const Eigen::Index j : near[i])
            if (j != i && (points.col(j) - points.col(i)).norm() <= kGapDistanceRatio * found.distance)
                adjacency.next.push_back(static_cast<int>(j));
    }
    adjacency.first.push_back(static_cast<int>(adjacency.next.size()));
    return found;
}

} // namespace

SampledDesign sample_surfels(const cloud::Cloud& design, const std::string& source, const SurfelSampling& options)
{
    const std::vector<Eigen::Index> kept = thin_points(design.xyz, options.spacing);
    if (kept.empty()) throw core::InputError(source, "no points");
    SampledDesign sampled;
    Surfels& surfels = sampled.surfels;
    surfels = surfels_from_cloud(cloud::select_points(design, kept), source);
    const Neighbourhood near = neighbourhood(surfels.position, options.spacing);
    const std::vector<Chart> charts =
        segment_into_charts(near.adjacency, surfels.normal, Eigen::VectorXd::Ones(surfels.size()));
    surfels.radius.setConstant(near.distance);
    surfels.displacement.setZero();
    surfels.area.resize(0);
    for (std::size_t c = 0; c < charts.size(); ++c) {
        const std::vector<int>& elements = charts[c].elements;
        const Eigen::Matrix3Xd points = surfels.position(Eigen::all, elements);
        const Eigen::Matrix3d axes = min_rectangle_axes(points, charts[c].axes.col(2));
        surfels.uv(Eigen::all, elements) = axes.leftCols<2>().transpose() * points;
        for (const int i : elements) surfels.patch[i] = static_cast<int>(c);
    }
    sampled.patches = static_cast<int>(charts.size());
    sampled.min_spacing = near.distance;
    return sampled;
}

} // namespace fettle::belt
