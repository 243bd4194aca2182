#include "merge/merge_run.h"

#include "core/constants.h"
#include "core/error.h"
#include "json/units.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::merge {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

/// From mm and rad to the file's unit and rad.
Eigen::MatrixXd covariance_in(const align::TwistMatrix& covariance, double mm)
{
    align::Twist scale;
    scale << 1 / mm, 1 / mm, 1 / mm, 1, 1, 1;
    return scale.asDiagonal() * covariance * scale.asDiagonal();
}

json::Value scan_json(const Scan& scan, const std::optional<ScanPose>& pose, double mm)
{
    json::Value value;
    value.set("file", scan.name).set("points", scan.xyz.cols()).set("noise", scan.means.noise / mm);
    if (!pose) return value.set("matrix", core::kNaN);
    Eigen::Matrix4d matrix = pose->T_world_scan.matrix();
    matrix.topRightCorner<3, 1>() /= mm;
    const Eigen::Vector3d centre = pose->T_world_scan * scan.frame.centre / mm;
    const align::TwistMatrix& C = pose->covariance;
    value.set("matrix", Eigen::MatrixXd(matrix)).set("centre", Eigen::VectorXd(centre));
    if (C.allFinite()) // else the scans that it overlaps do not determine its pose
        value.set("covariance", covariance_in(C, mm));
    else
        value.set("covariance", core::kNaN);
    value.set("sd_shift", std::sqrt(C.topLeftCorner<3, 3>().trace()) / mm);
    return value.set("sd_turn_deg", std::sqrt(C.bottomRightCorner<3, 3>().trace()) * kDegreesPerRadian);
}

} // namespace

json::Value to_json(const Registration& registration, const Scans& scans, const units::Units& units)
{
    const double mm = units.mm();
    std::vector<json::Value> poses, pairs, refused;
    for (std::size_t i = 0; i < scans.size(); ++i) poses.push_back(scan_json(*scans[i], registration.scans[i], mm));
    for (const PairFit& pair : registration.pairs) {
        json::Value value;
        value.set("a", scans[pair.a]->name).set("b", scans[pair.b]->name);
        value.set("overlap", Eigen::VectorXd(Eigen::Vector2d(pair.overlap_a, pair.overlap_b)));
        pairs.push_back(value.set("rms", pair.rms / mm).set("misfit", pair.misfit));
    }
    for (const Refusal& refusal : registration.refused) {
        json::Value value;
        if (refusal.b)
            value.set("pair", std::vector<json::Value>{scans[refusal.a]->name, scans[*refusal.b]->name});
        else
            value.set("scan", scans[refusal.a]->name);
        refused.push_back(value.set("reason", refusal.reason));
    }
    json::Value report;
    report.set("kind", "poses").set("units", json::to_json(units.length));
    report.set("scans", poses).set("pairs", pairs).set("refused", refused);
    return report.set("scatter", registration.scatter).set("converged", registration.converged);
}

std::vector<Eigen::Isometry3d> read_poses(const std::string& path, const std::vector<std::string>& files)
{
    json::Reader report = json::Reader::open(path);
    report.expect_kind("poses");
    const double mm = units::Units{json::read_length_unit(report), {}}.mm();
    std::vector<json::Reader> scans = report.objects("scans");
    std::vector<Eigen::Isometry3d> poses;
    for (const std::string& file : files) {
        const auto found = std::ranges::find_if(scans, [&](json::Reader& scan) { return scan.text("file") == file; });
        if (found == scans.end()) report.refuse("scans", "none of them is " + file);
        if (found->is_null_or_missing("matrix")) found->refuse("matrix", file + " has no pose");
        const Eigen::MatrixXd matrix = found->matrix("matrix", 4);
        if (matrix.rows() != 4) found->refuse("matrix", "expected 4 rows, got " + std::to_string(matrix.rows()));
        constexpr double kMaxError = 1e-6; // of a rotation written with a few digits less than all
        const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
        if (!(R * R.transpose()).isIdentity(kMaxError) || !(R.determinant() > 0) ||
            matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
            found->refuse("matrix", "is not a rotation and a translation over 0 0 0 1");
        Eigen::Isometry3d pose(Eigen::Matrix4d{matrix});
        pose.translation() *= mm;
        poses.push_back(align::orthonormalized(pose));
    }
    const Eigen::Isometry3d to_first = poses.front().inverse();
    for (Eigen::Isometry3d& pose : poses) pose = to_first * pose;
    return poses;
}

} // namespace fettle::merge
