#include "surface/surface_grid.h"

#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"

namespace fettle::surface {

namespace {

// In steps: a length that is a multiple of the step gets its last row despite rounding.
constexpr double kStepTolerance = 1e-9;

} // namespace

SurfaceGrid make_surface_grid(const job::Polygon& outline, double angle, double step)
{
    const Eigen::AlignedBox2d box = geometry::bounding_box(outline);
    const Eigen::Array2d steps = (box.sizes() / step).array() + kStepTolerance;
    const Eigen::Array2d counts = steps.floor() + 1;
    if (!(counts.prod() <= kMaxGridPoints))
        throw core::InputError("a grid of " + core::to_text(counts.x()) + " by " + core::to_text(counts.y()) +
                               " points is too fine");

    const Eigen::Array2i size = counts.cast<int>();
    Eigen::MatrixXi index = Eigen::MatrixXi::Constant(size.x(), size.y(), -1);
    std::vector<Eigen::Vector2d> points;
    for (int j = 0; j < size.y(); ++j)
        for (int i = 0; i < size.x(); ++i) {
            const Eigen::Vector2d p = box.min() + step * Eigen::Vector2d(i, j);
            if (!job::contains(outline, p)) continue;
            index(i, j) = points.size();
            points.push_back(p);
        }
    std::vector<Eigen::Vector3i> triangles;
    for (int j = 0; j + 1 < size.y(); ++j)
        for (int i = 0; i + 1 < size.x(); ++i) {
            const Eigen::Matrix2i corner = index.block<2, 2>(i, j);
            if (corner.minCoeff() < 0) continue;
            triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
            triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
        }
    return {job::rotation_working_machine(angle).transpose() * job::columns_to_matrix(points),
            job::columns_to_matrix(triangles)};
}

job::Polygon touch_bounding_box(const Surface& surface, const std::string& source)
{
    if (surface.touches.cols() == 0) throw core::InputError(source, "has no touches to define the extent of a grid");
    const Eigen::AlignedBox2d box = geometry::bounding_box(surface.touches.topRows<2>());
    const Eigen::Vector2d min = box.min(), max = box.max();
    job::Polygon corners(2, 4);
    corners << min.x(), max.x(), max.x(), min.x(), min.y(), min.y(), max.y(), max.y();
    return corners;
}

mesh::Mesh mesh_of(const Surface& surface, const SurfaceGrid& grid)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, grid.xy.cols());
    mesh.vertices << grid.xy, heights(surface, grid.xy).transpose();
    std::vector<Eigen::Vector3i> defined;
    for (Eigen::Index i = 0; i < grid.triangles.cols(); ++i)
        if (mesh.vertices(2, grid.triangles.col(i)).allFinite()) defined.push_back(grid.triangles.col(i));
    mesh.triangles = job::columns_to_matrix(defined);
    return mesh;
}

} // namespace fettle::surface
