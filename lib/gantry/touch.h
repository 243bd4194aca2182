#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "margin/adaptive.h"
#include "sampling/scan.h"
#include "sampling/touch_plan.h"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fettle {

/// Touches the places of plans on a machine, each once: what has been touched is known.
class GantryTouches {
  public:
    /// Searches for the surface down to as far below the lowest boundary point as the safe height is above it.
    /// @throws InputError if no boundary point has a z
    GantryTouches(Gantry& gantry, const Job& job);

    /// As probe() (sampling/probe.h) on a scan. What is new is touched along a short way.
    /// @throws GantryFault
    Eigen::Matrix3Xd operator()(const TouchPlan& plan);

  private:
    const Eigen::Vector3d* known(const Eigen::Vector2d& xy) const;

    Gantry& gantry_;
    const Job& job_;
    double lowest_;                        ///< z, mm
    std::vector<Eigen::Vector3d> touched_; ///< lowest points of the tip; z is NaN where it met nothing
};

/// What is touched: a scan, or the part on a machine.
struct TouchedPart {
    std::string name;                 ///< for messages
    std::string doubt;                ///< what may be wrong with it; empty: nothing
    std::shared_ptr<const Scan> scan; ///< nothing on a machine
    std::shared_ptr<Gantry> machine;  ///< nothing for a scan
    ProbePlan touch;
};

/// How to reach it.
struct TouchOptions {
    std::optional<Units::Length> unit; ///< of a scan, if it is not the job's
    std::string noise;                 ///< of touches on a scan, in the job's unit (sampling/noise.h)
    std::uint64_t seed = 1;
    double patience = 10; ///< with a driver, s
};

/// @param on  a scan's file, or gantry:exec:COMMAND
/// @param job  must outlive the part
/// @throws InputError for a bad file or driver, or a unit or noise for a machine
TouchedPart touched_part(const std::string& on, const Job& job, const TouchOptions& options);

} // namespace fettle
