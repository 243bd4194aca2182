#include "merge/merge_run.h"

#include "clean/clean.h"
#include "cloud/viewpoint.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "geometry/quantiles.h"
#include "geometry/spacing.h"
#include "job/shape_warnings.h"
#include "merge/fusion.h"
#include "mesh/cloud_mesh.h"
#include "mesh/shape_file.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace fettle::merge {
namespace {

// Edge of the voxels in point spacings, of the scan with the median spacing. A voxel has about nine points of a scan,
// which determine the surface without smoothing the part's shape.
constexpr double kVoxelSpacings = 3;
// Radius of the search for points of another scan, in spacings of the coarsest scan: it contains at least one.
constexpr double kReachSpacings = 1.5;
// Fewer points do not distinguish a surface from its noise.
constexpr Eigen::Index kMinPoints = 100;
constexpr Eigen::Index kMaxPoints = 20'000'000; // of a scan: bounds the memory, 2 GB until it is merged

/// A scan as it was read.
struct RawScan {
    std::string name;
    Eigen::Matrix3Xd xyz; ///< mm
    Sides sides;
    double spacing = 0; ///< mm
};

/// Normals at the vertices of a mesh: area-weighted means of the triangles' normals.
Eigen::Matrix3Xd vertex_normals(const mesh::CloudMesh& part)
{
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, part.points.size());
    for (const auto& corners : part.triangles.colwise()) {
        const Eigen::Vector3d a = part.points.xyz.col(corners[0]);
        const Eigen::Vector3d b = part.points.xyz.col(corners[1]) - a, c = part.points.xyz.col(corners[2]) - a;
        for (const int corner : corners) normals.col(corner) += b.cross(c);
    }
    for (auto normal : normals.colwise()) normal = Eigen::Vector3d(normal).stableNormalized();
    return normals;
}

Eigen::Matrix3Xd finite_normals(const cloud::Cloud& cloud)
{
    Eigen::Matrix3Xd normals = cloud::normals(cloud);
    for (auto normal : normals.colwise())
        if (!normal.allFinite()) normal.setZero();
    return normals;
}

RawScan read_scan(const std::string& path, const MergeRequest& request, MergeRun& run, bool is_first)
{
    RawScan scan;
    scan.name = core::display_name(path);
    mesh::CloudMeshFile file = mesh::read_cloud_mesh(path, mesh::resolve_file_units(request.unit));
    if (is_first) run.units = file.units;
    for (const std::string& warning : job::shape_warnings(file, scan.name)) run.warnings.push_back(warning);
    if (file.part.points.size() > kMaxPoints)
        throw core::InputError(scan.name,
                               "has " + std::to_string(file.part.points.size()) + " points, more than the " +
                                   std::to_string(kMaxPoints / 1'000'000) +
                                   " million of a scan that can be merged: thin it first (fettle-clean --thin)");
    const mesh::CloudMesh part = core::with_error_prefix(
        scan.name, [&] { return clean::clean_part(std::move(file.part), clean::CleanRequest{}).part; });
    if (part.points.size() < kMinPoints)
        throw core::InputError(scan.name, "has " + std::to_string(part.points.size()) + " points; " +
                                              std::to_string(kMinPoints) + " are needed");
    if (part.is_mesh())
        scan.sides.normals = vertex_normals(part);
    else if (cloud::has_normals(part.points))
        scan.sides.normals = finite_normals(part.points);
    scan.sides.has_view = scan.sides.normals.cols() == 0 && cloud::has_viewpoint(part.points);
    scan.sides.view = part.points.view_origin;
    scan.xyz = part.points.xyz;
    scan.spacing = geometry::point_spacing(scan.xyz);
    if (!(scan.spacing > 0)) throw core::InputError(scan.name, "most of its points coincide");
    return scan;
}

bool shows_surface(const VoxelMeans& means)
{
    constexpr double kMinSurfaceShare = 0.5;
    const auto with_normal = (means.normals.colwise().squaredNorm().array() > 0).count();
    return static_cast<double>(with_normal) >= kMinSurfaceShare * static_cast<double>(means.xyz.cols());
}

/// Prepares a scan for registration. A scan that is only coarse beside the others is accepted, though it may fit none.
/// @throws InputError for a scan that shows no surface, such as profiles far apart
std::unique_ptr<const Scan> prepared(RawScan raw, double length)
{
    return core::with_error_prefix(raw.name, [&] {
        auto scan = std::make_unique<const Scan>(raw.name, std::move(raw.xyz), raw.sides, length);
        const double own_length = kVoxelSpacings * raw.spacing;
        if (!shows_surface(scan->means) &&
            !shows_surface(voxel_means(scan->xyz, VoxelGrid(scan->xyz, own_length), raw.sides, own_length)))
            throw core::InputError("shows no surface: its points lie on lines, or far apart");
        return scan;
    });
}

/// Registers the scans. If none fit, a warning from reading them may be the reason, such as a wrong unit.
/// @throws InputError as register_scans(), with the first of the warnings
Registration register_or_explain(const Scans& scans, const RegistrationRequest& request,
                                 const std::vector<std::string>& warnings)
try {
    return register_scans(scans, request);
} catch (const core::InputError& error) {
    if (warnings.empty()) throw;
    throw core::InputError(std::string(error.what()) + "; " + warnings.front());
}

} // namespace

MergeRun merge_files(const MergeRequest& request)
{
    if (request.scans.size() < 2) throw core::InputError("needs two scans or more, got 1");
    MergeRun run;
    std::vector<RawScan> raw;
    for (const std::string& path : request.scans) raw.push_back(read_scan(path, request, run, raw.empty()));
    const auto [finest, coarsest] = std::ranges::minmax(raw, {}, &RawScan::spacing);
    const double spacing = finest.spacing, reach = kReachSpacings * coarsest.spacing;
    std::vector<double> spacings;
    for (const RawScan& scan : raw) spacings.push_back(scan.spacing);
    const double length = kVoxelSpacings * geometry::median(spacings);
    RegistrationRequest registration_request{length, {}, request.progress};
    if (!request.poses.empty()) {
        std::vector<std::string> names;
        for (const RawScan& scan : raw) names.push_back(scan.name);
        registration_request.starts = read_poses(request.poses, names);
    }
    Scans scans;
    for (RawScan& scan : raw) scans.push_back(prepared(std::move(scan), registration_request.length));
    const Registration registration = register_or_explain(scans, registration_request, run.warnings);
    run.merged = merge_points(scans, registration, spacing, reach);
    run.converged = registration.converged;
    run.all_placed = std::ranges::all_of(registration.scans, [](const auto& pose) { return pose.has_value(); });
    for (const Refusal& refusal : registration.refused)
        if (!refusal.b) run.warnings.push_back(scans[refusal.a]->name + ": " + refusal.reason);
    run.report = to_json(registration, scans, run.units);
    run.report.set("points", run.merged.size()).set("spacing", spacing / run.units.mm());
    return run;
}

} // namespace fettle::merge
