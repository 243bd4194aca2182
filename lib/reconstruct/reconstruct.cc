#include "reconstruct/reconstruct.h"

#include "cloud/profiles.h"
#include "cloud/viewpoint.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "geometry/orientation.h"
#include "geometry/plane_normals.h"
#include "geometry/quantiles.h"
#include "geometry/spacing.h"
#include "reconstruct/ordered.h"
#include "reconstruct/stars.h"
#include "reconstruct/triangle_sheet.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fettle::reconstruct {
namespace {

constexpr double kMinSeenShare = 0.8;              // of the points that face a viewpoint: all do but for grazing ones
constexpr Eigen::Index kMaxUnordered = 20'000'000; // points: they take a quarter of an hour, and 9 GB
constexpr std::size_t kMaxLoopPoints = 200;        // of a hole that is filled: the time grows with the third power

/// Points, what is known of their outer side, and what they were in the file.
struct Points {
    Eigen::Matrix3Xd xyz;   ///< mm; of a grid with NaN
    Eigen::Matrix3Xd hints; ///< towards the outer side; zero: unknown
    OuterSide side{};
};

Points with_hints(const cloud::Cloud& cloud, const ReconstructRequest& request)
{
    Points points{cloud.xyz, Eigen::Matrix3Xd::Zero(3, cloud.size()), OuterSide::guessed};
    if (request.facing) {
        points.side = OuterSide::facing;
        points.hints.colwise() = *request.facing;
    } else if (request.from) {
        points.side = OuterSide::from;
        points.hints = (-points.xyz).colwise() + *request.from;
    } else if (cloud::has_normals(cloud)) {
        points.side = OuterSide::normals;
        points.hints = cloud::normals(cloud);
    } else if (cloud::has_viewpoint(cloud)) {
        points.side = OuterSide::viewpoint;
        points.hints = (-points.xyz).colwise() + cloud.view_origin;
    }
    for (auto hint : points.hints.colwise())
        if (!hint.allFinite()) hint.setZero();
    return points;
}

/// Share of the points with a hint whose normals point to its side.
double agreeing_share(const Eigen::Matrix3Xd& normals, const Eigen::Matrix3Xd& hints)
{
    const Eigen::ArrayXd towards = (normals.array() * hints.array()).colwise().sum();
    const auto known = static_cast<double>((towards != 0).count());
    return known > 0 ? static_cast<double>((towards > 0).count()) / known : 1;
}

/// Unit normals: those of the cloud, else of planes through the nearest points, turned to the outer side. A viewpoint
/// from which half of the surface would be seen from behind is none: that of scans that were merged, and then moved.
Eigen::Matrix3Xd outward_normals(Points& points)
{
    if (points.side == OuterSide::normals) { // the two sides of a thin wall would share neighbours
        Eigen::Matrix3Xd given = points.hints;
        for (auto normal : given.colwise()) normal = Eigen::Vector3d(normal).stableNormalized();
        return given;
    }
    geometry::PlaneNormals planes = geometry::plane_normals(points.xyz);
    Eigen::Matrix3Xd& normals = planes.normals;
    geometry::orient_consistently(normals, points.xyz, planes.links, points.hints);
    if (points.side == OuterSide::viewpoint && agreeing_share(normals, points.hints) < kMinSeenShare) {
        points.side = OuterSide::guessed;
        points.hints.setZero();
        geometry::orient_consistently(normals, points.xyz, planes.links, points.hints);
    }
    return std::move(planes.normals);
}

bool has_short_edges(const Eigen::Vector3i& corners, const Eigen::Matrix3Xd& xyz, double max_gap)
{
    for (int k = 0; k < 3; ++k)
        if ((xyz.col(corners[k]) - xyz.col(corners[(k + 1) % 3])).norm() > max_gap) return false;
    return true;
}

Eigen::Vector3d area_vector(const Eigen::Vector3i& corners, const Eigen::Matrix3Xd& xyz)
{
    const Eigen::Vector3d a = xyz.col(corners[0]);
    return (xyz.col(corners[1]) - a).cross(xyz.col(corners[2]) - a) / 2;
}

/// A hole whose points all lie within the gap is narrower than it. The line around a small piece of surface looks the
/// same, but its inside would face the other way.
bool is_narrow_hole(const std::vector<int>& loop, const Points& points, const Eigen::Matrix3Xd& normals, double max_gap)
{
    if (loop.size() < 3 || loop.size() > kMaxLoopPoints) return false;
    Eigen::Vector3d area = Eigen::Vector3d::Zero(), outer = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < loop.size(); ++i) {
        for (std::size_t k = i + 1; k < loop.size(); ++k)
            if ((points.xyz.col(loop[i]) - points.xyz.col(loop[k])).norm() > max_gap) return false;
        area += (points.xyz.col(loop[i]) - points.xyz.col(loop[0]))
                    .cross(points.xyz.col(loop[(i + 1) % loop.size()]) - points.xyz.col(loop[0]));
        outer += normals.col(loop[i]);
    }
    return area.dot(outer) > 0;
}

/// Fills narrow holes. @return  how many
Eigen::Index fill_holes(TriangleSheet& sheet, const Points& points, const Eigen::Matrix3Xd& normals, double max_gap)
{
    Eigen::Index filled = 0;
    for (const std::vector<int>& loop : sheet.open_loops()) {
        if (!is_narrow_hole(loop, points, normals, max_gap)) continue;
        ++filled;
        for (const Eigen::Vector3i& corners : triangulate_loop(loop, points.xyz)) sheet.add(corners);
    }
    return filled;
}

