#include "compare/signed_distance.h"

#include "compare/cloud_reference.h"
#include "compare/pseudo_normals.h"
#include "core/constants.h"
#include "core/morton.h"
#include "mesh/mesh_index.h"

#include <Eigen/Geometry>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

namespace fettle::compare {

namespace {

/// Result for one point; NaN: undefined.
struct Measurement {
    double error = core::kNaN;
    Eigen::Vector3d normal = Eigen::Vector3d::Constant(core::kNaN);
    Eigen::Vector3d foot = Eigen::Vector3d::Constant(core::kNaN);
    double facet = core::kNaN;
    double sigma = core::kNaN;
};

class MeshReference {
  public:
    MeshReference(mesh::Mesh mesh, const DistanceOptions& options)
        : options_(options), parts_(std::make_unique<Parts>(reference_mesh(std::move(mesh), options.winding)))
    {
    }

    /// @param leaf  of the index, where the search starts; set to the leaf of the foot
    Measurement operator()(const Eigen::Vector3d& point, std::uint32_t& leaf) const
    {
        return options_.mode == DistanceMode::normal ? closest(point, leaf) : along_line(point);
    }

    const ReferenceRepair& repair() const { return parts_->mesh.repair; }

  private:
    Measurement closest(const Eigen::Vector3d& point, std::uint32_t& leaf) const
    {
        const std::optional<mesh::MeshIndex::Closest> found = parts_->index.closest(point, options_.max_distance, leaf);
        if (!found) return {};
        leaf = found->leaf;
        const Eigen::Vector3d offset = point - found->point;
        const auto [normal, beyond_border] = parts_->normals.side(*found, offset);
        if (beyond_border > parts_->mesh.rounding_at(found->point) || normal.isZero(0)) return {};
        return {std::copysign(offset.norm(), offset.dot(normal)), normal, found->point, facet_index(found->triangle)};
    }

    Measurement along_line(const Eigen::Vector3d& point) const
    {
        // The two rays start on opposite sides of the point, so that a facet through the point is not missed.
        const Eigen::Vector3d& up = options_.direction;
        const double start = parts_->mesh.rounding_at(point);
        Measurement nearest;
        bool nearest_faces = false;
        for (const double side : {1.0, -1.0}) {
            const auto hit = parts_->index.cast(point - side * start * up, side * up);
            if (!hit) continue;
            const double error = side * (start - hit->distance);
            const Eigen::Vector3d normal = parts_->normals.facet_normal(hit->triangle);
            const bool faces = normal.dot(up) > 0;
            const bool better = faces != nearest_faces ? faces : !(std::abs(nearest.error) <= std::abs(error));
            if (std::abs(error) > options_.max_distance || !better) continue;
            nearest = {error, normal, hit->point, facet_index(hit->triangle)};
            nearest_faces = faces;
        }
        return nearest;
    }

    double facet_index(Eigen::Index triangle) const { return parts_->mesh.original_index(triangle); }

    /// On the heap, as the later ones refer to the earlier.
    struct Parts {
        explicit Parts(ReferenceMesh reference) : mesh(std::move(reference)), index(mesh.mesh), normals(mesh, index) {}
        const ReferenceMesh mesh;
        const mesh::MeshIndex index;
        const PseudoNormals normals;
    };
    DistanceOptions options_;
    std::unique_ptr<const Parts> parts_;
};

class QuadraticCloud {
  public:
    QuadraticCloud(const cloud::Cloud& cloud, const DistanceOptions& options) : options_(options), surface_(cloud) {}

    Measurement operator()(const Eigen::Vector3d& point, std::uint32_t&) const
    {
        const std::optional<CloudReference::Foot> foot = options_.mode == DistanceMode::normal
                                                             ? surface_.closest(point)
                                                             : surface_.intersect_line(point, options_.direction);
        if (!foot || std::abs(foot->error) > options_.max_distance) return {};
        return {foot->error, foot->normal, foot->point, core::kNaN, foot->sigma};
    }

  private:
    DistanceOptions options_;
    CloudReference surface_;
};

// Points scanned line by line follow each other at about their spacing, which is 1/sqrt(N) of the extent. They count as
// spatially coherent while the mean step is at most this many spacings.
constexpr double kMaxCoherentSpacings = 4;

bool spatially_coherent(const Eigen::Matrix3Xd& points)
{
    Eigen::AlignedBox3d box;
    double path_length = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (!std::isfinite(points.col(i).sum())) continue;
        box.extend(points.col(i));
        if (i > 0) {
            const double step = (points.col(i) - points.col(i - 1)).norm();
            path_length += std::isfinite(step) ? step : 0;
        }
    }
    return !(path_length > kMaxCoherentSpacings * box.sizes().norm() * std::sqrt(points.cols()));
}

/// Order of the queries in which successive points are close to each other: the parts of the index that one visits are
/// in the cache for the next, and its foot is a good start.
std::vector<std::uint32_t> query_order(const Eigen::Matrix3Xd& points)
{
    if (!spatially_coherent(points)) return core::morton_order(points);
    std::vector<std::uint32_t> order(points.cols());
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

template <typename Shape>
ErrorMap measure(const Eigen::Matrix3Xd& points, const Shape& shape, bool mesh)
{
    const Eigen::Index count = points.cols();
    ErrorMap map{Eigen::VectorXd(count), Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count),
                 Eigen::VectorXd(mesh ? count : 0), Eigen::VectorXd(mesh ? 0 : count)};
    const std::vector<std::uint32_t> order = query_order(points);
    constexpr std::size_t kPointsPerTask = 512; // many tasks for each thread, each worth its overhead
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, order.size(), kPointsPerTask),
        [&](const tbb::blocked_range<std::size_t>& range) {
            std::uint32_t leaf = 0;
            for (std::size_t k = range.begin(); k < range.end(); ++k) {
                const Eigen::Index i = order[k];
                const Measurement m = points.col(i).allFinite() ? shape(points.col(i), leaf) : Measurement{};
                map.error[i] = m.error + 0.0; // no negative zeros in files
                map.normal.col(i) = m.normal.array() + 0.0;
                map.foot.col(i) = m.foot;
                if (mesh)
                    map.facet[i] = m.facet;
                else
                    map.reference_sigma[i] = m.sigma;
            }
        },
        tbb::simple_partitioner());
    return map;
}

} // namespace

struct Reference::State {
    std::variant<MeshReference, QuadraticCloud> shape;
    ReferenceRepair no_repair = {};
};

Reference::Reference(mesh::Mesh mesh, const DistanceOptions& options)
    : state_(new State{MeshReference(std::move(mesh), options)})
{
}
Reference::Reference(const cloud::Cloud& cloud, const DistanceOptions& options)
    : state_(new State{QuadraticCloud(cloud, options)})
{
}
Reference::Reference(Reference&&) noexcept = default;
Reference::~Reference() = default;

ErrorMap Reference::operator()(const Eigen::Matrix3Xd& points) const
{
    const bool mesh = std::holds_alternative<MeshReference>(state_->shape);
    return std::visit([&](const auto& shape) { return measure(points, shape, mesh); }, state_->shape);
}

const ReferenceRepair& Reference::repair() const
{
    const MeshReference* mesh = std::get_if<MeshReference>(&state_->shape);
    return mesh ? mesh->repair() : state_->no_repair;
}

ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const mesh::Mesh& reference, const DistanceOptions& options)
{
    return Reference(reference, options)(points);
}

ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const cloud::Cloud& reference, const DistanceOptions& options)
{
    return Reference(reference, options)(points);
}

} // namespace fettle::compare
