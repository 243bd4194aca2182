#pragma once

#include "gantry/gantry.h"
#include "job/job.h"
#include "margin/adaptive.h"
#include "sampling/scan.h"
#include "sampling/touch_plan.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fettle::gantry {

/// Probes the points of plans on a machine, each once: its result is kept for later plans.
class GantryProbe {
  public:
    /// Searches for the surface down to as far below the lowest boundary point as the safe height is above it.
    /// @param known    touches of an earlier probe: lowest points of the tip; they are not made again
    /// @param touched  called after each touch with such a point; may be empty
    /// @throws InputError if no boundary point has a z
    GantryProbe(Gantry& gantry, const job::Job& job, std::vector<Eigen::Vector3d> known = {},
                std::function<void(const Eigen::Vector3d&)> touched = {});

    /// Result as that of probe() (sampling/probe.h) on a scan. New points are probed in the order of a short path.
    /// @throws GantryFault
    Eigen::Matrix3Xd operator()(const sampling::TouchPlan& plan);

  private:
    const Eigen::Vector3d* find_touch(const Eigen::Vector2d& xy) const;

    Gantry& gantry_;
    const job::Job& job_;
    double lowest_;                        ///< z, mm
    std::vector<Eigen::Vector3d> touches_; ///< lowest points of the tip; z is NaN where it found no surface
    std::function<void(const Eigen::Vector3d&)> touched_;
};

/// The part to be probed: a scan, or the part on a machine.
struct TouchedPart {
    std::string name;                           ///< for messages
    std::string warning;                        ///< warning that it may be the wrong part; empty: none
    std::shared_ptr<const sampling::Scan> scan; ///< null on a machine
    std::shared_ptr<Gantry> machine;            ///< null for a scan
    margin::ProbeFunction touch;
};

struct TouchOptions {
    std::optional<units::Units::Length> unit; ///< of a scan, if it is not the job's
    std::string noise;                        ///< of touches on a scan, in the job's unit (sampling/noise.h)
    std::uint64_t seed = 1;
    double timeout = 10; ///< of a driver, s
};

/// @param on  a scan's file, or gantry:exec:COMMAND
/// @param job  must outlive the part
/// @throws InputError for a bad file or driver, or a unit or noise for a machine
TouchedPart open_touched_part(const std::string& on, const job::Job& job, const TouchOptions& options);

} // namespace fettle::gantry
