#include "robot/avoid_tilts.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>

namespace fettle {

namespace {

using Eigen::Index, Eigen::Vector2d;

// From cone to cone, and around each (Chen & Wei, 5.3).
constexpr double kTiltStep = std::numbers::pi / 36;

// Poses that are in trouble and no more than so many apart are led around one after the other.
constexpr std::size_t kApart = 32;

// The tool leans towards the azimuth, counted from its x.
Vector2d tilt_towards(double azimuth, double angle) { return angle * Vector2d(-std::sin(azimuth), std::cos(azimuth)); }

// All tilts up to the largest, cone by cone; on each those first that are nearest to the azimuth of another.
std::vector<Vector2d> cones(const Vector2d& near, double most)
{
    const long around = std::lround(2 * std::numbers::pi / kTiltStep);
    const long first = near.isZero(0) ? 0 : std::lround(std::atan2(-near.x(), near.y()) / kTiltStep);
    std::vector<Vector2d> tilts = {Vector2d::Zero()};
    for (int cone = 1; cone * kTiltStep <= most * (1 + 1e-9); ++cone)
        for (long k = 0; k < around; ++k) {
            const long azimuth = first + (k % 2 == 0 ? -k / 2 : (k + 1) / 2);
            tilts.push_back(tilt_towards(double(azimuth) * kTiltStep, cone * kTiltStep));
        }
    return tilts;
}

class ByPose {
  public:
    ByPose(const Trials& trials, const std::vector<bool>& trouble, const AvoidOptions& options, Led& led)
        : trials_(trials), trouble_(trouble), options_(options), led_(led), given_(led)
    {
    }

    /// Poses first to end - 1, one after the other.
    /// @param alone  as if the pose before the first one were as it was
    void run(std::size_t first, std::size_t end, bool alone)
    {
        Way before = first > 0 ? way(alone ? given_ : led_, first - 1) : Way();
        for (std::size_t i = first; i < end; ++i) {
            const bool as_given = i == 0 || before.change == given_.changes[i - 1];
            const Way given = way(given_, i);
            before = !trouble_[i] && (as_given || !jumps(before.joints, given.joints)) ? given : solved(i, before);
            led_.changes[i] = before.change;
            led_.joints.col(static_cast<Index>(i)) = before.joints;
        }
    }

  private:
    struct Way {
        PoseChange change;
        CellJoints joints = CellJoints::Constant(std::numeric_limits<double>::quiet_NaN());
    };

    static Way way(const Led& led, std::size_t i) { return {led.changes[i], led.joints.col(static_cast<Index>(i))}; }

    bool jumps(const CellJoints& before, const CellJoints& q) const
    {
        return (q - before).head<6>().cwiseAbs().maxCoeff() > options_.jump; // false for NaN: nothing to keep to
    }

    Way solved(std::size_t i, const Way& before) const
    {
        const auto column = static_cast<Index>(i);
        const CellJoints near = before.joints.hasNaN() ? trials_.near(column) : before.joints;
        Blocked blocked;
        const int retreats = static_cast<int>(std::floor(options_.most_retreat / kRetreatStep * (1 + 1e-9)));
        const std::vector<Vector2d> tilts = cones(before.change.tilt, options_.most_tilt);
        for (int k = 0; k <= retreats; ++k)
            for (const Vector2d& tilt : tilts) {
                const PoseChange change{tilt, k * kRetreatStep};
                if (blocked.holds(change)) continue;
                const CellJoints q = trials_.look(column, change, near, blocked);
                if (!q.hasNaN() && !jumps(before.joints, q)) return {change, q};
            }
        return way(given_, i);
    }

    const Trials& trials_;
    const std::vector<bool>& trouble_;
    const AvoidOptions& options_;
    Led& led_;
    const Led given_;
};

} // namespace

void tilt_by_pose(const Trials& trials, const std::vector<bool>& trouble, const AvoidOptions& options, Led& led)
{
    std::vector<std::size_t> starts;
    std::size_t last = 0;
    for (std::size_t i = 0; i < trouble.size(); ++i) {
        if (!trouble[i]) continue;
        if (starts.empty() || i - last > kApart) starts.push_back(i);
        last = i;
    }
    const std::vector<PoseChange> given = led.changes;
    ByPose by_pose(trials, trouble, options, led);
    const auto end = [&](std::size_t k) { return k + 1 < starts.size() ? starts[k + 1] : trouble.size(); };
    tbb::parallel_for(std::size_t{0}, starts.size(), [&](std::size_t k) { by_pose.run(starts[k], end(k), true); });
    // One that still leans otherwise than given where the next begins hands its tilt on.
    for (std::size_t k = 1; k < starts.size(); ++k)
        if (led.changes[starts[k] - 1] != given[starts[k] - 1]) by_pose.run(starts[k], end(k), false);
}

} // namespace fettle
