#include "core/constants.h"
#include "robot/avoid_tilts.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace fettle::robot {

namespace {

using Eigen::Vector2d;

// Angle between cones, and between tilts on a cone, rad (Chen & Wei, 5.3).
constexpr double kTiltStep = std::numbers::pi / 36;

// Poses that must change form a group if no more than this many poses lie between them. Groups are changed in parallel.
constexpr std::size_t kMaxGapInGroup = 32;

// A tilt towards the azimuth, counted from the tool's x.
Vector2d tilt_towards(double azimuth, double angle) { return angle * Vector2d(-std::sin(azimuth), std::cos(azimuth)); }

// All tilts up to the largest, cone by cone; on each cone those nearest to the azimuth of `start` come first.
std::vector<Vector2d> tilts_on_cones(const Vector2d& start, double max_tilt)
{
    const long count = std::lround(2 * std::numbers::pi / kTiltStep);
    const long first = start.isZero(0) ? 0 : std::lround(std::atan2(-start.x(), start.y()) / kTiltStep);
    std::vector<Vector2d> tilts = {Vector2d::Zero()};
    for (int cone = 1; cone * kTiltStep <= max_tilt * (1 + 1e-9); ++cone)
        for (long k = 0; k < count; ++k) {
            const long azimuth = first + (k % 2 == 0 ? -k / 2 : (k + 1) / 2);
            tilts.push_back(tilt_towards(double(azimuth) * kTiltStep, cone * kTiltStep));
        }
    return tilts;
}

class PoseByPose {
  public:
    PoseByPose(const ChangeChecker& trials, const std::vector<bool>& must_change, const AvoidOptions& options,
               ChangedPath& path)
        : trials_(trials), must_change_(must_change), options_(options), path_(path), given_(path)
    {
    }

    /// Changes the poses from `first` to `end` - 1, one after the other.
    /// @param ignore_previous  true: the pose before the first one counts as it was given
    void run(std::size_t first, std::size_t end, bool ignore_previous)
    {
        Solution previous = first > 0 ? solution(ignore_previous ? given_ : path_, first - 1) : Solution();
        for (std::size_t i = first; i < end; ++i) {
            const bool previous_as_given = i == 0 || previous.change == given_.changes[i - 1];
            const Solution given = solution(given_, i);
            const bool keep = !must_change_[i] && (previous_as_given || !jumps(previous.joints, given.joints));
            previous = keep ? given : find_change(i, previous);
            path_.changes[i] = previous.change;
            path_.joints.col(i) = previous.joints;
        }
    }

  private:
    struct Solution {
        PoseChange change;
        CellJoints joints = CellJoints::Constant(core::kNaN);
    };

    static Solution solution(const ChangedPath& path, std::size_t i) { return {path.changes[i], path.joints.col(i)}; }

    /// False if one of the poses is not reached.
    bool jumps(const CellJoints& previous, const CellJoints& q) const
    {
        return (q - previous).head<6>().cwiseAbs().maxCoeff() > options_.jump_threshold;
    }

    /// The first change of pose i that is free of collisions and reached without a jump; else the given one.
    Solution find_change(std::size_t i, const Solution& previous) const
    {
        const CellJoints seed = previous.joints.hasNaN() ? trials_.seed_joints(i) : previous.joints;
        CollidingChanges blocked;
        const int retreats = int(std::floor(options_.max_retreat / kRetreatStep * (1 + 1e-9)));
        const std::vector<Vector2d> tilts = tilts_on_cones(previous.change.tilt, options_.max_tilt);
        for (int k = 0; k <= retreats; ++k)
            for (const Vector2d& tilt : tilts) {
                const PoseChange change{tilt, k * kRetreatStep};
                if (blocked.contains(change)) continue;
                const CellJoints q = trials_.find_clear_joints(i, change, seed, blocked);
                if (!q.hasNaN() && !jumps(previous.joints, q)) return {change, q};
            }
        return solution(given_, i);
    }

    const ChangeChecker& trials_;
    const std::vector<bool>& must_change_;
    const AvoidOptions& options_;
    ChangedPath& path_;
    const ChangedPath given_;
};

} // namespace

void tilt_by_pose(const ChangeChecker& trials, const std::vector<bool>& must_change, const AvoidOptions& options,
                  ChangedPath& path)
{
    std::vector<std::size_t> starts; // first pose of each group
    std::size_t last = 0;
    for (std::size_t i = 0; i < must_change.size(); ++i) {
        if (!must_change[i]) continue;
        if (starts.empty() || i - last > kMaxGapInGroup) starts.push_back(i);
        last = i;
    }
    const std::vector<PoseChange> given = path.changes;
    PoseByPose search(trials, must_change, options, path);
    const auto end = [&](std::size_t k) { return k + 1 < starts.size() ? starts[k + 1] : must_change.size(); };
    tbb::parallel_for(std::size_t{0}, starts.size(), [&](std::size_t k) { search.run(starts[k], end(k), true); });
    // A group that is still changed where the next one starts affects the next one: that is searched again.
    for (std::size_t k = 1; k < starts.size(); ++k)
        if (path.changes[starts[k] - 1] != given[starts[k] - 1]) search.run(starts[k], end(k), false);
}

} // namespace fettle::robot
