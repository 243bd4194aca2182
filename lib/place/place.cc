#include "place/place.h"

#include "align/rigid.h"
#include "cloud/viewpoint.h"
#include "core/decompositions.h"
#include "core/direction.h"
#include "core/error.h"
#include "geometry/bounding_box.h"
#include "job/frame.h"

#include <utility>

namespace fettle::place {
namespace {

// So many points tell where a face lies as well as millions do.
constexpr Eigen::Index kMaxSearchedPoints = 10000;

// Share of the part's diagonal within which points belong to a face: the scatter of scans, and below the steps of
// parts.
constexpr double kThresholdDiagonals = 1.0 / 500;

// Picked points are on a line if they scatter across it by less than this share of their scatter along it.
constexpr double kMinPickedAspect = 1e-6;

align::OrientedPoints searched_points(const mesh::CloudMesh& part)
{
    if (part.is_mesh()) return align::oriented_points({part.points.xyz, part.triangles}, kMaxSearchedPoints);
    return align::oriented_points(
        cloud::select_points(part.points, align::scattered_indices(part.points.size(), kMaxSearchedPoints)));
}

/// The plane through picked points; it faces where the part does, next to them.
FoundRegion picked_region(const Eigen::Matrix3Xd& picked, const align::OrientedPoints& points)
{
    FoundRegion region;
    region.centre = picked.rowwise().mean();
    const Eigen::Matrix3Xd about = picked.colwise() - region.centre;
    const auto scatter = core::symmetric_eigen<3>(about * about.transpose());
    if (picked.cols() < 3 || scatter.values[1] <= kMinPickedAspect * scatter.values[2])
        throw core::InputError("a plane needs three picked points that are not on a line");
    region.up = scatter.vectors.col(0);
    Eigen::Vector3d outward = Eigen::Vector3d::Zero();
    for (const auto& pick : picked.colwise()) {
        Eigen::Index nearest = 0;
        (points.xyz.colwise() - pick).colwise().squaredNorm().minCoeff(&nearest);
        outward += points.normals.col(nearest);
    }
    if (outward.dot(region.up) < 0) region.up = -region.up;
    return region;
}

Eigen::Isometry3d to_mm(const Eigen::Matrix4d& matrix, double mm)
{
    Eigen::Isometry3d motion(matrix);
    motion.translation() *= mm;
    return motion;
}

} // namespace

PlacedPart place_part(mesh::CloudMesh part, const PlaceRequest& request, double mm)
{
    Eigen::Isometry3d motion = request.matrix ? to_mm(*request.matrix, mm) : Eigen::Isometry3d::Identity();
    if (request.into && job::must_be_moved(part.points.frame, *request.into))
        motion = request.into->T_part_job->inverse();
    for (const Turn& turn : request.turns)
        motion = Eigen::AngleAxisd(turn.angle, Eigen::Vector3d::Unit(turn.axis)) * motion;
    const Eigen::AlignedBox3d box = geometry::finite_bounding_box(part.points.xyz);
    PlacedPart placed;
    if (request.picked) placed.region = picked_region(*request.picked, searched_points(part));
    if (request.up)
        placed.region = find_region(searched_points(part), *request.up,
                                    request.threshold.value_or(kThresholdDiagonals * box.diagonal().norm()));
    placed.is_side_guessed =
        placed.region && !part.is_mesh() && !cloud::has_normals(part.points) && !cloud::has_viewpoint(part.points);
    if (placed.region)
        motion = core::rotation_between(motion.linear() * placed.region->up, Eigen::Vector3d::UnitZ()) * motion;
    motion = align::orthonormalized(motion);
    if (request.is_centred) {
        cloud::Cloud moved;
        moved.xyz = (motion * part.points.xyz.colwise().homogeneous()).topRows<3>();
        const Eigen::Vector3d middle = placed.region
                                           ? Eigen::Vector3d(motion * placed.region->centre)
                                           : Eigen::Vector3d(geometry::finite_bounding_box(moved.xyz).center());
        motion = Eigen::Translation3d(-middle) * motion;
    }
    placed.transform = motion.matrix();
    placed.transform.topRightCorner<3, 1>() /= mm;
    placed.part.triangles = std::move(part.triangles);
    placed.part.points = cloud::transformed(std::move(part.points), placed.transform, mm);
    if (request.into)
        placed.part.points.frame = request.into->frame();
    else if (!motion.matrix().isIdentity(0))
        placed.part.points.frame = cloud::Frame::part;
    return placed;
}

Eigen::Matrix4d inverse_of(const Eigen::Matrix4d& transform) { return Eigen::Isometry3d(transform).inverse().matrix(); }

} // namespace fettle::place
