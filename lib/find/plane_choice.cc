#include "find/plane_choice.h"

#include "find/job_outlines.h"
#include "job/boundary.h"
#include "job/open_side.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::find {
namespace {

// fettle-margin raises a plane through B's corners by about this share of the probe's accuracy: .36 to .55 mostly
// (find.mk).
constexpr double kPlaneRise = 0.5;
// A free-form job leaves .5 to 3 tolerances on the mean where the metal is nearly plane, 1 in the median (find.mk
// chain, where a plane would cut no deeper than the tolerance): touches are added until the band of its margin meets
// the tolerance. However poor the probe, it leaves more than a plane would, by this share of the probe's accuracy.
constexpr double kFreeformShare = 1, kFreeformRise = 0.84;

// Corners that a plane is touched at, as sampling/planar.h.
constexpr std::size_t kMinPlaneCorners = 4;
// A plane through n touches around B has a standard deviation of √(3/n) of one touch's at B's rim, for its three terms.
// n is chosen so that this is a share of the tolerance. It is bounded by the number of touches that a free-form surface
// mostly has, and by the spacing of the scan's points.
constexpr double kRimShare = 0.1;
constexpr double kPlaneTerms = 3, kMaxPlaneCorners = 32;
constexpr double kMinCornerCells = 1;       // between corners
constexpr double kSigmasOfAccuracy = 2.576; // 99 % of touches are within it

/// The plane z = p0 + p1 x + p2 y that a job touches: through a surface at the corners of B that are on metal.
Eigen::Vector3d touched_plane(const FoundAnomaly& anomaly, const RingFit& surface)
{
    std::vector<Eigen::Index> corners = job::corners_on_metal(anomaly.boundary, anomaly.sampling);
    if (corners.size() < kMinPlaneCorners) corners = job::corners_on_metal(anomaly.boundary, {});
    const auto n = Eigen::Index(corners.size());
    Eigen::MatrixX3d A(n, 3);
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Vector2d corner = anomaly.boundary.col(corners[std::size_t(i)]);
        A.row(i) << 1, corner.x(), corner.y();
        z[i] = surface.z_at(corner.x(), corner.y());
    }
    return A.colPivHouseholderQr().solve(z);
}

} // namespace

Eigen::Matrix2Xd with_plane_corners(const FoundAnomaly& anomaly, const HeightMap& map, const RingFit& beneath,
                                    const job::Job& settings)
{
    const double sd = std::hypot(settings.probe.accuracy / kSigmasOfAccuracy, beneath.sd);
    const double count = kPlaneTerms * std::pow(sd / (kRimShare * settings.tolerance), 2);
    return with_more_corners(anomaly.boundary, anomaly.sampling, std::min(count, kMaxPlaneCorners),
                             kMinCornerCells * map.cell);
}

bool is_plane_better(const FoundAnomaly& anomaly, const HeightMap& map, const RingFit& beneath,
                     const job::Job& settings)
{
    const Eigen::Vector3d plane = touched_plane(anomaly, beneath);
    const double rise = kPlaneRise * settings.probe.accuracy;
    double sum = 0, count = 0;
    for (int y = 0; y < map.z.rows; ++y)
        for (int x = 0; x < map.z.cols; ++x) {
            const Eigen::Vector2d p = map.point_at(x, y);
            if (!job::contains(anomaly.boundary, p)) continue;
            const double cut = beneath.z_at(p.x(), p.y()) - plane[0] - plane.tail<2>().dot(p) - rise;
            if (cut > settings.tolerance) return false;
            sum += std::abs(cut);
            ++count;
        }
    return sum <= std::max(kFreeformShare * settings.tolerance, kFreeformRise * settings.probe.accuracy) * count;
}

} // namespace fettle::find
