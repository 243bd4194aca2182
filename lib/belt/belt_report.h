#pragma once

#include "belt/belt_grinding.h"
#include "belt/belt_plan.h"
#include "belt/press.h"
#include "cloud/cloud.h"
#include "units/units.h"
#include "json/document.h"

#include <string>

namespace fettle::belt {

/// Reports of fettle-contact, fettle-belt and fettle-feed, in `units`.
json::Value to_json(const WheelContact& press, const units::Units& units);
json::Value to_json(const BeltRun& run, const units::Units& units);
/// @param by_force  whether forces were planned, in N, not feeds
json::Value to_json(const BeltPlan& plan, bool by_force, const units::Units& units);

/// Warning where contacts near the wheel's sides were computed without them; empty: none were.
std::string edge_warning(Eigen::Index near_edge, const WheelContactOptions& options);

/// Warning with its remedy where ripples of the surfels may be left because the contact's grid does not resolve them;
/// empty: none. @param cells_per_side  of the grid
std::string coarse_grid_warning(const BeltRun& run, int cells_per_side);

/// Adds the contact and the removal at each point to a path: fields t, force, indentation, pressure, area and
/// removed_volume.
void set_trace(cloud::Cloud& path, const std::vector<BeltTrace>& trace);

/// Sets the field feed of a path to the points' feeds; NaN where the wheel is off the part.
void set_feeds(cloud::Cloud& path, const std::vector<BeltPoint>& points);

/// Adds planned fields to a path: force or depth, and feed; NaN where the wheel is off the part.
void set_plan(cloud::Cloud& path, const BeltPlan& plan);

} // namespace fettle::belt
