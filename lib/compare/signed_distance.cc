#include "compare/signed_distance.h"

#include "compare/cloud_reference.h"
#include "compare/pseudo_normals.h"
#include "core/constants.h"
#include "core/hilbert.h"
#include "mesh/mesh_index.h"

#include <Eigen/Geometry>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

namespace fettle {

namespace {

struct Measured {
    double error = kNaN;
    Eigen::Vector3d normal = Eigen::Vector3d::Constant(kNaN);
    Eigen::Vector3d foot = Eigen::Vector3d::Constant(kNaN);
    double facet = kNaN;
    double sigma = kNaN;
};

/// What a mesh says about one point.
class MeshReference {
  public:
    MeshReference(Mesh mesh, const DistanceOptions& options)
        : options_(options), mesh_(std::make_unique<ReferenceMesh>(reference_mesh(std::move(mesh), options.winding)))
    {
        tbb::parallel_invoke([&] { index_.emplace(mesh_->mesh); }, [&] { normals_.emplace(*mesh_); });
    }

    /// @param leaf  of the index, where to begin; set to where the foot was found
    Measured operator()(const Eigen::Vector3d& point, std::uint32_t& leaf) const
    {
        return options_.mode == DistanceMode::normal ? closest(point, leaf) : along_line(point);
    }

    const ReferenceRepair& repair() const { return mesh_->repair; }

  private:
    Measured closest(const Eigen::Vector3d& point, std::uint32_t& leaf) const
    {
        const std::optional<MeshIndex::Closest> found = index_->closest(point, options_.max_distance, leaf);
        if (!found) return {};
        leaf = found->leaf;
        const Eigen::Vector3d offset = point - found->point;
        if (normals_->beyond_border(*found, offset) > mesh_->rounding(found->point)) return {};
        const Eigen::Vector3d normal = normals_->normal(*found);
        if (normal.isZero(0)) return {};
        return {std::copysign(offset.norm(), offset.dot(normal)), normal, found->point, number(found->triangle)};
    }

    Measured along_line(const Eigen::Vector3d& point) const
    {
        // Either ray starts a little on the other side of the point, lest one that lies on the surface be missed.
        const Eigen::Vector3d& up = options_.direction;
        const double start = mesh_->rounding(point);
        Measured nearest;
        bool nearest_faces = false;
        for (const double way : {1.0, -1.0}) {
            const auto hit = index_->cast(point - way * start * up, way * up);
            if (!hit) continue;
            const double error = way * (start - hit->distance);
            const Eigen::Vector3d normal = normals_->facet(hit->triangle);
            const bool faces = normal.dot(up) > 0;
            const bool better = faces != nearest_faces ? faces : !(std::abs(nearest.error) <= std::abs(error));
            if (std::abs(error) > options_.max_distance || !better) continue;
            nearest = {error, normal, hit->point, number(hit->triangle)};
            nearest_faces = faces;
        }
        return nearest;
    }

    double number(Eigen::Index triangle) const { return static_cast<double>(mesh_->original(triangle)); }

    DistanceOptions options_;
    std::unique_ptr<const ReferenceMesh> mesh_; ///< stays where it is
    std::optional<MeshIndex> index_;            ///< made at the same time as the normals
    std::optional<PseudoNormals> normals_;
};

/// What a cloud says about one point.
class CloudMeasure {
  public:
    CloudMeasure(const Cloud& cloud, const DistanceOptions& options) : options_(options), surface_(cloud) {}

    Measured operator()(const Eigen::Vector3d& point, std::uint32_t&) const
    {
        const std::optional<CloudReference::Foot> foot =
            options_.mode == DistanceMode::normal ? surface_.closest(point) : surface_.along(point, options_.direction);
        if (!foot || std::abs(foot->error) > options_.max_distance) return {};
        return {foot->error, foot->normal, foot->point, kNaN, foot->sigma};
    }

  private:
    DistanceOptions options_;
    CloudReference surface_;
};

// Of a surface that is scanned line by line the steps from point to point are about its spacing, a share 1/sqrt(N) of
// its extent; so far above it they still are no leaps.
constexpr double kCoherent = 4;

bool coherent(const Eigen::Matrix3Xd& points)
{
    Eigen::AlignedBox3d box;
    double way = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (!std::isfinite(points.col(i).sum())) continue;
        box.extend(points.col(i));
        if (i > 0) {
            const double step = (points.col(i) - points.col(i - 1)).norm();
            way += std::isfinite(step) ? step : 0;
        }
    }
    return !(way > kCoherent * box.sizes().norm() * std::sqrt(static_cast<double>(points.cols())));
}

/// In what order to measure. Points that follow each other are near each other then: what one of them touched is in the
/// cache for the next, and its foot is a good guess.
std::vector<std::uint32_t> order_of(const Eigen::Matrix3Xd& points)
{
    const auto count = static_cast<std::size_t>(points.cols());
    if (!coherent(points))
        return hilbert_order(
            count, [&](std::size_t i) -> Eigen::Vector3d { return points.col(static_cast<Eigen::Index>(i)); });
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

template <typename At>
ErrorMap measure(const Eigen::Matrix3Xd& points, const At& at, bool mesh)
{
    const Eigen::Index count = points.cols();
    ErrorMap map{Eigen::VectorXd(count), Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count),
                 Eigen::VectorXd(mesh ? count : 0), Eigen::VectorXd(mesh ? 0 : count)};
    const std::vector<std::uint32_t> order = order_of(points);
    constexpr std::size_t kShare = 512; // points of one task: many to a thread, but worth its beginning
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, order.size(), kShare),
        [&](const tbb::blocked_range<std::size_t>& range) {
            std::uint32_t leaf = 0;
            for (std::size_t k = range.begin(); k < range.end(); ++k) {
                const Eigen::Index i = order[k];
                const Measured m = points.col(i).allFinite() ? at(points.col(i), leaf) : Measured{};
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
    std::variant<MeshReference, CloudMeasure> shape;
    ReferenceRepair none = {};
};

Reference::Reference(Mesh mesh, const DistanceOptions& options)
    : state_(new State{MeshReference(std::move(mesh), options)})
{
}
Reference::Reference(const Cloud& cloud, const DistanceOptions& options)
    : state_(new State{CloudMeasure(cloud, options)})
{
}
Reference::Reference(Reference&&) noexcept = default;
Reference::~Reference() = default;

ErrorMap Reference::operator()(const Eigen::Matrix3Xd& points) const
{
    const bool mesh = std::holds_alternative<MeshReference>(state_->shape);
    return std::visit([&](const auto& at) { return measure(points, at, mesh); }, state_->shape);
}

const ReferenceRepair& Reference::repair() const
{
    const MeshReference* mesh = std::get_if<MeshReference>(&state_->shape);
    return mesh ? mesh->repair() : state_->none;
}

ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const Mesh& reference, const DistanceOptions& options)
{
    return Reference(reference, options)(points);
}

ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const Cloud& reference, const DistanceOptions& options)
{
    return Reference(reference, options)(points);
}

} // namespace fettle
