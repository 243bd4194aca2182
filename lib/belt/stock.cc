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

namespace fettle {
namespace {

// Behind a crossing the ray begins anew so much farther on, relative to the reach and to the size of coordinates: more
// than their rounding, less than any layer of metal.
constexpr double kStep = 1e-9;
// A facet that a line passes at less than this angle says nothing about where the metal ends along it.
constexpr double kGrazing = 1e-3;
// Lines tried around one that meets nothing: of so many, one leads into any corner of more than 30 degrees.
constexpr int kWays = 12;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Where a surfel's line goes through the stock's surface.
struct Crossings {
    double leaving = kNone;  ///< nearest place where it leaves the metal, along the normal, mm
    double entering = kNone; ///< where it enters it
    int leavings = 0, enterings = 0;
};

void note(double& nearest, double place)
{
    if (!(std::abs(nearest) <= std::abs(place))) nearest = place;
}

class MeshStock {
  public:
    explicit MeshStock(Mesh mesh)
        : reference_(reference_mesh(std::move(mesh))), normals_(triangle_normals(reference_.mesh)),
          index_(reference_.mesh)
    {
    }

    /// On an edge of a design that the stock shares, rounding may put the line beside the stock: then lines beside it
    /// by as much are tried.
    Crossings along(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double reach) const
    {
        const Crossings found = exactly_along(point, normal, reach);
        if (found.leavings > 0) return found;
        const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
        const double rounding = 4 * reference_.rounding(point);
        for (int k = 0; k < kWays; ++k) {
            const double way = 2 * std::numbers::pi * k / kWays;
            const Eigen::Vector3d beside = rounding * (std::cos(way) * u + std::sin(way) * v);
            if (const Crossings other = exactly_along(point + beside, normal, reach); other.leavings > 0) return other;
        }
        return found;
    }

  private:
    Crossings exactly_along(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double reach) const
    {
        Crossings found;
        const Eigen::Vector3d start = point - reach * normal;
        const double step = kStep * (reach + point.cwiseAbs().maxCoeff());
        for (double from = 0; from <= 2 * reach;) {
            const std::optional<MeshIndex::Hit> hit = index_.cast(start + from * normal, normal);
            if (!hit || from + hit->distance > 2 * reach) break;
            const double place = from + hit->distance - reach;
            const double facing = normals_.col(hit->triangle).dot(normal);
            if (facing > kGrazing) {
                note(found.leaving, place);
                ++found.leavings;
            } else if (facing < -kGrazing) {
                note(found.entering, place);
                ++found.enterings;
            }
            from += hit->distance + step;
        }
        return found;
    }

    ReferenceMesh reference_;
    Eigen::Matrix3Xd normals_;
    MeshIndex index_;
};

Crossings along(const CloudReference& scan, const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double reach)
{
    Crossings found;
    const std::optional<CloudReference::Foot> foot = scan.along(point, normal);
    if (!foot || std::abs(foot->error) > reach) return found;
    found.leaving = -foot->error;
    found.leavings = 1;
    return found;
}

template <typename Along>
std::vector<Crossings> all_crossings(const Surfels& surfels, const Along& along)
{
    std::vector<Crossings> found(static_cast<std::size_t>(surfels.size()));
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
        const auto k = static_cast<Eigen::Index>(i);
        found[i] = along(surfels.position.col(k), surfels.normal.col(k));
    });
    return found;
}

/// Of each patch: surfels that look as the stock next to them does, less those that look the other way.
std::vector<Eigen::Index> votes_of(const Surfels& surfels, const std::vector<Crossings>& crossings)
{
    std::vector<Eigen::Index> votes(static_cast<std::size_t>(surfels.size() > 0 ? surfels.patch.maxCoeff() + 1 : 0), 0);
    for (Eigen::Index i = 0; i < surfels.size(); ++i) {
        const Crossings& line = crossings[static_cast<std::size_t>(i)];
        const double out = std::abs(line.leaving), in = std::abs(line.entering);
        if (std::isnan(out) && std::isnan(in)) continue;
        votes[static_cast<std::size_t>(surfels.patch[i])] += !std::isnan(in) && (std::isnan(out) || in < out) ? -1 : 1;
    }
    return votes;
}

} // namespace

StockRays cast_on_stock(Surfels& surfels, MeshOrCloud stock, double reach)
{
    std::vector<Crossings> crossings;
    if (Mesh* mesh = std::get_if<Mesh>(&stock)) {
        const MeshStock metal(std::move(*mesh));
        crossings = all_crossings(surfels, [&](const auto& p, const auto& n) { return metal.along(p, n, reach); });
    } else {
        const CloudReference scan(std::get<Cloud>(stock));
        crossings = all_crossings(surfels, [&](const auto& p, const auto& n) { return along(scan, p, n, reach); });
    }
    StockRays rays;
    const std::vector<Eigen::Index> votes = votes_of(surfels, crossings);
    for (const Eigen::Index vote : votes) rays.turned_patches += vote < 0;
    for (Eigen::Index i = 0; i < surfels.size(); ++i) {
        const Crossings& line = crossings[static_cast<std::size_t>(i)];
        const bool turned = votes[static_cast<std::size_t>(surfels.patch[i])] < 0;
        if (turned) surfels.normal.col(i) *= -1;
        surfels.displacement[i] = turned ? -line.entering : line.leaving;
        rays.missed += std::isnan(surfels.displacement[i]);
        rays.several += (turned ? line.enterings : line.leavings) > 1;
    }
    return rays;
}

} // namespace fettle
