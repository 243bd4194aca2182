#include "find/registration.h"

#include "compare/signed_distance.h"

#include <memory>

namespace fettle::find {

Registration register_part(const mesh::CloudMesh& part, const mesh::MeshOrCloud& reference,
                           const std::optional<Eigen::Isometry3d>& stated)
{
    if (stated) return {*stated, true, {}};
    const auto target =
        std::visit([](const auto& shape) { return std::make_unique<align::AlignReference>(shape); }, reference);
    const align::OrientedPoints points = part.is_mesh()
                                             ? align::oriented_points(mesh::Mesh{part.points.xyz, part.triangles})
                                             : align::oriented_points(part.points);
    const align::AlignOptions options;
    const align::Alignment alignment = align::align(points, *target, options);
    return {alignment.fit.T_reference_scan, alignment.fit.converged, align::doubts(alignment, options.icp)};
}

SignedDistances signed_distances(const mesh::MeshOrCloud& reference, const Eigen::Isometry3d& T_reference_part)
{
    const auto distances = std::visit(
        [](const auto& shape) { return std::make_shared<compare::Reference>(shape, compare::DistanceOptions{}); },
        reference);
    return [distances, T_reference_part](const Eigen::Matrix3Xd& points) -> Eigen::VectorXd {
        return (*distances)(T_reference_part * points).error;
    };
}

} // namespace fettle::find
