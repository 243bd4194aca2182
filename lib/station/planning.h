#pragma once

#include "cloud/pcd.h"
#include "gantry/gantry.h"
#include "gantry/touch_job.h"
#include "plan/plan.h"
#include "station/folder.h"
#include "station/record.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fettle::station {

/// Names of the files in a session's folder: those of the tools.
inline constexpr const char* kRecordFile = "session.json";
inline constexpr const char* kJobFile = "job.json";
inline constexpr const char* kSamplesFile = "samples.pcd";
inline constexpr const char* kSurfaceFile = "surface.json";
inline constexpr const char* kPlanFile = "plan.json";
inline constexpr const char* kPageFile = "page.html";
inline constexpr const char* kTraceFile = "trace.pcd";
inline constexpr const char* kGroundFile = "ground.pcd";

struct PlanningOptions {
    gantry::TouchStrategy touches = gantry::TouchStrategy::extended;
    double confidence = 0.99; ///< of the margin
    std::uint64_t seed = 1;   ///< of the margin's draws
    cloud::PcdEncoding encoding = cloud::PcdEncoding::binary;
};

/// Touches the surface of the record's job, as fettle-sample does, and saves the samples. What the record holds is not
/// touched again.
/// @param touched  called after each touch   @return  warnings
/// @throws GantryFault, Interrupted, InputError for places without a surface
std::vector<std::string> touch_surface(const Record& record, gantry::Gantry& machine, const Folder& folder,
                                       const PlanningOptions& options,
                                       const std::function<void(const Eigen::Vector3d&)>& touched);

/// Fits the desired surface to the saved samples, raises it by its margin, and plans, as fettle-fit, fettle-margin and
/// fettle-plan do; saves surface, plan and a page about both. Warnings are added to `warnings`.
/// @throws InputError if the touches do not determine a surface, or the wheel does not fit
plan::Plan plan_job(const job::Job& job, const Folder& folder, const PlanningOptions& options,
                    std::vector<std::string>& warnings);

} // namespace fettle::station
