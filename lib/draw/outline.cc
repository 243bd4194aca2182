#include "draw/outline.h"

#include "core/constants.h"
#include "draw/raster.h"
#include "geometry/point_index.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace fettle::draw {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// Height of a part at x, y as seen from above; NaN: no part there.
using Heights = std::function<double(const Vector2d&)>;

/// Do points lie in all directions from `xy`, so that no half-plane without one begins there?
bool are_around(const Eigen::Matrix3Xd& points, const Vector2d& xy)
{
    std::vector<double> angles;
    for (const Eigen::Vector3d& p : points.colwise()) angles.push_back(std::atan2(p.y() - xy.y(), p.x() - xy.x()));
    std::ranges::sort(angles);
    double widest = angles.front() + 2 * std::numbers::pi - angles.back();
    for (std::size_t k = 1; k < angles.size(); ++k) widest = std::max(widest, angles[k] - angles[k - 1]);
    return widest < std::numbers::pi;
}

/// Selects the points on the part's top from those around a place, nearest first, if an underside shows between them:
/// their heights then lie in two groups, and the upper ones surround the place. Otherwise it returns none.
Eigen::Matrix3Xd over_an_underside(const Eigen::Matrix3Xd& near, const Vector2d& xy)
{
    constexpr double kMinGapToRange = 0.5; // on one surface, also a steep one, heights are spread over their range
    std::vector<double> z(near.row(2).begin(), near.row(2).end());
    std::ranges::sort(z);
    std::size_t above = 0; // the first of the upper group
    double gap = 0;
    for (std::size_t k = 1; k < z.size(); ++k)
        if (z[k] - z[k - 1] > gap) {
            gap = z[k] - z[k - 1];
            above = k;
        }
    if (above == 0 || gap < kMinGapToRange * (z.back() - z.front())) return {};
    std::vector<Index> upper;
    for (Index i = 0; i < near.cols(); ++i)
        if (near(2, i) >= z[above]) upper.push_back(i);
    const Eigen::Matrix3Xd top = near(Eigen::all, upper);
    return are_around(top, xy) ? top : Eigen::Matrix3Xd();
}

Heights heights_of(const cloud::Cloud& cloud)
{
    // The highest of the points around, in a wider circle where an underside shows through a sparse top.
    static constexpr Index kNeighbours = 8, kWideNeighbours = 64;
    Eigen::Matrix2Xd plan = cloud.xyz.topRows<2>();
    for (Index i = 0; i < plan.cols(); ++i)
        if (!std::isfinite(cloud.xyz(2, i))) plan.col(i).setConstant(core::kNaN);
    auto index = std::make_shared<geometry::PointIndex<2>>(plan);
    return [index, &cloud](const Vector2d& xy) {
        const std::vector<Index> found = index->nearest(xy, kWideNeighbours);
        if (found.empty()) return std::nan("");
        const Eigen::Matrix3Xd near = cloud.xyz(Eigen::all, found);
        if (const Eigen::Matrix3Xd top = over_an_underside(near, xy); top.cols() > 0) return top(2, 0);
        return near.row(2).head(std::min<Index>(kNeighbours, near.cols())).maxCoeff();
    };
}

/// @param pixel  of the raster that the mesh is drawn to, mm
Heights heights_of(const mesh::Mesh& mesh, const Eigen::Matrix3Xd& polygon, double pixel)
{
    constexpr double kMarginPixels = 2;
    const Vector2d low = polygon.topRows<2>().rowwise().minCoeff(), high = polygon.topRows<2>().rowwise().maxCoeff();
    const Vector2d size = (high - low) / pixel + Vector2d::Constant(2 * kMarginPixels + 1);
    const View view = {low - Vector2d::Constant(kMarginPixels * pixel), pixel, static_cast<int>(std::ceil(size.x())),
                       static_cast<int>(std::ceil(size.y()))};
    auto raster = std::make_shared<Raster>(rasterise(view, mesh, mesh.vertices.row(2).transpose()));
    return [view, raster](const Vector2d& xy) {
        const Eigen::Array2i cell = view.to_pixel(xy).array().floor().cast<int>();
        if ((cell < 0).any() || cell.x() >= view.columns || cell.y() >= view.rows) return std::nan("");
        return raster->covered(cell.y(), cell.x()) ? raster->depth(cell.y(), cell.x()) : std::nan("");
    };
}

