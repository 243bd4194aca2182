#include "belt/stock.h"

#include "compare/cloud_reference.h"
#include "compare/reference_mesh.h"
#include "mesh/mesh_index.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace fettle::belt {
namespace {

// Step behind a crossing before the ray is cast again, relative to the reach and the size of the coordinates: more than
// their rounding, less than any layer of metal.
constexpr double kRelativeRestartStep = 1e-9;
// Sine of the angle between line and facet below which a crossing is ignored as grazing.
constexpr double kMinIncidenceSine = 1e-3;
// Number of parallel lines tried around one without a crossing: one of them hits any corner of more than 30 degrees.
constexpr int kParallelLines = 12;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Crossings of a surfel's line with the stock's surface.
struct Crossings {
    double exit = kNan;  ///< nearest exit from the metal, signed distance along the normal, mm; NaN: none
    double entry = kNan; ///< nearest entry
    int exits = 0, entries = 0;
};

void keep_nearest(double& nearest, double distance)
{
    if (!(std::abs(nearest) <= std::abs(distance))) nearest = distance;
}

class MeshStock {
  public:
    explicit MeshStock(mesh::Mesh mesh)
        : reference_(compare::reference_mesh(std::move(mesh))), normals_(mesh::triangle_normals(reference_.mesh)),
          index_(reference_.mesh)
    {
    }

    /// At an edge that design and stock share, rounding may put the line outside the stock. Then parallel lines within
    /// the rounding are tried.
    Crossings along(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double reach) const
    {
        const Crossings found = crossings_on_line(point, normal, reach);
        if (found.exits > 0) return found;
        const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
        const double rounding = 4 * reference_.rounding_at(point);
        for (int k = 0; k < kParallelLines; ++k) {
            const double angle = 2 * std::numbers::pi * k / kParallelLines;
            const Eigen::Vector3d offset = rounding * (std::cos(angle) * u + std::sin(angle) * v);
            if (const Crossings other = crossings_on_line(point + offset, normal, reach); other.exits > 0) return other;
        }
        return found;
    }

  private:
    Crossings crossings_on_line(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double reach) const
    {
        Crossings found;
        const Eigen::Vector3d start = point - reach * normal;
        const double step = kRelativeRestartStep * (reach + point.cwiseAbs().maxCoeff());
        for (double from = 0; from <= 2 * reach;) {
            const std::optional<mesh::MeshIndex::Hit> hit = index_.cast(start + from * normal, normal);
            if (!hit || from + hit->distance > 2 * reach) break;
            const double distance = from + hit->distance - reach;
            const double cosine = normals_.col(hit->triangle).dot(normal);
            if (cosine > kMinIncidenceSine) {
                keep_nearest(found.exit, distance);
                ++found.exits;
            } else if (cosine < -kMinIncidenceSine) {
                keep_nearest(found.entry, distance);
                ++found.entries;
            }
            from += hit->distance + step;
        }
        return found;
    }

    compare::ReferenceMesh reference_;
    Eigen::Matrix3Xd normals_;
    mesh::MeshIndex index_;
};

/// A line leaves a scan at most once and never enters it.
Crossings crossings_along(const compare::CloudReference& scan, const Eigen::Vector3d& point,
                          const Eigen::Vector3d& normal, double reach)
{
    const std::optional<compare::CloudReference::Foot> foot = scan.intersect_line(point, normal);
    if (!foot || std::abs(foot->error) > reach) return {};
    return {.exit = -foot->error, .exits = 1};
}

template <typename Along>
std::vector<Crossings> all_crossings(const Surfels& surfels, const Along& along)
{
    std::vector<Crossings> found(surfels.size());
    tbb::parallel_for(Eigen::Index{0}, surfels.size(),
                      [&](Eigen::Index i) { found[i] = along(surfels.position.col(i), surfels.normal.col(i)); });
    return found;
}

/// Votes of each patch: surfels oriented as the nearest stock, minus those oriented oppositely.
std::vector<Eigen::Index> orientation_votes(const Surfels& surfels, const std::vector<Crossings>& crossings)
{
    std::vector<Eigen::Index> votes(surfels.size() > 0 ? surfels.patch.maxCoeff() + 1 : 0, 0);
    for (Eigen::Index i = 0; i < surfels.size(); ++i) {
        const Crossings& line = crossings[i];
        const double exit = std::abs(line.exit), entry = std::abs(line.entry);
        if (std::isnan(exit) && std::isnan(entry)) continue;
        votes[surfels.patch[i]] += !std::isnan(entry) && (std::isnan(exit) || entry < exit) ? -1 : 1;
    }
    return votes;
}

} // namespace

StockRays cast_rays_on_stock(Surfels& surfels, mesh::MeshOrCloud stock, double reach)
{
    std::vector<Crossings> crossings;
    if (mesh::Mesh* mesh = std::get_if<mesh::Mesh>(&stock)) {
        const MeshStock mesh_stock(std::move(*mesh));
        crossings = all_crossings(surfels, [&](const auto& p, const auto& n) { return mesh_stock.along(p, n, reach); });
    } else {
        const compare::CloudReference scan(std::get<cloud::Cloud>(stock));
        crossings =
            all_crossings(surfels, [&](const auto& p, const auto& n) { return crossings_along(scan, p, n, reach); });
    }
    StockRays rays;
    const std::vector<Eigen::Index> votes = orientation_votes(surfels, crossings);
    for (const Eigen::Index vote : votes) rays.flipped_patches += vote < 0;
    for (Eigen::Index i = 0; i < surfels.size(); ++i) {
        const Crossings& line = crossings[i];
        const bool is_flipped = votes[surfels.patch[i]] < 0;
        if (is_flipped) surfels.normal.col(i) *= -1;
        surfels.displacement[i] = is_flipped ? -line.entry : line.exit;
        rays.missed += std::isnan(surfels.displacement[i]);
        rays.multiple += (is_flipped ? line.entries : line.exits) > 1;
    }
    return rays;
}

} // namespace fettle::belt
