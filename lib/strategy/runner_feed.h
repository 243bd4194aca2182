// Shared by the feed of a run and its moves. It is private to this module.

#pragma once

namespace fettle::strategy {

/// Feeds relative to the job's: the lower one near F_max, the higher one where there is little to grind.
inline constexpr double kMinFeedShare = 0.5, kMaxFeedShare = 2;
/// Deceleration of drives that stop, mm/s²: a laboratory gantry with ball screws. A machine behind a driver does not
/// say its own.
inline constexpr double kDriveDeceleration = 1000;

/// @param feed  mm/s   @return  mm
inline double braking_distance(double feed) { return feed * feed / (2 * kDriveDeceleration); }

} // namespace fettle::strategy