/// Fills unknown heights along a closed line from the known ones before and after; 0 if none is known.
void fill_heights(Eigen::Matrix3Xd& line)
{
    std::vector<Index> known;
    for (Index i = 0; i < line.cols(); ++i)
        if (std::isfinite(line(2, i))) known.push_back(i);
    if (known.empty()) {
        line.row(2).setZero();
        return;
    }
    const Index count = line.cols();
    for (std::size_t k = 0; k < known.size(); ++k) {
        const Index from = known[k], to = k + 1 < known.size() ? known[k + 1] : known.front() + count;
        for (Index i = from + 1; i < to; ++i)
            line(2, i % count) = std::lerp(line(2, from), line(2, to % count), double(i - from) / double(to - from));
    }
}

/// Makes heights unknown that lie far below those before and after: undersides, seen in a gap of sparse points.
void drop_undersides(Eigen::Matrix3Xd& line, double across)
{
    constexpr Index kHalfWindow = 12; // longer gaps are holes
    constexpr double kMinDropToSize = 0.04;
    const Eigen::VectorXd z = line.row(2);
    for (Index i = 0; i < z.size(); ++i) {
        std::vector<double> around;
        for (Index k = -kHalfWindow; k <= kHalfWindow; ++k)
            if (const double other = z[(i + k + z.size() * kHalfWindow) % z.size()]; std::isfinite(other))
                around.push_back(other);
        if (around.empty()) continue;
        std::ranges::nth_element(around, around.begin() + around.size() / 2);
        if (z[i] < around[around.size() / 2] - kMinDropToSize * across) line(2, i) = std::nan("");
    }
}

Outline outline_on(const mesh::MeshOrCloud& part, const Eigen::Matrix3Xd& polygon, const std::string& name)
{
    constexpr double kPixelsAcross = 240, kStepPixels = 2;
    const double across =
        (polygon.topRows<2>().rowwise().maxCoeff() - polygon.topRows<2>().rowwise().minCoeff()).maxCoeff();
    const double pixel = std::max(across / kPixelsAcross, 1e-9);
    const mesh::Mesh* mesh = std::get_if<mesh::Mesh>(&part);
    const Heights height_at =
        mesh != nullptr ? heights_of(*mesh, polygon, pixel) : heights_of(std::get<cloud::Cloud>(part));
    Outline outline = {name, polygon, {}};
    std::vector<Eigen::Vector3d> line;
    std::vector<double> taught; // heights of the job's own edges
    std::vector<Index> corner_at;
    for (Index i = 0; i < polygon.cols(); ++i) {
        const Eigen::Vector3d from = polygon.col(i), to = polygon.col((i + 1) % polygon.cols());
        const int steps = std::max(1, static_cast<int>((to - from).head<2>().norm() / pixel / kStepPixels));
        corner_at.push_back(Index(line.size()));
        for (int k = 0; k < steps; ++k) {
            Eigen::Vector3d p = from + double(k) / steps * (to - from);
            const double z = height_at(p.head<2>());
            // A height farther off the edge than it can sink into a curved part is that of an underside, seen in a gap
            // of sparse points.
            constexpr double kMaxSagToSize = 0.15;
            taught.push_back(p.z());
            if (std::isfinite(z)) p.z() = std::abs(z - p.z()) > kMaxSagToSize * across ? core::kNaN : z;
            line.push_back(p);
        }
    }
    outline.line.resize(3, Index(line.size()));
    for (std::size_t i = 0; i < line.size(); ++i) outline.line.col(Index(i)) = line[i];
    drop_undersides(outline.line, across);
    if (!outline.line.row(2).array().isFinite().any())
        for (std::size_t i = 0; i < taught.size(); ++i) outline.line(2, Index(i)) = taught[i];
    fill_heights(outline.line);
    for (Index i = 0; i < polygon.cols(); ++i)
        if (!std::isfinite(outline.corners(2, i))) outline.corners(2, i) = outline.line(2, corner_at[std::size_t(i)]);
    return outline;
}

} // namespace

std::vector<Outline> outlines_on(const mesh::MeshOrCloud& part, const job::Job& job)
{
    std::vector<Outline> outlines;
    if (job.sampling.cols() > 0) outlines.push_back(outline_on(part, job.sampling, "S"));
    if (job.anomaly.cols() > 0) outlines.push_back(outline_on(part, job.anomaly, "B"));
    return outlines;
}

} // namespace fettle::draw
