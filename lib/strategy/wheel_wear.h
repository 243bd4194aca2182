#pragma once

#include "job/job.h"

namespace fettle {

/// What a wheel loses between two measurements at P0, from the force it has ground with: by Preston's law the stock,
/// and by the grinding ratio the wheel, go with ∫F dt. How fast is learned from the measurements.
class WheelWear {
  public:
    /// @param remaining  the most that may be left on the stock, mm
    WheelWear(const Job& job, double remaining);

    void ground(double force, double duration) { impulse_ += force * duration; }
    void measured(double radius);
    void renewed(); ///< a new wheel; measured() follows

    /// To go down by, mm: a little less than is lost, so that nothing is ground too deep.
    double loss() const;
    /// What loss() may be wrong by is more than it may.
    bool due() const;

  private:
    double steepest_;    ///< wear rate of a soft wheel, until one has been measured, mm/(N s)
    double most_;        ///< loss between two measurements, mm
    double impulse_ = 0; ///< since the last measurement, N s
    double radius_ = 0;  ///< then, mm; 0: not measured yet
    double worn_ = 0;    ///< by all measurements of this and former wheels, mm
    double work_ = 0;    ///< what they were worn by, N s
};

} // namespace fettle
