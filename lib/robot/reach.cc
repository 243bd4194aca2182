#include "robot/reach.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "robot/arm.h"
#include "robot/externals.h"
#include "robot/solve_path.h"

#include <tbb/parallel_for.h>

#include <algorithm>
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
    explicit ReachTest(const Robot& robot) : arm_(robot)
    {
        for (const Vector3d& z : cube_directions()) {
            Eigen::Matrix3d R;
            R << z.unitOrthogonal(), z.cross(z.unitOrthogonal()), z;
            for (int turn = 0; turn < kToolTurns; ++turn)
                R_cell_tool_.emplace_back(
                    R * Eigen::AngleAxisd(2 * std::numbers::pi * turn / kToolTurns, Vector3d::UnitZ()));
        }
        for (const double track : track_positions(robot)) T_base_cell_.push_back(base_in_cell(robot, track).inverse());
        T_tool_flange_ = robot.T_flange_tool.inverse();
    }

    /// Fraction of the directions that are reached with the tip at a point.
    double share(const Vector3d& tip) const
    {
        const std::size_t directions = R_cell_tool_.size() / kToolTurns;
        int reached = 0;
        for (std::size_t d = 0; d < directions; ++d)
            if (reaches(tip, d)) ++reached;
        return double(reached) / double(directions);
    }

  private:
    bool reaches(const Vector3d& tip, std::size_t direction) const
    {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.translation() = tip;
        for (std::size_t turn = 0; turn < kToolTurns; ++turn) {
            pose.linear() = R_cell_tool_[direction * kToolTurns + turn];
            const Eigen::Isometry3d T_cell_flange = pose * T_tool_flange_;
            for (const Eigen::Isometry3d& T_base_cell : T_base_cell_)
                if (arm_.solve(T_base_cell * T_cell_flange, Joints::Zero(), Ranges::respect).size() > 0) return true;
        }
        return false;
    }

    Arm arm_;
    std::vector<Eigen::Matrix3d> R_cell_tool_; ///< kToolTurns for each direction
    std::vector<Eigen::Isometry3d> T_base_cell_;
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
    const ReachTest test(robot);
    constexpr Eigen::Index kCellsPerProgress = 1000;
    for (Eigen::Index first = 0; first < study.tips.cols(); first += kCellsPerProgress) {
        core::report_progress(progress, double(first) / double(study.tips.cols()));
        tbb::parallel_for(first, std::min(first + kCellsPerProgress, study.tips.cols()),
                          [&](Eigen::Index i) { study.reached_share[i] = test.share(study.tips.col(i)); });
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
    return json::Value()
        .set("cells", study.reached_share.size())
        .set("reached", (study.reached_share.array() > 0).cast<double>().mean())
        .set("reached_from_all_sides", (study.reached_share.array() == 1).cast<double>().mean())
        .set("mean_reach", study.reached_share.mean());
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
