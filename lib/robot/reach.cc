#include "robot/reach.h"

#include "core/error.h"
#include "core/text.h"
#include "robot/arm.h"
#include "robot/externals.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fettle {

namespace {

using Eigen::Vector3d;

// A study of more would take hours and gigabytes.
constexpr double kMostCells = 1e7;
constexpr double kTrackStep = 100; // mm: a tenth of an arm's reach
constexpr int kTurns = 8;          // about the tool's axis

std::vector<Vector3d> cube_directions()
{
    std::vector<Vector3d> all;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) all.push_back(Vector3d(x, y, z).normalized());
    return all;
}

std::vector<double> places(const Robot& robot)
{
    if (!robot.track) return {0};
    const JointRange& range = robot.track->range;
    const int steps = std::max(1, static_cast<int>(std::ceil((range.most - range.least) / kTrackStep)));
    std::vector<double> all;
    for (int k = 0; k <= steps; ++k) all.push_back(range.least + (range.most - range.least) * k / steps);
    return all;
}

class Study {
  public:
    explicit Study(const Robot& robot) : arm_(robot)
    {
        for (const Vector3d& z : cube_directions()) {
            Eigen::Matrix3d R;
            R << z.unitOrthogonal(), z.cross(z.unitOrthogonal()), z;
            for (int turn = 0; turn < kTurns; ++turn)
                turned_.emplace_back(R * Eigen::AngleAxisd(2 * std::numbers::pi * turn / kTurns, Vector3d::UnitZ()));
        }
        for (const double place : places(robot)) T_base_cell_.push_back(cell_base(robot, place).inverse());
        T_tool_flange_ = robot.T_flange_tool.inverse();
    }

    double share(const Vector3d& tip) const
    {
        const std::size_t directions = turned_.size() / kTurns;
        int reached = 0;
        for (std::size_t d = 0; d < directions; ++d)
            if (reaches(tip, d)) ++reached;
        return static_cast<double>(reached) / static_cast<double>(directions);
    }

  private:
    bool reaches(const Vector3d& tip, std::size_t direction) const
    {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.translation() = tip;
        for (std::size_t turn = 0; turn < kTurns; ++turn) {
            pose.linear() = turned_[direction * kTurns + turn];
            const Eigen::Isometry3d flange = pose * T_tool_flange_;
            for (const Eigen::Isometry3d& T_base_cell : T_base_cell_)
                if (arm_.solve(T_base_cell * flange, Joints::Zero(), Ranges::respect).size() > 0) return true;
        }
        return false;
    }

    Arm arm_;
    std::vector<Eigen::Matrix3d> turned_; ///< of the tool, kTurns for each direction
    std::vector<Eigen::Isometry3d> T_base_cell_;
    Eigen::Isometry3d T_tool_flange_;
};

} // namespace

ReachStudy study_reach(const Robot& robot, const Eigen::AlignedBox3d& box, double step, const Progress& progress)
{
    // 1e-9 off before rounding up: 2000 / 100 is 20 cells, whatever the last digit says.
    const Eigen::Array3d cells = (box.sizes().array() / step - 1e-9).ceil().max(1.0);
    if (!(cells.prod() <= kMostCells))
        throw InputError("the box has " + to_short_text(cells.prod()) + " cells, at most " + to_short_text(kMostCells));
    const Eigen::Array3i count = cells.cast<int>();
    ReachStudy study;
    study.tips.resize(3, static_cast<Eigen::Index>(cells.prod()));
    for (Eigen::Index i = 0; i < study.tips.cols(); ++i) {
        const Eigen::Array3d at(i % count[0], i / count[0] % count[1], i / count[0] / count[1]);
        study.tips.col(i) = box.min() + (box.sizes().array() * (at + 0.5) / cells).matrix();
    }
    study.share.resize(study.tips.cols());
    const Study how(robot);
    constexpr Eigen::Index kTold = 1000; // cells between two words about the progress
    for (Eigen::Index first = 0; first < study.tips.cols(); first += kTold) {
        tell(progress, static_cast<double>(first) / static_cast<double>(study.tips.cols()));
        tbb::parallel_for(first, std::min(first + kTold, study.tips.cols()),
                          [&](Eigen::Index i) { study.share[i] = how.share(study.tips.col(i)); });
    }
    return study;
}

} // namespace fettle
