// What the feed of a run and its moves share. Not for other modules.

#pragma once

namespace fettle::strategy {

/// Feeds relative to the job's: near F_max, and where there is little to grind.
inline constexpr double kMinFeedShare = 0.5, kMaxFeedShare = 2;
/// Deceleration of drives that stop, mm/s²: a laboratory gantry with ball screws. A machine behind a driver does not
/// say its own.
inline constexpr double kDriveDeceleration = 1000;

/// @param feed  mm/s   @return  mm
inline double braking_distance(double feed) { return feed * feed / (2 * kDriveDeceleration); }

} // namespace fettle::strategy
