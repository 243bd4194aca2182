#include "compare/signed_distance.h"

#include "compare/cloud_reference.h"
#include "compare/pseudo_normals.h"
#include "mesh/raycast.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <optional>

namespace fettle {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Measured {
    double error = kNaN;
    Eigen::Vector3d normal = Eigen::Vector3d::Constant(kNaN);
    double sigma = kNaN;
};

/// What a mesh says about one point.
class MeshReference {
  public:
    MeshReference(const Mesh& mesh, const DistanceOptions& options)
        : options_(options), mesh_{mesh.vertices, distinct(mesh.triangles)}, index_(mesh_), normals_(mesh_)
    {
    }

    Measured operator()(const Eigen::Vector3d& point) const
    {
        return options_.mode == DistanceMode::normal ? closest(point) : along_line(point);
    }

  private:
    Measured closest(const Eigen::Vector3d& point) const
    {
        const std::optional<MeshIndex::Closest> foot = index_.closest(point, options_.max_distance);
        if (!foot) return {};
        const Eigen::Vector3d offset = point - foot->point;
        if (normals_.beyond_border(*foot, offset) > normals_.rounding(foot->point)) return {};
        const Eigen::Vector3d normal = normals_.normal(*foot);
        if (normal.isZero(0)) return {};
        return {std::copysign(offset.norm(), offset.dot(normal)), normal};
    }

    Measured along_line(const Eigen::Vector3d& point) const
    {
        // Either ray starts a little on the other side of the point, lest one that lies on the surface be missed.
        const Eigen::Vector3d& up = options_.direction;
        const double start = normals_.rounding(point);
        Measured nearest;
        bool nearest_faces = false;
        for (const double way : {1.0, -1.0}) {
            const auto hit = index_.cast(point - way * start * up, way * up);
            if (!hit) continue;
            const double error = way * (start - hit->distance);
            const Eigen::Vector3d normal = normals_.facet(hit->triangle);
            const bool faces = normal.dot(up) > 0;
            const bool better = faces != nearest_faces ? faces : !(std::abs(nearest.error) <= std::abs(error));
            if (std::abs(error) > options_.max_distance || !better) continue;
            nearest = {error, normal};
            nearest_faces = faces;
        }
        return nearest;
    }

    DistanceOptions options_;
    Mesh mesh_; ///< what stands twice has a border all the same
    MeshIndex index_;
    PseudoNormals normals_;
};

template <typename Reference>
ErrorMap measure(const Eigen::Matrix3Xd& points, const Reference& reference, bool with_sigma, const Progress& progress)
{
    ErrorMap map{Eigen::VectorXd(points.cols()), Eigen::Matrix3Xd(3, points.cols()),
                 Eigen::VectorXd(with_sigma ? points.cols() : 0)};
    constexpr Eigen::Index kShares = 50; // steps of the progress bar
    const Eigen::Index share = points.cols() / kShares + 1;
    for (Eigen::Index first = 0; first < points.cols(); first += share) {
        tbb::parallel_for(first, std::min(first + share, points.cols()), [&](Eigen::Index i) {
            const Measured m = points.col(i).allFinite() ? reference(points.col(i)) : Measured{};
            map.error[i] = m.error + 0.0; // no negative zeros in files
            map.normal.col(i) = m.normal.array() + 0.0;
            if (with_sigma) map.reference_sigma[i] = m.sigma;
        });
        tell(progress,
             static_cast<double>(std::min(first + share, points.cols())) / static_cast<double>(points.cols()));
    }
    return map;
}

} // namespace

ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const Mesh& reference, const DistanceOptions& options,
                         const Progress& progress)
{
    return measure(points, MeshReference(reference, options), false, progress);
}

ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const Cloud& reference, const DistanceOptions& options,
                         const Progress& progress)
{
    const CloudReference surface(reference);
    const auto at = [&](const Eigen::Vector3d& point) -> Measured {
        const std::optional<CloudReference::Foot> foot =
            options.mode == DistanceMode::normal ? surface.closest(point) : surface.along(point, options.direction);
        if (!foot || std::abs(foot->error) > options.max_distance) return {};
        return {foot->error, foot->normal, foot->sigma};
    };
    return measure(points, at, true, progress);
}

} // namespace fettle
