#include "draw/outline.h"

#include "draw/raster.h"
#include "geometry/point_index.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

namespace fettle::draw {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// Height of a part at x, y as seen from above; NaN: no part there.
using Heights = std::function<double(const Vector2d&)>;

Heights heights_of(const cloud::Cloud& cloud)
{
    // The highest of the points around: where points are sparse, those of the underside lie among them.
    constexpr Index kNeighbours = 8;
    auto index = std::make_shared<geometry::PointIndex<2>>(cloud.xyz.topRows<2>());
    return [index, &cloud](const Vector2d& xy) {
        double height = std::nan("");
        for (const Index i : index->nearest(xy, kNeighbours)) height = std::fmax(height, cloud.xyz(2, i));
        return height;
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
            if (std::isfinite(z) && !(std::abs(z - p.z()) > kMaxSagToSize * across)) p.z() = z; // NaN: any height
            line.push_back(p);
        }
    }
    outline.line.resize(3, Index(line.size()));
    for (std::size_t i = 0; i < line.size(); ++i) outline.line.col(Index(i)) = line[i];
    drop_undersides(outline.line, across);
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
