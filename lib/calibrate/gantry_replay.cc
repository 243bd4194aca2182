#include "calibrate/gantry_replay.h"

#include "removal/wheel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fettle::calibrate {
namespace {

using Eigen::Vector3d;
using strategy::TraceRow;

/// Distance of two positions of the wheel, as of strategy::replay_removal: a ridge of step² / 8R between them.
constexpr double kReplayStepCells = 2;
/// How long a wheel that is to be lifted may go on as before, s: two of LinuxCNC's readings, which are 27 ms apart.
constexpr double kLiftDelay = 0.055;
/// Smallest ratio of the lower to the upper bound of a volume that is known.
constexpr double kMinKnownShare = 0.95;
/// Largest ratio of the peak force between two readings to the larger one of them: the mean of the two is the mean
/// force between them, then.
constexpr double kMaxPeakRatio = 1.1;

double rim_radius(const TraceRow& row, const job::Job& job) { return row.radius > 0 ? row.radius : job.wheel.radius; }

/// A wheel in a stock of its own.
class Cutter {
  public:
    Cutter(const job::Job& job, const removal::HeightField& stock, double compliance)
        : job_(job), R_working_machine_(job::rotation_working_machine(job.theta)), compliance_(compliance),
          stock_(stock), wheel_(stock_, job.wheel.width, {.along_normal = true})
    {
    }

    /// Cuts at a place of the tool. @return  what was removed; without tangential force `lift` is weighted with the
    /// cosine of the rim's slope, and `push` with its sine, negative
    removal::WheelInStock::Overlap cut(const TraceRow& at)
    {
        const double z = at.tool.z() + compliance_ * at.force;
        wheel_.place(R_working_machine_ * at.tool.head<2>(), rim_radius(at, job_), z);
        const removal::WheelInStock::Overlap removed = wheel_.overlap(z);
        wheel_.cut(z);
        return removed;
    }

    /// Cuts along the line from a place, where it has cut, to another; the force changes as the place does.
    removal::WheelInStock::Overlap cut_to(const TraceRow& from, const TraceRow& to)
    {
        const Vector3d motion = to.tool - from.tool;
        const int steps = std::max(1, int(std::ceil(motion.norm() / (kReplayStepCells * stock_.cell))));
        removal::WheelInStock::Overlap sum;
        for (int n = 1; n <= steps; ++n) {
            const double share = double(n) / steps;
            TraceRow at = to;
            at.tool = from.tool + motion * share;
            at.force = from.force + (to.force - from.force) * share;
            const removal::WheelInStock::Overlap removed = cut(at);
            sum.volume += removed.volume;
            sum.lift += removed.lift;
            sum.push += removed.push;
        }
        return sum;
    }

    removal::HeightField& stock() { return stock_; }

  private:
    const job::Job& job_;
    Eigen::Matrix2d R_working_machine_;
    double compliance_;
    removal::HeightField stock_;
    removal::WheelInStock wheel_;
};

/// Where the wheel could at most have come before it was lifted: on along its line, and no higher.
TraceRow before_lift(const TraceRow& previous, const TraceRow& last)
{
    const Vector3d motion = last.tool - previous.tool;
    TraceRow end = last;
    end.tool += motion.normalized() * (last.feed * kLiftDelay); // normalized() leaves zero as it is
    end.tool.z() = std::min(end.tool.z(), last.tool.z());
    return end;
}

} // namespace

bool is_grinding(const TraceRow& row) { return row.feed > 0; }

Replay replay(const std::vector<TraceRow>& trace, const job::Job& job, const removal::HeightField& stock,
              double compliance)
{
    Replay result;
    Cutter upper(job, stock, compliance), lower(job, stock, compliance);
    for (std::size_t i = 1; i < trace.size(); ++i) {
        const TraceRow &row = trace[i], &last = trace[i - 1];
        if (!is_grinding(row)) { // lowered, or lifted, in place: what it cuts there is no interval's
            if (i > 1 && is_grinding(last) && last.force > 0) lower.cut_to(last, before_lift(trace[i - 2], last));
            if (!(row.force > 0)) continue;
            lower.cut(row);
            const double volume = upper.cut(row).volume;
            if (!result.strokes.empty()) result.strokes.back().removed += volume;
            continue;
        }
        if (!is_grinding(last) || last.pass != row.pass || result.strokes.empty()) result.strokes.emplace_back();
        const removal::WheelInStock::Overlap removed = upper.cut_to(last, row);
        const double least = lower.cut_to(last, row).volume;
        Stroke& stroke = result.strokes.back();
        stroke.radius = rim_radius(row, job);
        stroke.removed += removed.volume;
        const double force = (row.force + last.force) / 2, time = row.time - last.time;
        if (force > 0 && least >= kMinKnownShare * removed.volume &&
            row.peak_force <= kMaxPeakRatio * std::max(row.force, last.force))
            result.intervals.push_back(
                {result.strokes.size() - 1, force * time, time, removed.volume, removed.lift, -removed.push});
    }
    result.left = std::move(upper.stock());
    return result;
}

} // namespace fettle::calibrate
