#pragma once

#include "core/spool.h"
#include "geometry/sum.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace fettle::geometry {

/// Statistics of an error map. Lengths mm, volumes mm³; NaN where no point counts.
struct Statistics {
    Eigen::Index count = 0;     ///< points with an error, on which all numbers are based
    Eigen::Index undefined = 0; ///< points without one
    double mean, mean_abs, rms;
    double sd; ///< about the mean, over all points (not n - 1): rms² = mean² + sd²
    double min, max;
    Eigen::Vector3d min_at, max_at; ///< points of the extremes, mm; the first of equal ones
    double band;                    ///< Wang 2007, eq. 4-1: max - min if they differ in sign, else the largest size
    /// Percentiles, interpolated linearly between the order statistics: the p-th lies at (n - 1) p.
    double p01, p05, p50, p95, p99;
    double within; ///< share of the points with |error| <= tolerance; NaN without a tolerance
    /// Area of the points below the reference by more than the tolerance (without one: below it), and above it
    /// likewise.
    double over_cut_area, under_cut_area; // mm²
    double over_cut_volume;               ///< volume below the reference, positive, mm³
    double under_cut_volume;              ///< volume of the material left above the reference, mm³
};

/// Accumulates the statistics of errors that arrive block by block.
class StatisticsAccumulator {
  public:
    /// @param tolerance  mm   @param memory  bytes of errors to hold in memory; the rest goes to a temporary file
    explicit StatisticsAccumulator(std::optional<double> tolerance,
                                   std::size_t memory = std::numeric_limits<std::size_t>::max());

    /// @param errors  mm; NaN: undefined
    /// @param areas   of the points, mm², such that error · area is a volume; NaN or 0: the point has none
    /// @param xyz     3xN, mm
    void add(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, const Eigen::Matrix3Xd& xyz);
    Statistics statistics() const;

  private:
    std::optional<double> tolerance_;
    core::Spool errors_; ///< defined errors, as doubles
    Eigen::Index undefined_ = 0;
    Eigen::Index within_ = 0;
    Statistics extremes_ = {}; ///< min, max and their points so far
    CompensatedSum sum_, sum_abs_, sum_squares_, over_cut_area_, under_cut_area_, over_cut_volume_, under_cut_volume_;
};

/// Median of the doubles in a spool, at least one; the mean of the two in the middle of an even count.
double median(const core::Spool& numbers);

/// Statistics of errors in memory; see StatisticsAccumulator::add() for the parameters.
Statistics statistics(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, std::optional<double> tolerance);

/// Histogram of errors in bins of equal width from -limit to limit.
struct Histogram {
    double limit = 1;                 ///< mm
    std::vector<std::size_t> counts;  ///< an error on the edge of two bins counts in the upper bin, `limit` in the last
    std::size_t below = 0, above = 0; ///< errors below -limit, above limit

    /// @param bins  at least 1
    Histogram(double limit_, int bins) : limit(limit_), counts(static_cast<std::size_t>(bins), 0) {}
    void add(const Eigen::VectorXd& errors);
};

} // namespace fettle::geometry
