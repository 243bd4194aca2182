#include "find/registration.h"

#include "align/icp.h"
#include "compare/signed_distance.h"
#include "core/constants.h"
#include "core/error.h"
#include "find/slow_field.h"
#include "find/view.h"

#include "geometry/bounding_box.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>
#include <utility>

namespace fettle::find {
namespace {

constexpr Eigen::Index kFieldPoints = 6000; // 168 coefficients follow from them

constexpr Eigen::Index kRegistrationPoints = 20000; // as fettle-align takes of a mesh

align::OrientedPoints oriented_points_of(const mesh::CloudMesh& part)
{
    return part.is_mesh() ? align::oriented_points(mesh::Mesh{part.points.xyz, part.triangles})
                          : align::oriented_points(part.points);
}

// A bend makes the right pose fit worse than a wrong one, on which some of the part lies flat: by up to this factor of
// the mean square distances of the points that overlap.
constexpr double kMaxBentMisfitRatio = 9;

/// How far a part is from its reference once the slow field between both is taken off, mm².
double misfit_beyond_slow_field(const Eigen::Matrix3Xd& points, const compare::Reference& reference)
{
    const SlowField field = fit_slow_field(points, reference);
    Eigen::Matrix3Xd unbent = points;
    for (auto point : unbent.colwise()) point -= field.at(point);
    std::vector<double> distances;
    for (const double error : reference(unbent).error)
        if (std::isfinite(error)) distances.push_back(std::abs(error));
    if (distances.empty()) return core::kInfinity;
    return align::estimate_overlap(Eigen::Map<Eigen::VectorXd>(distances.data(), Eigen::Index(distances.size())), 0)
        .misfit;
}

/// Exchanges the two best poses if the second one fits better, the slow field taken off.
void choose_bent_pose(align::Alignment& alignment, const align::OrientedPoints& points,
                      const mesh::MeshOrCloud& reference)
{
    if (!alignment.second_best || alignment.second_best->misfit > kMaxBentMisfitRatio * alignment.fit.misfit) return;
    const auto distances = std::visit([](const auto& shape) { return compare::Reference(shape, {}); }, reference);
    const Eigen::Matrix3Xd some = points.xyz(Eigen::all, scattered_indices(points.xyz.cols(), kFieldPoints));
    const auto misfit = [&](const align::IcpFit& fit) {
        return misfit_beyond_slow_field(fit.T_reference_scan * some, distances);
    };
    if (misfit(*alignment.second_best) < misfit(alignment.fit)) std::swap(alignment.fit, *alignment.second_best);
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
    align::Alignment alignment = align::align(points, *target, options);
    choose_bent_pose(alignment, points, reference);
    return {alignment.fit.T_reference_scan, alignment.fit.converged, align::doubts(alignment, options.icp)};
}

namespace {

// Warp and anomalies leave this share of a part within this share of its diagonal of its reference. A field could bend
// any part onto any other.
constexpr double kMinSameShare = 0.75, kMaxSameDistance = 0.01;

/// @throws InputError if the part is not that of the reference
void check_same_part(const Eigen::Matrix3Xd& points, const compare::Reference& reference)
{
    const double limit = kMaxSameDistance * geometry::bounding_box(points).diagonal().norm();
    const Eigen::VectorXd errors = reference(points).error;
    const auto near = std::ranges::count_if(errors, [&](double error) { return std::abs(error) <= limit; });
    if (double(near) >= kMinSameShare * double(errors.size())) return;
    std::ostringstream text;
    text << "is not the part of the reference, or more than that: "
         << std::lround(100 - 100 * double(near) / double(errors.size())) << " % of its points lie more than "
         << std::setprecision(2) << limit << " mm off it";
    throw core::InputError(text.str());
}

} // namespace

SignedDistances signed_distances(const mesh::CloudMesh& part, const mesh::MeshOrCloud& reference,
                                 const Eigen::Isometry3d& T_reference_part)
{
    const auto distances = std::visit(
        [](const auto& shape) { return std::make_shared<compare::Reference>(shape, compare::DistanceOptions{}); },
        reference);
    const align::OrientedPoints samples =
        part.is_mesh() ? align::oriented_points(mesh::Mesh{part.points.xyz, part.triangles}, kFieldPoints)
                       : align::oriented_points(
                             cloud::select_points(part.points, scattered_indices(part.points.size(), kFieldPoints)));
    const Eigen::Matrix3Xd placed_samples = T_reference_part * samples.xyz;
    check_same_part(placed_samples, *distances);
    const SlowField field = fit_slow_field(placed_samples, *distances);

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
