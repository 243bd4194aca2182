#include "robot/collision.h"

#include "robot/clearance_tracker.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace fettle::robot {

CheckedPath check_path(const Robot& robot, const Workpiece* workpiece, const CellJointsPath& joints,
                       const CollisionOptions& options, const core::Progress& progress)
{
    const Cell cell(robot, workpiece, options);
    const std::size_t count = joints.cols();
    CheckedPath checked{std::vector<CellClearance>(count), std::vector<CellClearance>(count), 0};
    std::atomic<std::size_t> midpoint_count = 0;
    constexpr std::size_t kPosesPerTask = 256; // the pose before each task's first is measured twice
    constexpr std::size_t kPosesPerProgress = 64 * kPosesPerTask;
    for (std::size_t from = 0; from < count; from += kPosesPerProgress) {
        core::report_progress(progress, double(from) / double(count));
        const std::size_t tasks = (std::min(kPosesPerProgress, count - from) + kPosesPerTask - 1) / kPosesPerTask;
        tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
            const std::size_t first = from + task * kPosesPerTask, end = std::min(first + kPosesPerTask, count);
            ClearanceTracker tracker(cell);
            for (std::size_t i = first == 0 ? 0 : first - 1; i < end; ++i) {
                const CellJoints q = joints.col(i);
                if (q.hasNaN()) {
                    tracker.reset();
                    continue;
                }
                const CellClearance minimum = tracker.advance(q);
                if (i < first) continue;
                checked.at_poses[i] = minimum;
                if (tracker.step_count() > 1) checked.between_poses[i] = tracker.swept_clearance();
            }
            midpoint_count += tracker.midpoint_count();
        });
    }
    checked.midpoint_count = midpoint_count;
    return checked;
}

} // namespace fettle::robot
