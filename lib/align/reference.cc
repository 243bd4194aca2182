#include "align/reference.h"

#include "cloud/neighbours.h"
#include "core/error.h"
#include "mesh/mesh_index.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <limits>
#include <optional>

namespace fettle {

namespace {

// A point of a cloud stands for a disc that reaches half way to its fourth neighbour: such discs cover most of a
// surface and overlap little, so that on a curved one none stands far above the next. Which of the discs is closest is
// decided among a few of the nearest points.
constexpr Eigen::Index kDiscReach = 4;
constexpr Eigen::Index kDiscs = 6;

Eigen::VectorXd disc_radii(const Eigen::Matrix3Xd& xyz, const Neighbours& neighbours)
{
    Eigen::VectorXd radii(xyz.cols());
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, xyz.cols()), [&](const auto& range) {
        for (Eigen::Index i = range.begin(); i < range.end(); ++i)
            radii[i] = (xyz.col(neighbours.nearest(xyz.col(i), 1 + kDiscReach).back()) - xyz.col(i)).norm() / 2;
    });
    return radii;
}

} // namespace

struct AlignReference::State {
    OrientedPoints points;
    std::optional<Neighbours> neighbours;
    Eigen::VectorXd radii; ///< of the discs
    Mesh mesh;
    Eigen::Matrix3Xd facet_normals;
    std::optional<MeshIndex> index;

    Foot closest_disc(const Eigen::Vector3d& point) const;
    Foot closest_on_mesh(const Eigen::Vector3d& point) const;
};

AlignReference::Foot AlignReference::State::closest_disc(const Eigen::Vector3d& point) const
{
    Foot closest;
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Index i : neighbours->nearest(point, kDiscs)) {
        const Eigen::Vector3d centre = points.xyz.col(i), normal = points.normals.col(i), offset = point - centre;
        const Eigen::Vector3d along = offset - offset.dot(normal) * normal;
        const double length = along.norm();
        const Eigen::Vector3d foot = centre + (length > radii[i] ? radii[i] / length : 1) * along;
        const double squared = normal.isZero(0) ? offset.squaredNorm() : (point - foot).squaredNorm();
        if (!(squared < least)) continue;
        least = squared;
        closest = {normal.isZero(0) ? centre : foot, normal};
    }
    return closest;
}

AlignReference::Foot AlignReference::State::closest_on_mesh(const Eigen::Vector3d& point) const
{
    const auto foot = index->closest(point, std::numeric_limits<double>::infinity());
    return {foot->point, facet_normals.col(foot->triangle)};
}

AlignReference::AlignReference(const Cloud& cloud)
{
    auto state = std::make_unique<State>();
    state->points = oriented_points(cloud);
    if (state->points.xyz.cols() < 3)
        throw InputError("needs at least 3 points, got " + std::to_string(state->points.xyz.cols()));
    state->neighbours.emplace(state->points.xyz);
    state->radii = disc_radii(state->points.xyz, *state->neighbours);
    state_ = std::move(state);
}

AlignReference::AlignReference(const Mesh& mesh)
{
    auto state = std::make_unique<State>();
    state->points = oriented_points(mesh);
    if (state->points.xyz.cols() == 0) throw InputError("none of its triangles has an area");
    state->mesh = {mesh.vertices, distinct(mesh.triangles)};
    state->facet_normals = triangle_normals(state->mesh);
    state->index.emplace(state->mesh);
    state_ = std::move(state);
}

AlignReference::~AlignReference() = default;

AlignReference::Foot AlignReference::closest(const Eigen::Vector3d& point) const
{
    return state_->index ? state_->closest_on_mesh(point) : state_->closest_disc(point);
}

const OrientedPoints& AlignReference::points() const { return state_->points; }

} // namespace fettle
