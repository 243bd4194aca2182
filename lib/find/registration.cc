#include "find/registration.h"

#include "compare/signed_distance.h"
#include "find/slow_field.h"

#include <tbb/parallel_for.h>

#include <memory>

namespace fettle::find {
namespace {

constexpr Eigen::Index kFieldPoints = 6000; // 168 coefficients follow from them

constexpr Eigen::Index kRegistrationPoints = 20000; // as fettle-align takes of a mesh

align::OrientedPoints oriented_points_of(const mesh::CloudMesh& part)
{
    return part.is_mesh() ? align::oriented_points(mesh::Mesh{part.points.xyz, part.triangles})
                          : align::oriented_points(part.points);
}

} // namespace

cloud::Cloud registration_points(const mesh::CloudMesh& part)
{
    const align::OrientedPoints points = oriented_points_of(part);
    const std::vector<Eigen::Index> chosen = align::evenly_spaced_indices(points.xyz.cols(), kRegistrationPoints);
    cloud::Cloud result;
    result.xyz = points.xyz(Eigen::all, chosen);
    cloud::set_normals(result, points.normals(Eigen::all, chosen));
    return result;
}

Registration register_part(const mesh::CloudMesh& part, const mesh::MeshOrCloud& reference,
                           const std::optional<Eigen::Isometry3d>& stated)
{
    if (stated) return {*stated, true, {}};
    const auto target =
        std::visit([](const auto& shape) { return std::make_unique<align::AlignReference>(shape); }, reference);
    const align::OrientedPoints points = oriented_points_of(part);
    const align::AlignOptions options;
    const align::Alignment alignment = align::align(points, *target, options);
    return {alignment.fit.T_reference_scan, alignment.fit.converged, align::doubts(alignment, options.icp)};
}

SignedDistances signed_distances(const mesh::CloudMesh& part, const mesh::MeshOrCloud& reference,
                                 const Eigen::Isometry3d& T_reference_part)
{
    const auto distances = std::visit(
        [](const auto& shape) { return std::make_shared<compare::Reference>(shape, compare::DistanceOptions{}); },
        reference);
    const align::OrientedPoints samples =
        part.is_mesh() ? align::oriented_points(mesh::Mesh{part.points.xyz, part.triangles}, kFieldPoints)
                       : align::oriented_points(cloud::select_points(
                             part.points, align::evenly_spaced_indices(part.points.size(), kFieldPoints)));
    const SlowField field = fit_slow_field(T_reference_part * samples.xyz, *distances);
    return [distances, field, T_reference_part](const Eigen::Matrix3Xd& points) -> Eigen::VectorXd {
        Eigen::Matrix3Xd placed = T_reference_part * points;
        tbb::parallel_for(Eigen::Index{0}, placed.cols(), [&](Eigen::Index i) {
            const Eigen::Vector3d p = placed.col(i);
            placed.col(i) = p - field.at(p);
        });
        return (*distances)(placed).error;
    };
}

} // namespace fettle::find
