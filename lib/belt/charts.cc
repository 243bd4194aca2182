#include "belt/charts.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace fettle::belt {
namespace {

// At 45° a chart is stretched by at most √2 in its plane, and a sphere needs about six charts, as a cube has faces.
const double kChartCone = std::cos(std::numbers::pi / 4);

struct Seed {
    int element;
    Eigen::Vector3d outward; ///< unit
};

bool has_direction(const Eigen::Matrix3Xd& normals, int i) { return normals.col(i).squaredNorm() > 0; }

/// Region growing over the elements that no chart has yet.
class RegionGrowing {
  public:
    RegionGrowing(const Adjacency& adjacency, const Eigen::Matrix3Xd& normals)
        : adjacency_(adjacency), normals_(normals), has_chart_(normals.cols(), false)
    {
    }

    /// Grows a chart from the seed; does nothing if the seed has a chart already.
    void grow(const Seed& seed)
    {
        if (has_chart_[seed.element]) return;
        Chart chart;
        chart.axes.col(2) = seed.outward;
        has_chart_[seed.element] = true;
        chart.elements.push_back(seed.element);
        for (std::size_t k = 0; k < chart.elements.size(); ++k) {
            const int i = chart.elements[k];
            if (has_direction(normals_, i))
                chart.min_cosine = std::min(chart.min_cosine, normals_.col(i).dot(seed.outward));
            for (int at = adjacency_.first[i]; at < adjacency_.first[i + 1]; ++at) {
                const int j = adjacency_.next[at];
                if (has_chart_[j]) continue;
                if (has_direction(normals_, j) && normals_.col(j).dot(seed.outward) < kChartCone) continue;
                has_chart_[j] = true;
                chart.elements.push_back(j);
            }
        }
        std::sort(chart.elements.begin(), chart.elements.end());
        charts.push_back(std::move(chart));
    }

    /// Grows charts until all elements have one; elements with a direction are seeds first.
    void grow_rest()
    {
        for (const bool directed : {true, false})
            for (int i = 0; i < normals_.cols(); ++i)
                if (has_direction(normals_, i) == directed)
                    grow({i, directed ? Eigen::Vector3d(normals_.col(i)) : Eigen::Vector3d::UnitZ()});
    }

    std::vector<Chart> charts;

  private:
    const Adjacency& adjacency_;
    const Eigen::Matrix3Xd& normals_;
    std::vector<bool> has_chart_;
};

/// Convex hull, counter-clockwise, without collinear points (Andrew 1979).
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points)
{
    std::sort(points.begin(), points.end(),
              [](const auto& a, const auto& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
    std::vector<Eigen::Vector2d> hull;
    const auto add_all = [&](auto first, auto last) {
        const std::size_t fixed = hull.size();
        for (; first != last; ++first) {
            while (hull.size() >= fixed + 2) {
                const Eigen::Vector2d a = hull[hull.size() - 1] - hull[hull.size() - 2];
                const Eigen::Vector2d b = *first - hull[hull.size() - 2];
                if (a.x() * b.y() - a.y() * b.x() > 0) break;
                hull.pop_back();
            }
            hull.push_back(*first);
        }
        hull.pop_back();
    };
    if (points.size() < 3) return points;
    add_all(points.begin(), points.end());
    add_all(points.rbegin(), points.rend());
    return hull;
}

/// Sides of the points' bounding rectangle along a direction and across it.
Eigen::Vector2d bounding_sides(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& along)
{
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : points)
        box.extend(Eigen::Vector2d(along.dot(p), along.x() * p.y() - along.y() * p.x()));
    return box.sizes();
}

} // namespace

std::vector<Chart> segment_into_charts(const Adjacency& adjacency, const Eigen::Matrix3Xd& normals,
                                       const Eigen::VectorXd& areas)
{
    RegionGrowing first(adjacency, normals);
    first.grow_rest();
    std::vector<double> sizes;
    std::vector<Seed> seeds;
    for (const Chart& chart : first.charts) {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        double size = 0;
        for (const int i : chart.elements) {
            mean += areas[i] * normals.col(i);
            size += areas[i];
        }
        sizes.push_back(size);
        if (mean.norm() > 0)
            mean.normalize();
        else
            mean = chart.axes.col(2);
        const auto seed = std::max_element(chart.elements.begin(), chart.elements.end(), [&](int a, int b) {
            return normals.col(a).dot(mean) < normals.col(b).dot(mean);
        });
        seeds.push_back({*seed, mean});
    }
    std::vector<std::size_t> order(seeds.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
    RegionGrowing second(adjacency, normals);
    for (const std::size_t i : order) second.grow(seeds[i]);
    second.grow_rest();
    return std::move(second.charts);
}

Eigen::Matrix3d min_rectangle_axes(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& outward)
{
    Eigen::Matrix3d axes;
    axes.col(2) = outward;
    axes.col(0) = outward.unitOrthogonal();
    axes.col(1) = outward.cross(axes.col(0));
    std::vector<Eigen::Vector2d> projected;
    for (const auto point : points.colwise()) projected.emplace_back(axes.leftCols<2>().transpose() * point);
    const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(projected));
    double min_area = std::numeric_limits<double>::infinity();
    Eigen::Vector2d best = Eigen::Vector2d::UnitX();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        Eigen::Vector2d along = hull[(i + 1) % hull.size()] - hull[i];
        if (!(along.norm() > 0)) continue;
        along.normalize();
        const Eigen::Vector2d sides = bounding_sides(hull, along);
        if (!(sides.prod() < min_area)) continue;
        min_area = sides.prod();
        best = sides[0] >= sides[1] ? along : Eigen::Vector2d(-along.y(), along.x());
    }
    axes.col(0) = (axes.leftCols<2>() * best).eval().normalized();
    axes.col(1) = outward.cross(axes.col(0));
    return axes;
}

} // namespace fettle::belt