/// Triangles along the order of the points; those with long edges are left out.
void add_ordered(TriangleSheet& sheet, const OrderedTriangles& ordered, const Points& points, double max_gap)
{
    std::vector<Eigen::Vector3i> triangles;
    double towards_hints = 0, upward = 0;
    for (const Eigen::Vector3i& corners : ordered.triangles) {
        if (!has_short_edges(corners, points.xyz, max_gap)) continue;
        triangles.push_back(corners);
        const Eigen::Vector3d area = area_vector(corners, points.xyz);
        upward += area.z();
        for (const int corner : corners) towards_hints += area.dot(points.hints.col(corner).stableNormalized());
    }
    const bool is_inside_out = (points.side == OuterSide::guessed ? upward : towards_hints) < 0;
    for (Eigen::Vector3i corners : triangles) {
        if (is_inside_out) std::swap(corners[1], corners[2]);
        sheet.add(corners);
    }
}

/// Triangles of points in any order: the smallest first, so that a long one over an edge of two others is left out.
void add_scattered(TriangleSheet& sheet, const Points& points, const Eigen::Matrix3Xd& normals, double max_gap)
{
    std::vector<std::pair<double, Eigen::Vector3i>> by_length;
    for (const Eigen::Vector3i& corners : star_triangles(points.xyz, normals, max_gap)) {
        double longest = 0;
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, (points.xyz.col(corners[k]) - points.xyz.col(corners[(k + 1) % 3])).norm());
        if (longest <= max_gap) by_length.emplace_back(longest, corners);
    }
    std::ranges::stable_sort(by_length, {}, &std::pair<double, Eigen::Vector3i>::first);
    for (const auto& [length, corners] : by_length) sheet.add(corners);
}

/// Points that are finite, each place once.
cloud::Cloud distinct_points(const cloud::Cloud& cloud)
{
    std::vector<Eigen::Index> order;
    for (Eigen::Index i = 0; i < cloud.size(); ++i)
        if (cloud.xyz.col(i).allFinite()) order.push_back(i);
    const auto key = [&](Eigen::Index i) { return std::tuple(cloud.xyz(0, i), cloud.xyz(1, i), cloud.xyz(2, i)); };
    std::ranges::stable_sort(order, {}, key);
    const auto repeated = std::ranges::unique(order, {}, key);
    order.erase(repeated.begin(), repeated.end());
    std::ranges::sort(order);
    return cloud::select_points(cloud, order);
}

void finish(Reconstruction& result, const TriangleSheet& sheet, cloud::Cloud points)
{
    if (sheet.triangles().empty())
        throw core::InputError("no three points lie within the gap of " + core::to_short_text(result.max_gap) + " mm");
    result.borders = std::ssize(sheet.open_loops());
    mesh::CloudMesh all{std::move(points), Eigen::Matrix3Xi(3, std::ssize(sheet.triangles()))};
    std::vector<Eigen::Index> indices;
    for (const Eigen::Vector3i& corners : sheet.triangles()) {
        all.triangles.col(std::ssize(indices)) = corners;
        indices.push_back(std::ssize(indices));
    }
    const Eigen::Index finite = all.points.xyz.array().isFinite().colwise().all().count();
    result.mesh = mesh::select_triangles(all, indices);
    result.left_out = finite - result.mesh.points.size();
}

} // namespace

std::string to_string(OuterSide side)
{
    switch (side) {
    case OuterSide::normals:
        return "normals";
    case OuterSide::from:
        return "from";
    case OuterSide::facing:
        return "facing";
    case OuterSide::viewpoint:
        return "viewpoint";
    case OuterSide::guessed:
        return "guessed";
    }
    return {};
}

Reconstruction reconstruct(const cloud::Cloud& cloud, const ReconstructRequest& request)
{
    Reconstruction result;
    TriangleSheet sheet;
    const bool is_grid = cloud.width > 1 && cloud.size() > static_cast<Eigen::Index>(cloud.width);
    if (!is_grid && cloud.size() > kMaxUnordered)
        throw core::InputError(std::to_string(cloud.size()) + " points are more than can be joined, " +
                               std::to_string(kMaxUnordered / 1'000'000) +
                               " million: thin them first (fettle-clean --thin)");
    cloud::Cloud usable = is_grid ? cloud : distinct_points(cloud);
    if (usable.size() < 3)
        throw core::InputError(std::to_string(usable.size()) + " different points, three are needed");
    Points points = with_hints(usable, request);
    const std::optional<cloud::Profiles> profiles = is_grid ? std::nullopt : cloud::find_profiles(usable.xyz);
    result.order = is_grid ? "grid" : profiles ? "profiles" : "none";
    if (is_grid || profiles) {
        const OrderedTriangles ordered = is_grid ? grid_triangles(usable.xyz, static_cast<Eigen::Index>(usable.width))
                                                 : profile_triangles(usable.xyz, *profiles);
        result.max_gap = request.max_gap.value_or(kDefaultGapSpacings * ordered.spacing);
        add_ordered(sheet, ordered, points, result.max_gap);
    } else {
        result.max_gap = request.max_gap.value_or(kDefaultGapSpacings * geometry::point_spacing(usable.xyz));
        const Eigen::Matrix3Xd normals = outward_normals(points);
        add_scattered(sheet, points, normals, result.max_gap);
        result.filled_holes = fill_holes(sheet, points, normals, result.max_gap);
    }
    result.side = points.side;
    finish(result, sheet, std::move(usable));
    return result;
}

} // namespace fettle::reconstruct
