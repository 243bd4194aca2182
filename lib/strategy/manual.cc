#include "strategy/manual.h"

#include "strategy/recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace fettle {
namespace {

/// The stick is looked at so often.
constexpr double kPeriod = 0.005; // s
constexpr double kBand = 0.1;     // of the force that was set
/// Less of it is no contact: a transducer's noise looks like a force.
constexpr double kContact = 0.05;

class Operator {
  public:
    Operator(const Job& job, Gantry& gantry, Steering& steering, double force, double lowest, TraceFile* journal)
        : job_(job), steering_(steering), force_(force), lowest_(lowest), machine_(gantry, job.units, {}, "", journal),
          place_(gantry.status().commanded.head<2>())
    {
    }

    ManualRun run()
    {
        try {
            for (Stick stick = steering_.at(0); !stick.end; stick = steering_.at(clock_)) step(stick);
            lift();
        } catch (const GantryFault& fault) {
            result_.failure = fault.what();
            machine_.decide({1, 1, Event::fault});
        }
        if (result_.contact_time > 0) result_.within /= result_.contact_time;
        result_.trace = machine_.trace();
        return std::move(result_);
    }

  private:
    void step(const Stick& stick)
    {
        if (!stick.press || stick.way.norm() == 0) lift();
        if (stick.way.norm() == 0) return wait();
        place_ += stick.way.normalized() * job_.feed.rate * kPeriod;
        clock_ += kPeriod;
        const Eigen::Vector3d to(place_.x(), place_.y(), stick.press ? lowest_ : height_);
        if (!stick.press) {
            machine_.grind({}, to, job_.feed.rate);
            return;
        }
        down_ = true;
        const GantryStatus& status = machine_.press({}, to, job_.feed.rate, force_);
        result_.peak_force = std::max({result_.peak_force, status.force, status.peak_force});
        if (!(status.force > kContact * force_)) return;
        result_.contact_time += kPeriod;
        if (std::abs(status.force - force_) <= kBand * force_) result_.within += kPeriod;
    }

    void lift()
    {
        if (!down_) return;
        down_ = false;
        machine_.lift({}, height_);
    }

    /// Until the stick moves.
    void wait()
    {
        const auto next = steering_.next_change();
        if (next)
            clock_ = std::max(clock_, *next);
        else
            std::this_thread::sleep_for(std::chrono::duration<double>(kPeriod));
    }

    const Job& job_;
    Steering& steering_;
    double force_, lowest_;
    double height_ = job_.safe_height;
    Recorder machine_;
    Eigen::Vector2d place_;
    double clock_ = 0; ///< of the steering, s
    bool down_ = false;
    ManualRun result_;
};

} // namespace

ManualRun run_manual(const Job& job, Gantry& gantry, Steering& steering, double force, double lowest,
                     TraceFile* journal)
{
    return Operator(job, gantry, steering, force, lowest, journal).run();
}

} // namespace fettle
