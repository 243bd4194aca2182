#pragma once

#include "cloud/cloud.h"
#include "machining/finishing.h"
#include "units/units.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace fettle::machining {

/// A finishing path over a design of a file.
struct FinishingRequest {
    std::string design;                       ///< path; "-": stdin
    std::optional<units::Units::Length> unit; ///< of the design; nothing: mm
    Cutter cutter;
    Eigen::Vector3d tool_axis;       ///< unit, from tip to holder, in the machine's frame
    std::optional<double> scallop;   ///< height of the ridges between passes, mm; either this or the step-over
    std::optional<double> step_over; ///< mm
    std::optional<double> overhang;  ///< mm; nothing: overhang_for()
    FinishingOptions options;        ///< except for step-over and overhang
};

struct FinishingRun {
    std::vector<TipPoint> path; ///< with the tool's axis along z
    FinishingOptions options;   ///< with step-over and overhang
    Eigen::Matrix3d R_tilted_machine;
    std::vector<std::string> warnings;
};

/// @throws InputError as read_design(), estimate_design_shape() and finishing_path()
FinishingRun plan_finishing(const FinishingRequest& request);

/// The path as points in the machine's frame with the field `feed`.
cloud::Cloud to_cloud(const FinishingRun& run);

} // namespace fettle::machining
