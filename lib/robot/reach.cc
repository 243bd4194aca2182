#include "robot/reach.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "robot/arm.h"
#include "robot/cell.h"
#include "robot/externals.h"
#include "robot/solve_path.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

namespace fettle::robot {

namespace {

using Eigen::Vector3d;

// More would take hours and gigabytes.
constexpr double kMaxCells = 1e7;
constexpr double kTrackStep = 100; // mm: a tenth of an arm's reach
constexpr int kToolTurns = 8;      // about the tool's axis

// Directions to the faces, edges and corners of a cube, unit.
std::vector<Vector3d> cube_directions()
{
    std::vector<Vector3d> all;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) all.push_back(Vector3d(x, y, z).normalized());
    return all;
}

std::vector<double> track_positions(const Robot& robot)
{
    if (!robot.track) return {0};
    const JointRange& range = robot.track->range;
    const int steps = std::max(1, int(std::ceil((range.max - range.min) / kTrackStep)));
    std::vector<double> all;
    for (int k = 0; k <= steps; ++k) all.push_back(range.min + (range.max - range.min) * k / steps);
    return all;
}

class ReachTest {
  public:
    explicit ReachTest(const Robot& robot)
        : robot_(robot), cell_(robot, nullptr, {}), arm_(robot), tracks_(track_positions(robot))
    {
        for (const Vector3d& z : cube_directions()) {
            Eigen::Matrix3d R;
            R << z.unitOrthogonal(), z.cross(z.unitOrthogonal()), z;
            for (int turn = 0; turn < kToolTurns; ++turn)
                R_cell_tool_.emplace_back(
                    R * Eigen::AngleAxisd(2 * std::numbers::pi * turn / kToolTurns, Vector3d::UnitZ()));
        }
        for (const double track : tracks_) T_base_cell_.push_back(base_in_cell(robot, track).inverse());
        T_tool_flange_ = robot.T_flange_tool.inverse();
    }

    struct Result {
        double share; ///< fraction of the directions that are reached
        ReachLimit limit;
        std::uint8_t single_joints = 0; ///< ReachStudy::single_joints
    };
    Result at(const Vector3d& tip) const
    {
        const std::size_t directions = R_cell_tool_.size() / kToolTurns;
        int reached = 0;
        bool clear = false;
        for (std::size_t d = 0; d < directions; ++d)
            if (reaches(tip, d, clear)) ++reached;
        if (reached == 0) return find_limit(tip);
        return {double(reached) / double(directions), clear ? ReachLimit::none : ReachLimit::collision};
    }

  private:
    ArmSolutions solve(const Vector3d& tip, std::size_t turn, std::size_t track, Ranges ranges) const
    {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.translation() = tip;
        pose.linear() = R_cell_tool_[turn];
        return arm_.solve(T_base_cell_[track] * (pose * T_tool_flange_), Joints::Zero(), ranges);
    }

    /// @param clear  true: nobody asks any more; else it becomes true if nothing collides
    bool reaches(const Vector3d& tip, std::size_t direction, bool& clear) const
    {
        bool reached = false;
        for (std::size_t track = 0; track < tracks_.size() && !(reached && clear); ++track)
            for (std::size_t turn = direction * kToolTurns; turn < (direction + 1) * kToolTurns; ++turn) {
                const ArmSolutions solutions = solve(tip, turn, track, Ranges::respect);
                if (solutions.size() == 0) continue;
                reached = true;
                clear = clear || std::ranges::any_of(solutions, [&](const ArmSolution& solution) {
                            return is_clear(solution.joints, tracks_[track]);
                        });
                break;
            }
        return reached;
    }

    bool is_clear(const Joints& joints, double track) const
    {
        CellState state = cell_.place_bodies((CellJoints() << joints, track, 0).finished());
        return std::ranges::all_of(cell_.active_pairs(), [&](std::size_t pair) {
            return cell_.ball_clearance(state, pair) > 0 ||
                   cell_.measure_clearance(state, pair, 0) >= -cell_.options().tolerance;
        });
    }

