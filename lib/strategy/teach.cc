#include "strategy/teach.h"

#include "sampling/probe.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace fettle::strategy {
namespace {

/// Between two readings of the stick: a machine that answers within some ms can follow.
constexpr double kPeriod = 0.02; // s

} // namespace

TaughtBoundaries teach_boundaries(const job::Job& job, gantry::Gantry& gantry, const gantry::protocol::Limits& limits,
                                  Steering& steering, double lowest, const PointCallback& recorded)
{
    if (gantry.status().commanded.z() < job.safe_height) gantry.lift(job.safe_height);
    Eigen::Vector3d position = gantry.status().commanded;
    std::vector<Eigen::Vector3d> points;
    Eigen::Index anomaly_count = -1; // -1: the anomaly's boundary is not complete yet
    double clock = 0;                // steering time, s
    for (Stick stick = steering.at(clock); !stick.end; stick = steering.at(clock)) {
        if (stick.button == Button::record) {
            points.emplace_back(position.x(), position.y(), gantry.probe(position.head<2>(), lowest));
            recorded(anomaly_count < 0 ? "anomaly" : "sampling",
                     Eigen::Index(points.size()) - std::max<Eigen::Index>(anomaly_count, 0), points.back());
        } else if (stick.button == Button::next) {
            if (anomaly_count >= 0) break;
            anomaly_count = Eigen::Index(points.size());
        } else if (stick.direction.norm() > 0) {
            const auto change = steering.next_change();
            const bool last = change && *change - clock <= kPeriod; // a step ends when the stick is moved
            position.head<2>() += stick.direction.normalized() * job.feed.rate * (last ? *change - clock : kPeriod);
            position = position.cwiseMax(limits.min).cwiseMin(limits.max);
            gantry.grind(position, job.feed.rate);
            clock = last ? *change : clock + kPeriod;
        } else if (const auto next = steering.next_change()) {
            clock = std::max(clock, *next);
        } else {
            std::this_thread::sleep_for(std::chrono::duration<double>(kPeriod));
        }
    }
    const Eigen::Index count = points.size();
    Eigen::Matrix3Xd touches(3, count);
    for (Eigen::Index i = 0; i < count; ++i) touches.col(i) = points[i];
    if (const double radius = job.probe.tip_radius; radius > 0) {
        touches.row(2).array() += radius;
        touches = sampling::contact_points(job, touches, radius);
    }
    const Eigen::Index first = anomaly_count < 0 ? count : anomaly_count;
    return {touches.leftCols(first), touches.rightCols(count - first)};
}

} // namespace fettle::strategy
