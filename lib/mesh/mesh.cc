#include "mesh/mesh.h"

#include <Eigen/Geometry>

#include <limits>

namespace fettle {

Eigen::Matrix3Xd triangle_normals(const Mesh& mesh)
{
    Eigen::Matrix3Xd unit(3, mesh.triangles.cols());
    for (Eigen::Index t = 0; t < unit.cols(); ++t) {
        const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, t));
        const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, t));
        const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, t));
        unit.col(t) = (b - a).cross(c - a).stableNormalized(); // tiny triangles would underflow otherwise
    }
    return unit;
}

Eigen::Matrix<double, 3, 2> bounding_box(const Mesh& mesh)
{
    Eigen::Matrix<double, 3, 2> box;
    box.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (mesh.vertices.cols() > 0) box << mesh.vertices.rowwise().minCoeff(), mesh.vertices.rowwise().maxCoeff();
    return box;
}

} // namespace fettle