    Result find_limit(const Vector3d& tip) const
    {
        Result result{0, ReachLimit::length};
        for (std::size_t turn = 0; turn < R_cell_tool_.size(); ++turn)
            for (std::size_t track = 0; track < tracks_.size(); ++track)
                for (const ArmSolution& solution : solve(tip, turn, track, Ranges::ignore)) {
                    result.limit = ReachLimit::joint_ranges;
                    unsigned out = 0;
                    for (int k = 0; k < 6; ++k)
                        if (!robot_.dh[k].range.contains(solution.joints[k])) out |= 1u << k;
                    if (std::has_single_bit(out)) result.single_joints |= static_cast<std::uint8_t>(out);
                }
        return result;
    }

    const Robot& robot_;
    Cell cell_;
    Arm arm_;
    std::vector<Eigen::Matrix3d> R_cell_tool_;   ///< kToolTurns for each direction
    std::vector<double> tracks_;                 ///< mm
    std::vector<Eigen::Isometry3d> T_base_cell_; ///< by position of the track
    Eigen::Isometry3d T_tool_flange_;
};

} // namespace

ReachStudy compute_reach(const Robot& robot, const Eigen::AlignedBox3d& box, double step,
                         const core::Progress& progress)
{
    // 1e-9 is subtracted before rounding up, so that 2000 / 100 gives 20 cells despite rounding errors.
    const Eigen::Array3d cells = (box.sizes().array() / step - 1e-9).ceil().max(1.0);
    if (!(cells.prod() <= kMaxCells))
        throw core::InputError("the box has " + core::to_short_text(cells.prod()) + " cells, at most " +
                               core::to_short_text(kMaxCells));
    const Eigen::Array3i count = cells.cast<int>();
    ReachStudy study;
    study.tips.resize(3, Eigen::Index(cells.prod()));
    for (Eigen::Index i = 0; i < study.tips.cols(); ++i) {
        const Eigen::Array3d at(i % count[0], i / count[0] % count[1], i / count[0] / count[1]);
        study.tips.col(i) = box.min() + (box.sizes().array() * (at + 0.5) / cells).matrix();
    }
    study.reached_share.resize(study.tips.cols());
    study.limits.resize(study.tips.cols());
    study.single_joints.resize(study.tips.cols());
    const ReachTest test(robot);
    constexpr Eigen::Index kCellsPerProgress = 1000;
    for (Eigen::Index first = 0; first < study.tips.cols(); first += kCellsPerProgress) {
        core::report_progress(progress, double(first) / double(study.tips.cols()));
        tbb::parallel_for(first, std::min(first + kCellsPerProgress, study.tips.cols()), [&](Eigen::Index i) {
            const ReachTest::Result found = test.at(study.tips.col(i));
            study.reached_share[i] = found.share;
            study.limits[i] = found.limit;
            study.single_joints[i] = found.single_joints;
        });
    }
    return study;
}

cloud::Cloud to_cloud(const ReachStudy& study)
{
    cloud::Cloud cloud;
    cloud.xyz = study.tips;
    cloud::set_field(cloud, "reach", study.reached_share);
    return cloud;
}

json::Value to_json(const ReachStudy& study)
{
    const auto count = static_cast<double>(study.limits.size());
    const auto share = [&](ReachLimit limit) { return double(std::ranges::count(study.limits, limit)) / count; };
    Eigen::VectorXd by_one_joint(6);
    for (int k = 0; k < 6; ++k)
        by_one_joint[k] =
            double(std::ranges::count_if(study.single_joints, [&](unsigned s) { return (s >> k & 1) != 0; })) / count;
    return json::Value()
        .set("cells", study.reached_share.size())
        .set("reached", (study.reached_share.array() > 0).cast<double>().mean())
        .set("reached_from_all_sides", (study.reached_share.array() == 1).cast<double>().mean())
        .set("mean_reach", study.reached_share.mean())
        .set("limited", json::Value()
                            .set("by_length", share(ReachLimit::length))
                            .set("by_joint_ranges", share(ReachLimit::joint_ranges))
                            .set("by_one_joint", by_one_joint)
                            .set("by_collisions", share(ReachLimit::collision)));
}

Eigen::AlignedBox3d parse_reach_box(const std::string& text, double mm)
{
    const Eigen::VectorXd corners = core::parse_number_list(text) * mm;
    if (corners.size() != 6 || !corners.allFinite() || (corners.tail<3>() - corners.head<3>()).minCoeff() < 0)
        throw core::InputError("--box",
                               "expected x,y,z of its minimum and of its maximum corner, got " + core::in_quotes(text));
    return {corners.head<3>(), corners.tail<3>()};
}

} // namespace fettle::robot
