#pragma once

#include "job/job.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle {

/// What an error map says in numbers. Lengths mm, volumes mm³; NaN where there is nothing to count.
struct Statistics {
    Eigen::Index count = 0;     ///< points with an error: all the numbers rest on these
    Eigen::Index undefined = 0; ///< points without one
    double mean, mean_abs, rms;
    double sd; ///< about the mean, over all points (not n - 1): rms² = mean² + sd²
    double min, max;
    double band; ///< Wang 2007, eq. 4-1: max - min if they differ in sign, else the largest size
    /// Percentiles, interpolated linearly between the order statistics: the p-th lies at (n - 1) p.
    double p01, p05, p50, p95, p99;
    double within;           ///< share of the points with |error| <= tolerance; NaN without a tolerance
    double over_cut_volume;  ///< below the reference, positive
    double under_cut_volume; ///< material left
};

/// @param errors  mm; NaN: undefined
/// @param areas   of the points, mm², such that error · area is a volume; NaN or 0: the point adds none
/// @param tolerance  mm
Statistics statistics(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, std::optional<double> tolerance);

/// The part of a casting that a point belongs to, seen from above.
enum class Region {
    inside,  ///< B, the edge included
    around,  ///< S without B
    outside, ///< neither; all but B for a job without a sampling boundary
};

/// @param xyz  3xN, M; a NaN point is outside
std::vector<Region> regions(const Job& job, const Eigen::Matrix3Xd& xyz);

/// Statistics of the points of one region.
Statistics statistics(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, std::optional<double> tolerance,
                      const std::vector<Region>& regions, Region which);

/// Does a part pass? It does if at least one judged point has an error and none exceeds the tolerance, which is widened
/// by what the float coordinates of the files leave open.
struct Judgement {
    bool within = false;
    double worst = 0; ///< largest |error| judged, mm
};
Judgement judge(const Statistics& judged, double tolerance, const Eigen::Matrix3Xd& xyz);

/// The middle of the numbers that are not NaN; NaN if there are none.
double median(const Eigen::VectorXd& values);

/// The flat members of a report, in `units`.
json::Value to_json(const Statistics& statistics, const Units& units);

} // namespace fettle
