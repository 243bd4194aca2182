#include "strategy/teach.h"

#include "sampling/probe.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace fettle::strategy {

double SteeringClock::advance(double period)
{
    const auto change = steering.next_change();
    const bool ends = change && *change - time <= period; // a step ends when the stick is moved
    const double duration = ends ? *change - time : period;
    time = ends ? *change : time + period;
    return duration;
}

void SteeringClock::rest(double period)
{
    if (const auto next = steering.next_change())
        time = std::max(time, *next);
    else
        std::this_thread::sleep_for(std::chrono::duration<double>(period));
}

Teacher::Teacher(const job::Job& job, gantry::Gantry& gantry, const gantry::protocol::Limits& limits, double lowest)
    : job_(job), gantry_(gantry), limits_(limits), lowest_(lowest)
{
    if (gantry.status().commanded.z() < job.safe_height) gantry.lift(job.safe_height);
    position_ = gantry.status().commanded;
}

void Teacher::move(const Eigen::Vector2d& direction, double duration)
{
    position_.head<2>() += direction.normalized() * job_.feed.rate * duration;
    position_ = position_.cwiseMax(limits_.min).cwiseMin(limits_.max);
    gantry_.grind(position_, job_.feed.rate);
}

Eigen::Vector3d Teacher::touch() { return {position_.x(), position_.y(), gantry_.probe(position_.head<2>(), lowest_)}; }

TaughtBoundaries boundaries_of_touches(const job::Job& job, const std::vector<Eigen::Vector3d>& anomaly,
                                       const std::vector<Eigen::Vector3d>& sampling)
{
    const Eigen::Index first = anomaly.size(), second = sampling.size();
    Eigen::Matrix3Xd touches(3, first + second);
    for (Eigen::Index i = 0; i < first; ++i) touches.col(i) = anomaly[i];
    for (Eigen::Index i = 0; i < second; ++i) touches.col(first + i) = sampling[i];
    if (const double radius = job.probe.tip_radius; radius > 0) {
        touches.row(2).array() += radius;
        touches = sampling::contact_points(job, touches, radius);
    }
    return {touches.leftCols(first), touches.rightCols(second)};
}

TaughtBoundaries teach_boundaries(const job::Job& job, gantry::Gantry& gantry, const gantry::protocol::Limits& limits,
                                  Steering& steering, double lowest, const PointCallback& recorded)
{
    Teacher teacher(job, gantry, limits, lowest);
    SteeringClock clock{steering};
    std::vector<Eigen::Vector3d> anomaly, sampling;
    bool is_anomaly_complete = false;
    for (Stick stick = clock.stick(); !stick.end; stick = clock.stick()) {
        if (stick.button == Button::record) {
            std::vector<Eigen::Vector3d>& points = is_anomaly_complete ? sampling : anomaly;
            points.push_back(teacher.touch());
            recorded(is_anomaly_complete ? "sampling" : "anomaly", Eigen::Index(points.size()), points.back());
        } else if (stick.button == Button::next) {
            if (is_anomaly_complete) break;
            is_anomaly_complete = true;
        } else if (stick.direction.norm() > 0) {
            teacher.move(stick.direction, clock.advance(kTeachingPeriod));
        } else {
            clock.rest(kTeachingPeriod);
        }
    }
    return boundaries_of_touches(job, anomaly, sampling);
}

} // namespace fettle::strategy
