#include "strategy/force_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {
namespace {

/// Of what may remain: as far from grinding too deep as from leaving too much.
constexpr double kTarget = 0.5;
/// What q may be over what was seen of it: readings are noisy, and the edges of metal lie between places.
constexpr double kSofter = 1.25;

} // namespace

ForceControl::ForceControl(const Job& job, double remaining)
    : radius_(job.wheel.radius), preload_(job.force.preload), stiffness_(job.force.stiffness), feed_(job.feed.rate),
      most_force_(job.force.down), target_(kTarget * remaining), least_yield_(job.removal / job.wheel.width),
      near_(std::sqrt(2 * job.wheel.radius * remaining)), steepest_(remaining / near_)
{
}

void ForceControl::begin_pass(const std::vector<double>& along)
{
    along_ = along;
    known_.assign(along.size(), {std::numeric_limits<double>::quiet_NaN(), 0, 0});
    set_down();
}

void ForceControl::set_down()
{
    at_ = -1;
    pressed_ = 0;
}

void ForceControl::arrived(int point, double remaining, double impulse)
{
    Known& known = known_[static_cast<std::size_t>(point)];
    if (at_ >= 0 && std::isfinite(known.remaining)) {
        const double way = along_[static_cast<std::size_t>(point)] - along_[static_cast<std::size_t>(at_)];
        const double cut = depth(point, way > 0 ? +1 : -1, remaining);
        // A wheel that climbs takes less than stands before it, one that sinks takes more, all along its contact.
        const double climbed = remaining - known_[static_cast<std::size_t>(at_)].remaining;
        known.taken = std::max(cut * std::abs(way) - climbed * std::sqrt(2 * radius_ * cut), 0.0);
        known.impulse = impulse;
    }
    known.remaining = remaining;
    at_ = point;
}

double ForceControl::press(int point, int direction)
{
    const double way =
        at_ < 0 ? 0 : std::abs(along_[static_cast<std::size_t>(point)] - along_[static_cast<std::size_t>(at_)]);
    pressed_ = std::min(wanted(point, direction), pressed_ + steepest_ * way);
    return pressed_;
}

double ForceControl::wanted(int point, int direction) const
{
    const double seen = yield(point);
    if (!(seen > 0)) return 0;
    const double q = std::max(kSofter * seen, least_yield_);
    const double force = std::min(depth(point, direction, target_) * feed_ / q, most_force_);
    return std::max((force - preload_) / stiffness_ - target_, 0.0);
}

/// 0: not known.
double ForceControl::yield(int point) const
{
    const double here = along_[static_cast<std::size_t>(point)];
    if (!(known_[static_cast<std::size_t>(point)].impulse > 0)) return 0;
    double taken = 0, impulse = 0;
    for (std::size_t n = 0; n < along_.size(); ++n) {
        if (std::abs(along_[n] - here) > near_) continue;
        taken += known_[n].taken;
        impulse += known_[n].impulse;
    }
    return taken / impulse;
}

/// Of the cut of a wheel whose lowest line stands at `tip`.
double ForceControl::depth(int point, int direction, double tip) const
{
    const double here = along_[static_cast<std::size_t>(point)];
    const int count = static_cast<int>(along_.size());
    double depth = 0;
    for (int n = point; n >= 0 && n < count; n += direction) {
        const double over = stock(n) - tip;
        if (!(over > depth)) break;
        const int next = n + direction;
        const bool last = next < 0 || next >= count;
        depth = last ? over : std::min(over, rim(along_[static_cast<std::size_t>(next)] - here));
    }
    return depth;
}

/// Over the reference: under every rim that stood nearby.
double ForceControl::stock(int point) const
{
    const double here = along_[static_cast<std::size_t>(point)];
    double z = known_[static_cast<std::size_t>(point)].remaining;
    for (const int direction : {-1, +1})
        for (int n = point + direction; n >= 0 && n < int(along_.size()); n += direction) {
            const auto k = static_cast<std::size_t>(n);
            const double rise = rim(along_[k] - here);
            if (rise >= z) break;
            z = std::min(z, known_[k].remaining + rise);
        }
    return z;
}

} // namespace fettle
