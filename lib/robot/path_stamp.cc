#include "robot/path_stamp.h"

#include "cloud/poses.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/fixed_text.h"
#include "core/text.h"
#include "robot/collision_report.h"
#include "robot/path_cloud.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace fettle::robot {

namespace {

// After the decimal point, rad or mm: what a change of units rounds does not count.
constexpr int kJointDigits = 8;
// What the motion from step to step may hide is a quarter of the resolution, or less.
constexpr double kStepsPerResolution = 4;
constexpr std::size_t kPartDigits = 16; // of a digest: enough to tell parts apart by eye
constexpr int kClearanceDigits = 4;     // after the decimal point, mm: a tenth of a micrometre

template <typename Values>
void add_bytes(core::Digest& digest, const Values& values)
{
    digest.add({reinterpret_cast<const char*>(values.data()), sizeof(values(0)) * std::size_t(values.size())});
}

double minimum(const std::vector<CellClearance>& list)
{
    const Eigen::Index at = min_clearance_index(list);
    return at < 0 ? core::kNaN : list[at].clearance;
}

// Rounded down, so that a stamp never promises more than was measured.
std::string clearance_text(double mm)
{
    const double unit = std::pow(10.0, kClearanceDigits);
    return core::to_text(std::floor(mm * unit) / unit);
}

} // namespace

std::string stamp_digest(const Robot& robot, const cloud::Cloud& path, double mm, std::string_view said)
{
    core::Digest digest;
    digest.add(robot.digest);
    add_bytes(digest, Eigen::Matrix3Xf((path.xyz / mm).cast<float>()));
    for (const char* name : {"qw", "qx", "qy", "qz"}) add_bytes(digest, cloud::field(path, name));
    const CellJointsPath joints = path_joints(path, robot);
    for (const double value : joints.reshaped()) digest.add(core::to_fixed_text(value, kJointDigits) + ' ');
    add_bytes(digest, cloud::read_strokes(path));
    for (const cloud::Motion motion : cloud::read_motions(path)) digest.add(std::to_string(static_cast<int>(motion)));
    return digest.text(said);
}

std::string part_digest(const mesh::Mesh& part)
{
    core::Digest digest;
    add_bytes(digest, part.vertices);
    add_bytes(digest, part.triangles);
    return digest.text().substr(0, kPartDigits);
}

std::optional<double> min_travel_clearance(const Robot& robot, const Workpiece* workpiece, const cloud::Cloud& path,
                                           const CollisionStudy& study)
{
    const std::vector<cloud::Motion> motions = cloud::read_motions(path);
    const CellJointsPath& joints = study.solved.path.joints;
    const double step = study.request.collision.resolution / kStepsPerResolution;
    std::vector<CellJoints> dense;
    for (Eigen::Index i = 0; i < joints.cols(); ++i) {
        if (motions[i] != cloud::Motion::travel) continue;
        const double length =
            i == 0 ? 0 : (study.solved.poses[i].translation() - study.solved.poses[i - 1].translation()).norm();
        const double steps = std::isfinite(length) ? std::max(1.0, std::ceil(length / step)) : 1;
        // A column without joints parts the motions of a travel from what was before it.
        if (i > 0 && motions[i - 1] != cloud::Motion::travel) {
            dense.push_back(CellJoints::Constant(core::kNaN));
            dense.push_back(joints.col(i - 1));
        }
        for (double k = 1; k <= steps; ++k)
            dense.push_back(i == 0 ? CellJoints(joints.col(0))
                                   : CellJoints(joints.col(i - 1) + k / steps * (joints.col(i) - joints.col(i - 1))));
    }
    if (dense.empty()) return std::nullopt;
    CellJointsPath all(8, static_cast<Eigen::Index>(dense.size()));
    for (std::size_t k = 0; k < dense.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = dense[k];
    const CheckedPath checked = check_path(robot, workpiece, all, study.request.collision);
    double min = minimum(checked.at_poses);
    if (all.cols() > 1) min = std::fmin(min, minimum(checked.between_poses));
    return min;
}

std::string stamp_obstacle(const Robot& robot, const CollisionStudy& study, bool has_workpiece)
{
    if (!has_workpiece) return "there was no --workpiece";
    const auto comes_near = [&](const Body& body) {
        return robot.holds_workpiece ? body.link == link::kCell : body.link == 6 || body.link == link::kTool;
    };
    if (std::ranges::none_of(robot.bodies, comes_near))
        return robot.holds_workpiece ? "the cell has no body that the workpiece could touch"
                                     : "the robot has no body at its flange or tool that could touch the workpiece";
    if (study.model) return "--method is not exact";
    const CellJointsPath& joints = study.solved.path.joints;
    const cloud::PosePath& poses = study.solved.poses;
    const double max = study.request.collision.resolution;
    for (Eigen::Index i = 1; i < joints.cols(); ++i) {
        const CellJointsPath middle = (joints.col(i - 1) + joints.col(i)) / 2;
        const Eigen::Vector3d tip = forward_kinematics(robot, middle)[0].translation();
        const double off = (tip - (poses[i - 1].translation() + poses[i].translation()) / 2).norm();
        if (off > max)
            return "pose " + std::to_string(i) + ": half-way to it the joints bring the tip " +
                   core::to_short_text(off) + " mm off the straight line of a program, at most " +
                   core::to_short_text(max) + "; points closer together (fettle-path --spacing) stay on it";
    }
    return "";
}

std::string stamp_text(const Robot& robot, const cloud::Cloud& path, const CheckedPath& checked,
                       const std::optional<double>& strokes, const mesh::Mesh& part, double mm)
{
    std::string said = "clearance " + clearance_text(minimum(checked.at_poses)) + " between " +
                       clearance_text(path.size() > 1 ? minimum(checked.between_poses) : minimum(checked.at_poses));
    if (strokes) said += " strokes " + clearance_text(*strokes);
    said += " part " + part_digest(part);
    return "checked " + stamp_digest(robot, path, mm, said) + " " + said;
}

PathStamp read_stamp(const Robot& robot, const cloud::Cloud& path, double mm)
{
    const std::string how = "fettle-collide with a --workpiece checks it";
    if (!path.comment.starts_with("checked ")) throw core::InputError("the path is not checked for collisions: " + how);
    std::istringstream words(path.comment);
    PathStamp stamp;
    std::string checked, said, word, value;
    words >> checked >> stamp.digest >> std::ws;
    std::getline(words, said);
    std::optional<double> at, on_way;
    for (std::istringstream pairs(said); pairs >> word >> value;) {
        if (word == "clearance") at = core::parse_number(value);
        if (word == "between") on_way = core::parse_number(value);
        if (word == "strokes") stamp.strokes = core::parse_number(value);
        if (word == "part") stamp.part = value;
    }
    if (!at || !on_way || stamp.part.empty())
        throw core::InputError("'" + path.comment + "' is no stamp of a checked path: " + how);
    stamp.clearance = *at;
    stamp.between = *on_way;
    if (stamp.digest != stamp_digest(robot, path, mm, said))
        throw core::InputError("the path or the robot has changed since it was checked for collisions: " + how);
    return stamp;
}

} // namespace fettle::robot
