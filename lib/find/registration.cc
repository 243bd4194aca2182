#include "find/registration.h"

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

constexpr Eigen::Index kFieldPoints = 6000; // for the 168 coefficients of the slow field

constexpr Eigen::Index kRegistrationPoints = 20000; // as fettle-align takes of a mesh

align::OrientedPoints oriented_points_of(const mesh::CloudMesh& part)
{
    return part.is_mesh() ? align::oriented_points(mesh::Mesh{part.points.xyz, part.triangles})
                          : align::oriented_points(part.points);
}

// A bend makes the right pose fit worse than a wrong one, on which some of the part lies flat: by up to this factor of
// the mean square distances of the points that overlap.
constexpr double kMaxBentMisfitRatio = 9;

// Warp and anomalies leave this share of a part within this share of its diagonal of its reference.
constexpr double kMinSameShare = 0.75, kMaxSameDistance = 0.01;

double max_same_distance(const Eigen::Matrix3Xd& points)
{
    return kMaxSameDistance * geometry::bounding_box(points).diagonal().norm();
}

/// Mean square distance of a part from its reference after subtraction of the slow field between both, mm². The field
/// has no stiffness: a bent part may lie flatter in a wrong pose, and a stiff field would leave more of the bend in the
/// right one. Distances are bounded, by the same value for all poses: points without a counterpart distinguish the
/// poses of a nearly symmetric part, and anomalies, which are far off in all of them, do not dominate.
double misfit_beyond_slow_field(const Eigen::Matrix3Xd& points, const compare::Reference& reference)
{
    const SlowField field = fit_slow_field(points, reference, Stiffness::none);
    Eigen::Matrix3Xd unbent = points;
    for (auto point : unbent.colwise()) point -= field.at(point);
    const double bound = max_same_distance(points);
    double sum = 0;
    for (const double error : reference(unbent).error) {
        const double distance = std::isfinite(error) ? std::min(std::abs(error), bound) : bound;
        sum += distance * distance;
    }
    return sum / double(points.cols());
}

/// Selects another pose if it fits better after subtraction of the slow field: the second best of the search, or the
/// one nearest to the part's own frame, which is often that of its design.
void choose_bent_pose(align::Alignment& alignment, const align::OrientedPoints& points,
                      const align::AlignReference& target, const mesh::MeshOrCloud& reference)
{
    std::vector<align::IcpFit> others;
    if (alignment.second_best) others.push_back(*alignment.second_best);
    align::AlignOptions near;
    near.start = Eigen::Isometry3d::Identity();
    others.push_back(align::align(points, target, near).fit);
    std::erase_if(others, [&](const align::IcpFit& other) {
        return !other.converged || other.misfit > kMaxBentMisfitRatio * alignment.fit.misfit;
    });
    if (others.empty()) return;
    const auto distances = std::visit([](const auto& shape) { return compare::Reference(shape, {}); }, reference);
    const Eigen::Matrix3Xd some = points.xyz(Eigen::all, align::scattered_indices(points.xyz.cols(), kFieldPoints));
    const auto misfit = [&](const align::IcpFit& fit) {
        return misfit_beyond_slow_field(fit.T_reference_scan * some, distances);
    };
    double best = misfit(alignment.fit);
    for (const align::IcpFit& other : others)
        if (const double own = misfit(other); own < best) {
            best = own;
            alignment.second_best = std::exchange(alignment.fit, other);
        }
}

} // namespace

cloud::Cloud registration_points(const mesh::CloudMesh& part)
{
    const align::OrientedPoints points = oriented_points_of(part);
    const std::vector<Eigen::Index> chosen = align::scattered_indices(points.xyz.cols(), kRegistrationPoints);
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
    choose_bent_pose(alignment, points, *target, reference);
    return {alignment.fit.T_reference_scan, alignment.fit.converged, align::doubts(alignment, options.icp)};
}

namespace {

/// Compares the part without the slow field, which could bend any part onto any other.
/// @throws InputError if it is not that of the reference
void check_same_part(const Eigen::Matrix3Xd& points, const compare::Reference& reference)
{
    const double limit = max_same_distance(points);
    const Eigen::VectorXd errors = reference(points).error;
    const auto near = std::ranges::count_if(errors, [&](double error) { return std::abs(error) <= limit; });
    if (double(near) >= kMinSameShare * double(errors.size())) return;
    std::ostringstream text;
    text << "is not the part of the reference, or more than that: "
         << std::lround(100 - 100 * double(near) / double(errors.size())) << " % of its points lie more than "
         << std::setprecision(2) << limit << " mm off it";
    throw core::InputError(text.str());
}

// A departure beyond kChanceSds is reduced by what the slow field may explain within kFieldSds of its standard
// deviations.
constexpr double kChanceSds = 4, kFieldSds = 3;

} // namespace

SignedDistances signed_distances(const mesh::CloudMesh& part, const mesh::MeshOrCloud& reference,
                                 const Eigen::Isometry3d& T_reference_part)
{
    const auto distances = std::visit(
        [](const auto& shape) { return std::make_shared<compare::Reference>(shape, compare::DistanceOptions{}); },
        reference);
    const align::OrientedPoints samples =
        part.is_mesh() ? align::oriented_points(mesh::Mesh{part.points.xyz, part.triangles}, kFieldPoints)
                       : align::oriented_points(cloud::select_points(
                             part.points, align::scattered_indices(part.points.size(), kFieldPoints)));
    const Eigen::Matrix3Xd placed_samples = T_reference_part * samples.xyz;
    check_same_part(placed_samples, *distances);
    const SlowField field = fit_slow_field(placed_samples, *distances);

    return [distances, field, T_reference_part](const Eigen::Matrix3Xd& points) -> Eigen::VectorXd {
        const Eigen::Matrix3Xd placed = T_reference_part * points;
        Eigen::Matrix3Xd straightened = placed;
        tbb::parallel_for(Eigen::Index{0}, placed.cols(),
                          [&](Eigen::Index i) { straightened.col(i) -= field.at(placed.col(i)); });
        compare::ErrorMap map = (*distances)(straightened);
        tbb::parallel_for(Eigen::Index{0}, placed.cols(), [&](Eigen::Index i) {
            double& error = map.error[i];
            if (!(std::abs(error) > kChanceSds * field.sd)) return;
            const double limit = kFieldSds * field.sd_along(placed.col(i), map.normal.col(i));
            error -= std::clamp(error, -limit, limit);
        });
        return map.error;
    };
}

} // namespace fettle::find
