#pragma once

#include "compare/sum.h"
#include "core/spool.h"
#include "job/job.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
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
    Eigen::Vector3d min_at, max_at; ///< where they are, mm; of equal ones the first
    double band;                    ///< Wang 2007, eq. 4-1: max - min if they differ in sign, else the largest size
    /// Percentiles, interpolated linearly between the order statistics: the p-th lies at (n - 1) p.
    double p01, p05, p50, p95, p99;
    double within; ///< share of the points with |error| <= tolerance; NaN without a tolerance
    /// Of the points further below the reference than the tolerance (without one: below it), and of those as far above.
    double over_cut_area, under_cut_area; // mm²
    double over_cut_volume;               ///< below the reference, positive, mm³
    double under_cut_volume;              ///< material left
};

/// Collects errors that come block by block.
class Tally {
  public:
    /// @param tolerance  mm   @param memory  bytes of errors that may be held; more go to a temporary file
    explicit Tally(std::optional<double> tolerance, std::size_t memory = std::numeric_limits<std::size_t>::max());

    /// @param errors  mm; NaN: undefined
    /// @param areas   of the points, mm², such that error · area is a volume; NaN or 0: the point adds none
    /// @param xyz     3xN, mm
    void add(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, const Eigen::Matrix3Xd& xyz);
    Statistics statistics() const;

  private:
    std::optional<double> tolerance_;
    Spool errors_; ///< the defined ones, doubles
    Eigen::Index undefined_ = 0;
    Eigen::Index within_ = 0;
    Statistics so_far_ = {}; ///< extremes
    Sum sum_, sum_abs_, sum_squares_, over_cut_area_, under_cut_area_, over_cut_volume_, under_cut_volume_;
};

/// The middle of the doubles in a spool, of which there is at least one.
double median(const Spool& numbers);

/// Of errors in memory, as Tally.
Statistics statistics(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, std::optional<double> tolerance);

/// How many errors lie where.
struct Histogram {
    double limit = 1;                 ///< the bins are of equal width from -limit to limit, mm
    std::vector<std::size_t> counts;  ///< an error on the edge of two bins counts in the upper one, limit in the last
    std::size_t below = 0, above = 0; ///< errors beyond

    /// @param bins  at least 1
    Histogram(double limit_, int bins) : limit(limit_), counts(static_cast<std::size_t>(bins), 0) {}
    void add(const Eigen::VectorXd& errors);
};

/// The part of a casting that a point belongs to, seen from above.
enum class Region {
    inside,  ///< B, the edge included
    around,  ///< S without B
    outside, ///< neither; all but B for a job without a sampling boundary
};

/// @param xyz  3xN, M; a NaN point is outside
std::vector<Region> regions(const Job& job, const Eigen::Matrix3Xd& xyz);

/// Does a part pass? It does if at least one judged point has an error and none exceeds the tolerance, which is widened
/// by what the float coordinates of the files leave open.
struct Judgement {
    bool within = false;
    double worst = 0; ///< largest |error| judged, mm
};
/// @param largest  coordinate of the points, mm
Judgement judge(const Statistics& judged, double tolerance, double largest);

} // namespace fettle
