#pragma once

#include "cloud/cloud.h"
#include "merge/registration.h"

namespace fettle::merge {

/// One cloud of all registered scans, in the world. Of the points in each cube with an edge of `spacing` the one
/// nearest to their mean is kept, and moved along its normal to the mean of the scans that see the place, each weighted
/// by 1/noise²: with k equal scans the noise falls as 1/√k. Where no scan has a point there is none. Fields: normal_x,
/// normal_y, normal_z, if the outer side is known of any scan; `scans`, the number of scans that see the place;
/// `disagreement`, root mean square of their heights about the mean, mm, NaN where one scan sees it alone.
/// @param spacing  of the finest scan, mm   @param reach  no point of another scan lies farther across the normal, mm
cloud::Cloud merge_points(const Scans& scans, const Registration& registration, double spacing, double reach);

} // namespace fettle::merge
