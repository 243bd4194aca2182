#include "strategy/teach.h"

#include "sampling/probe.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace fettle {
namespace {

/// The stick is looked at so often: what a machine that answers within some ms can follow.
constexpr double kPeriod = 0.02; // s

} // namespace

TaughtBoundaries teach_boundaries(const Job& job, Gantry& gantry, const protocol::Limits& limits, Steering& steering,
                                  double lowest, const Recorded& recorded)
{
    if (gantry.status().commanded.z() < job.safe_height) gantry.lift(job.safe_height);
    Eigen::Vector3d place = gantry.status().commanded;
    std::vector<Eigen::Vector3d> points;
    Eigen::Index around_anomaly = -1; // so many of them; -1: they are not all there yet
    double clock = 0;                 // of the steering, s
    for (Stick stick = steering.at(clock); !stick.end; stick = steering.at(clock)) {
        if (stick.button == Button::record) {
            points.emplace_back(place.x(), place.y(), gantry.probe(place.head<2>(), lowest));
            const auto count = static_cast<Eigen::Index>(points.size());
            recorded(around_anomaly < 0 ? "anomaly" : "sampling", count - std::max<Eigen::Index>(around_anomaly, 0),
                     points.back());
        } else if (stick.button == Button::next) {
            if (around_anomaly >= 0) break;
            around_anomaly = static_cast<Eigen::Index>(points.size());
        } else if (stick.way.norm() > 0) {
            const auto change = steering.next_change();
            const bool last = change && *change - clock <= kPeriod; // a step ends where the stick is moved
            place.head<2>() += stick.way.normalized() * job.feed.rate * (last ? *change - clock : kPeriod);
            place = place.cwiseMax(limits.least).cwiseMin(limits.most);
            gantry.grind(place, job.feed.rate);
            clock = last ? *change : clock + kPeriod;
        } else if (const auto next = steering.next_change()) {
            clock = std::max(clock, *next);
        } else {
            std::this_thread::sleep_for(std::chrono::duration<double>(kPeriod));
        }
    }
    const auto count = static_cast<Eigen::Index>(points.size());
    Eigen::Matrix3Xd touches(3, count);
    for (Eigen::Index i = 0; i < count; ++i) touches.col(i) = points[static_cast<std::size_t>(i)];
    if (const double radius = job.probe.tip_radius; radius > 0) {
        touches.row(2).array() += radius;
        touches = contact_points(job, touches, radius);
    }
    const Eigen::Index first = around_anomaly < 0 ? count : around_anomaly;
    return {touches.leftCols(first), touches.rightCols(count - first)};
}

} // namespace fettle
