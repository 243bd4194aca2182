#include "align/align_run.h"

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "job/plausible.h"
#include "job/shape_warnings.h"
#include "mesh/shape_file.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace fettle::align {

namespace {

Eigen::Isometry3d to_isometry(const Eigen::Matrix4d& matrix, double mm)
{
    Eigen::Isometry3d motion(matrix);
    motion.translation() *= mm;
    return motion;
}

Eigen::Matrix4d to_matrix(const Eigen::Isometry3d& motion, double mm)
{
    Eigen::Matrix4d matrix = motion.matrix();
    matrix.topRightCorner<3, 1>() /= mm;
    return matrix;
}

double length_of(const Eigen::Matrix3Xd& points) { return geometry::finite_bounding_box(points).sizes().norm(); }

/// What reading the two files left out, and sizes that are hardly meant.
std::vector<std::string> file_warnings(const AlignRequest& request, const mesh::CloudMeshFile& scan,
                                       const mesh::ShapeFile& reference)
{
    // A scan in mm seems a thousand times as long as its reference in m, and over ten times as long as one in inches.
    constexpr double kMaxScanToReference = 10, kMinScanToReference = 1.0 / 500;
    const std::string scan_name = core::display_name(request.scan);
    std::vector<std::string> list = job::shape_warnings(scan, scan_name);
    const std::string reference_name = core::display_name(request.reference);
    const auto more = job::shape_warnings(reference, reference_name, reference.units);
    list.insert(list.end(), more.begin(), more.end());
    const double ratio = length_of(scan.part.points.xyz) / length_of(mesh::coordinates_of(reference.shape));
    if (ratio > kMaxScanToReference || ratio < kMinScanToReference)
        list.push_back(scan_name + ": is " + core::to_short_text(ratio) + " times as long as " + reference_name +
                       ": are the units of both right?");
    return list;
}

/// That a scan begins farther from the reference than both are long together: the nearest points say nothing there, and
/// steps towards them lead nowhere and take long. Empty: it begins nearer.
std::string distance_warning(const Eigen::Matrix3Xd& scan, const Eigen::Isometry3d& start,
                             const Eigen::Matrix3Xd& reference, const units::Units& units)
{
    const Eigen::AlignedBox3d there = geometry::finite_bounding_box(scan).transformed(start),
                              here = geometry::finite_bounding_box(reference);
    const double distance = there.exteriorDistance(here), limit = there.sizes().norm() + here.sizes().norm();
    if (!(distance > limit)) return "";
    const auto in_units = [&](double length) {
        return core::to_short_text(length / units.mm()) + " " + units::to_string(units.length);
    };
    return "begins " + in_units(distance) + " from the reference, which with it is " + in_units(limit) +
           " long: begin nearer, or let it be searched";
}

} // namespace

AlignRun align_files(const AlignRequest& request)
{
    const std::string scan_name = core::display_name(request.scan);
    mesh::CloudMeshFile scan = mesh::read_cloud_mesh(request.scan, mesh::resolve_file_units(request.scan_unit));
    const mesh::ShapeFile target =
        mesh::read_shape(request.reference, mesh::resolve_file_units(request.reference_unit));
    const double mm = scan.units.mm();
    AlignOptions options{std::nullopt, request.icp};
    AlignRun run;
    run.units = scan.units;
    run.transform = request.start.empty() ? Eigen::Matrix4d::Identity() : read_transform(request.start);
    const bool applies_start = options.icp.max_iterations == 0;
    if (!request.start.empty() || !request.search || applies_start) options.start = to_isometry(run.transform, mm);

    if (!applies_start) {
        job::require_no_stray_point(scan.part.points.xyz, scan.units, scan_name);
        job::require_no_stray_point(mesh::coordinates_of(target.shape), target.units,
                                    core::display_name(request.reference));
    }
    std::string too_far;
    if (options.start && !applies_start)
        too_far =
            distance_warning(scan.part.points.xyz, *options.start, mesh::coordinates_of(target.shape), scan.units);
    if (!too_far.empty()) options.icp.max_iterations = 1; // to say how it lies there
    const auto reference = core::with_error_prefix(core::display_name(request.reference), [&] {
        return std::visit([](const auto& shape) { return std::make_unique<AlignReference>(shape); }, target.shape);
    });
    const OrientedPoints points = scan.part.is_mesh()
                                      ? oriented_points(mesh::Mesh{scan.part.points.xyz, scan.part.triangles})
                                      : oriented_points(scan.part.points);
    // Beyond its own length no distance tells what overlaps: every point would, wherever the scan lies.
    const bool is_limit = request.max_distance && *request.max_distance * mm <= length_of(points.xyz);
    if (is_limit) options.icp.max_distance = *request.max_distance * mm;
    const Alignment alignment = core::with_error_prefix(scan_name, [&] { return align(points, *reference, options); });
    if (!applies_start) run.transform = to_matrix(alignment.fit.T_reference_scan, mm);
    run.converged = alignment.fit.converged || applies_start;

    cloud::Cloud sample; // the points that were aligned
    sample.xyz = points.xyz;
    run.report =
        to_json(alignment, run.transform, cloud::transformed(sample, run.transform, mm).xyz, *reference, run.units);
    if (!scan.part.is_mesh()) run.report.set("dropped", scan.part.points.size() - points.xyz.cols());
    run.warnings = file_warnings(request, scan, target);
    if (!too_far.empty()) run.warnings.push_back(scan_name + ": " + too_far);
    scan.part.points.frame = mesh::frame_of(target.shape);
    if (request.max_distance && !is_limit)
        run.warnings.push_back(scan_name + ": is " + core::to_short_text(length_of(points.xyz) / mm) +
                               " long, so that --max-distance " + core::to_short_text(*request.max_distance) +
                               " is no limit; --overlap 1 says that all of it lies on the reference");
    run.aligned = {cloud::transformed(std::move(scan.part.points), run.transform, mm), std::move(scan.part.triangles)};
    const std::vector<std::string> doubtful = doubts(alignment, options.icp);
    for (const std::string& doubt : doubtful) run.warnings.push_back(scan_name + ": " + doubt);
    run.sure = doubtful.empty();
    run.report.set("doubt", core::join(doubtful, "; "));
    return run;
}

} // namespace fettle::align
