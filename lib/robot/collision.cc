#include "robot/collision.h"

#include "robot/walk.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace fettle {

CheckedPath check_path(const Robot& robot, const Workpiece* workpiece, const CellJointsPath& joints,
                       const CollisionOptions& options, const Progress& progress)
{
    const Cell cell(robot, workpiece, options);
    const auto count = static_cast<std::size_t>(joints.cols());
    CheckedPath checked{std::vector<CellClearance>(count), std::vector<CellClearance>(count), 0};
    std::atomic<std::size_t> looks = 0;
    constexpr std::size_t kBlock = 256; // poses for one thread: the first of each is looked at twice
    constexpr std::size_t kTold = 64 * kBlock;
    for (std::size_t from = 0; from < count; from += kTold) {
        tell(progress, static_cast<double>(from) / static_cast<double>(count));
        const std::size_t blocks = (std::min(kTold, count - from) + kBlock - 1) / kBlock;
        tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
            const std::size_t first = from + block * kBlock, end = std::min(first + kBlock, count);
            Walk walk(cell);
            for (std::size_t i = first == 0 ? 0 : first - 1; i < end; ++i) {
                const CellJoints q = joints.col(static_cast<Eigen::Index>(i));
                if (q.hasNaN()) {
                    walk.leave();
                    continue;
                }
                const CellClearance least = walk.step(q);
                if (i < first) continue;
                checked.pose[i] = least;
                if (walk.steps() > 1) checked.between[i] = walk.way();
            }
            looks += walk.looks();
        });
    }
    checked.looks = looks;
    return checked;
}

} // namespace fettle
