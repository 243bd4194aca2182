#include "strategy/manual.h"

#include "strategy/recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace fettle::strategy {
namespace {

constexpr double kManualPeriod = 0.005; // between two readings of the stick, s
constexpr double kForceBand = 0.1;      // tolerance relative to the set force
/// A smaller share of the set force is not a contact, but the transducer's noise.
constexpr double kContactShare = 0.05;

class Operator {
  public:
    Operator(const job::Job& job, gantry::Gantry& gantry, Steering& steering, const ManualOptions& options)
        : job_(job), steering_(steering), options_(options), machine_(gantry, job.units, {}, "", options.journal),
          position_(gantry.status().commanded.head<2>()), clock_(options.steering_time)
    {
    }

    ManualRun run()
    {
        try {
            steer();
        } catch (const gantry::GantryFault& fault) {
            result_.failure = fault.what();
            machine_.record_fault({1, 1, Event::fault});
        }
        result_.steering_time = clock_;
        if (result_.contact_time > 0) result_.share_in_band /= result_.contact_time;
        result_.trace = machine_.trace();
        return std::move(result_);
    }

  private:
    void steer()
    {
        try {
            for (Stick stick = steering_.at(clock_); !stick.end; stick = steering_.at(clock_)) {
                if (options_.go_on && !options_.go_on(stick, machine_.status())) throw gantry::Interrupted();
                step(stick);
            }
            lift();
        } catch (const gantry::Interrupted&) {
            machine_.retract({1, 1, Event::stopped}, safe_height_);
        }
    }

    void step(const Stick& stick)
    {
        const bool centred = stick.direction.norm() == 0;
        if (!stick.on_part || centred) lift();
        if (centred) return wait();
        position_ += stick.direction.normalized() * job_.feed.rate * kManualPeriod;
        clock_ += kManualPeriod;
        const Eigen::Vector3d to(position_.x(), position_.y(), stick.on_part ? options_.lowest : safe_height_);
        if (!stick.on_part) return void(machine_.grind({}, to, job_.feed.rate));
        down_ = true;
        const gantry::GantryStatus& status = machine_.press({}, to, job_.feed.rate, options_.force);
        result_.peak_force = std::max({result_.peak_force, status.force, status.peak_force});
        if (!(status.force > kContactShare * options_.force)) return;
        result_.contact_time += kManualPeriod;
        if (std::abs(status.force - options_.force) <= kForceBand * options_.force)
            result_.share_in_band += kManualPeriod;
    }

    void lift()
    {
        if (!down_) return;
        down_ = false;
        machine_.lift({}, safe_height_);
    }

    /// Waits until the stick moves, at most a period.
    void wait()
    {
        if (const auto next = steering_.next_change())
            clock_ = std::max(clock_, *next);
        else
            std::this_thread::sleep_for(std::chrono::duration<double>(kManualPeriod));
    }

    const job::Job& job_;
    Steering& steering_;
    const ManualOptions& options_;
    double safe_height_ = job_.safe_height;
    Recorder machine_;
    Eigen::Vector2d position_;
    double clock_; ///< of the steering, s
    bool down_ = false;
    ManualRun result_;
};

} // namespace

ManualRun run_manual(const job::Job& job, gantry::Gantry& gantry, Steering& steering, const ManualOptions& options)
{
    return Operator(job, gantry, steering, options).run();
}

} // namespace fettle::strategy
