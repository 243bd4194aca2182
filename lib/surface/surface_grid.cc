#include "surface/surface_grid.h"

#include "core/error.h"
#include "core/text.h"

#include <cmath>

namespace fettle {

namespace {

// A length that is a multiple of the step must get its last row whatever the rounding.
constexpr double kRounding = 1e-9;

Eigen::Matrix3Xi columns(const std::vector<Eigen::Vector3i>& list)
{
    Eigen::Matrix3Xi matrix(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) matrix.col(static_cast<Eigen::Index>(i)) = list[i];
    return matrix;
}

} // namespace

SurfaceGrid grid_over(const Polygon& outline, double angle, double step)
{
    const Eigen::Vector2d least = outline.rowwise().minCoeff();
    const Eigen::Array2d counts = ((outline.rowwise().maxCoeff() - least) / step).array() + kRounding;
    const Eigen::Array2d whole = counts.floor() + 1;
    if (!(whole.prod() <= kMostGridPoints))
        throw InputError("a grid of " + to_text(whole.x()) + " by " + to_text(whole.y()) + " points is too fine");

    const Eigen::Array2i size = whole.cast<int>();
    Eigen::MatrixXi number = Eigen::MatrixXi::Constant(size.x(), size.y(), -1);
    std::vector<Eigen::Vector2d> points;
    for (int j = 0; j < size.y(); ++j)
        for (int i = 0; i < size.x(); ++i) {
            const Eigen::Vector2d p = least + step * Eigen::Vector2d(i, j);
            if (!contains(outline, p)) continue;
            number(i, j) = static_cast<int>(points.size());
            points.push_back(p);
        }
    std::vector<Eigen::Vector3i> triangles;
    for (int j = 0; j + 1 < size.y(); ++j)
        for (int i = 0; i + 1 < size.x(); ++i) {
            const Eigen::Matrix2i corner = number.block<2, 2>(i, j);
            if (corner.minCoeff() < 0) continue;
            triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
            triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
        }
    SurfaceGrid grid;
    grid.xy.resize(2, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) grid.xy.col(static_cast<Eigen::Index>(i)) = points[i];
    grid.xy = rotation_working_machine(angle).transpose() * grid.xy;
    grid.triangles = columns(triangles);
    return grid;
}

Polygon touched_box(const Surface& surface, const std::string& source)
{
    if (surface.touches.cols() == 0) throw InputError(source, "has no touches whose extent a grid could have");
    const Eigen::Vector2d least = surface.touches.topRows(2).rowwise().minCoeff();
    const Eigen::Vector2d most = surface.touches.topRows(2).rowwise().maxCoeff();
    Polygon box(2, 4);
    box << least.x(), most.x(), most.x(), least.x(), least.y(), least.y(), most.y(), most.y();
    return box;
}

Mesh mesh_of(const Surface& surface, const SurfaceGrid& grid)
{
    Mesh mesh;
    mesh.vertices.resize(3, grid.xy.cols());
    mesh.vertices << grid.xy, heights(surface, grid.xy).transpose();
    std::vector<Eigen::Vector3i> defined;
    for (Eigen::Index i = 0; i < grid.triangles.cols(); ++i)
        if (mesh.vertices(2, grid.triangles.col(i)).allFinite()) defined.push_back(grid.triangles.col(i));
    mesh.triangles = columns(defined);
    return mesh;
}

} // namespace fettle
