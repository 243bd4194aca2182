#include "align/reference.h"

#include "core/error.h"
#include "geometry/point_index.h"
#include "mesh/mesh_index.h"

#include <tbb/parallel_for.h>

#include <limits>
#include <optional>

namespace fettle::align {

namespace {

// Each point of a cloud represents a disc whose radius is half the distance to its fourth neighbour. Such discs cover
// most of a surface and overlap little, so that on a curved surface the step from one disc to the next stays small.
constexpr Eigen::Index kRadiusNeighbour = 4;
// The closest disc is searched among the discs of this many nearest points.
constexpr Eigen::Index kCandidateDiscs = 6;

Eigen::VectorXd disc_radii(const Eigen::Matrix3Xd& xyz, const geometry::PointIndex<3>& neighbours)
{
    Eigen::VectorXd radii(xyz.cols());
    tbb::parallel_for(Eigen::Index{0}, xyz.cols(), [&](Eigen::Index i) {
        radii[i] = (xyz.col(neighbours.nearest(xyz.col(i), 1 + kRadiusNeighbour).back()) - xyz.col(i)).norm() / 2;
    });
    return radii;
}

} // namespace

struct AlignReference::State {
    OrientedPoints points;
    std::optional<geometry::PointIndex<3>> neighbours;
    Eigen::VectorXd radii; ///< of the discs
    mesh::Mesh mesh;
    Eigen::Matrix3Xd facet_normals;
    std::optional<mesh::MeshIndex> index;

    Foot closest_disc(const Eigen::Vector3d& point) const;
    Foot closest_on_mesh(const Eigen::Vector3d& point) const;
};

AlignReference::Foot AlignReference::State::closest_disc(const Eigen::Vector3d& point) const
{
    Foot closest;
    double min_squared = std::numeric_limits<double>::infinity();
    for (const Eigen::Index i : neighbours->nearest(point, kCandidateDiscs)) {
        const Eigen::Vector3d centre = points.xyz.col(i), normal = points.normals.col(i), offset = point - centre;
        const Eigen::Vector3d tangential = offset - offset.dot(normal) * normal;
        const double length = tangential.norm();
        const Eigen::Vector3d foot = centre + (length > radii[i] ? radii[i] / length : 1) * tangential;
        const double squared = normal.isZero(0) ? offset.squaredNorm() : (point - foot).squaredNorm();
        if (!(squared < min_squared)) continue;
        min_squared = squared;
        closest = {normal.isZero(0) ? centre : foot, normal};
    }
    return closest;
}

AlignReference::Foot AlignReference::State::closest_on_mesh(const Eigen::Vector3d& point) const
{
    const auto foot = index->closest(point, std::numeric_limits<double>::infinity());
    return {foot->point, facet_normals.col(foot->triangle)};
}

AlignReference::AlignReference(const cloud::Cloud& cloud) : AlignReference(oriented_points(cloud)) {}

AlignReference::AlignReference(OrientedPoints points)
{
    if (points.xyz.cols() < 3)
        throw core::InputError("needs at least 3 points, got " + std::to_string(points.xyz.cols()));
    auto state = std::make_unique<State>();
    state->points = std::move(points);
    state->neighbours.emplace(state->points.xyz);
    state->radii = disc_radii(state->points.xyz, *state->neighbours);
    state_ = std::move(state);
}

AlignReference::AlignReference(const mesh::Mesh& mesh)
{
    auto state = std::make_unique<State>();
    state->points = oriented_points(mesh);
    if (state->points.xyz.cols() == 0) throw core::InputError("all triangles have zero area");
    state->mesh = {mesh.vertices, mesh::unique_triangles(mesh.triangles)};
    state->facet_normals = mesh::triangle_normals(state->mesh);
    state->index.emplace(state->mesh);
    state_ = std::move(state);
}

AlignReference::AlignReference(AlignReference&&) noexcept = default;
AlignReference::~AlignReference() = default;

std::optional<AlignReference> AlignReference::thinned(Eigen::Index count) const
{
    const OrientedPoints& all = state_->points;
    if (state_->index || all.xyz.cols() <= count) return std::nullopt;
    const std::vector<Eigen::Index> chosen = scattered_indices(all.xyz.cols(), count);
    return AlignReference(OrientedPoints{all.xyz(Eigen::all, chosen), all.normals(Eigen::all, chosen), all.outward});
}

AlignReference::Foot AlignReference::closest(const Eigen::Vector3d& point) const
{
    return state_->index ? state_->closest_on_mesh(point) : state_->closest_disc(point);
}

const OrientedPoints& AlignReference::points() const { return state_->points; }

} // namespace fettle::align
