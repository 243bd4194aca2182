#pragma once

#include "job/job.h"
#include "strategy/run.h"

#include <optional>

namespace fettle::strategy {

/// Estimates the radius that a wheel loses between two measurements at P0 from its grinding force: by Preston's law the
/// removed stock, and by the grinding ratio the lost wheel, are proportional to ∫F dt. The wear rate is learned from
/// the measurements.
class WheelWear {
  public:
    /// @param max_remaining  largest height that may be left on the stock, mm
    WheelWear(const job::Job& job, double max_remaining, const std::optional<KnownRemoval>& known = std::nullopt);

    /// True if former runs taught the wear rate: no measurement is needed to learn it.
    bool is_known() const { return is_known_; }

    void add_force(double force, double duration) { impulse_ += force * duration; }
    void set_measured_radius(double radius);
    void start_new_wheel(); ///< set_measured_radius() follows

    /// Estimated loss since the last measurement, mm: on the low side, so that nothing is ground too deep.
    double loss() const;
    /// Estimated loss since the last measurement, mm, without bias: the rim is that much higher than the drives assume.
    double expected_loss() const;
    /// True if the error of loss() may exceed its bound.
    bool measurement_due() const;

  private:
    bool is_known_;
    double sigma_;             ///< of a learned wear rate, relative
    double max_rate_;          ///< wear rate of a soft wheel, used until one has been measured, mm/(N s)
    double max_loss_;          ///< between two measurements, mm
    double impulse_ = 0;       ///< since the last measurement, N s
    double radius_ = 0;        ///< last measured, mm; 0: not measured yet
    double total_loss_ = 0;    ///< in all measurements of this and former wheels, mm
    double total_impulse_ = 0; ///< that caused it, N s
};

} // namespace fettle::strategy
