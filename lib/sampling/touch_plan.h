#pragma once

#include "job/boundary.h"
#include "job/job.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle::sampling {

/// Purpose of a touch; the numbers are the values of the field `role`.
enum class Role {
    anomaly_boundary = 0,
    near_anomaly = 1,
    near_sampling_boundary = 2,
    estimated = 3,
    ruling_line = 4,
    section_curve = 5
};

/// Value of `curve` for a touch that is on no line.
inline constexpr int kNoLine = -1;

/// Planned touches, ordered by the lines that they belong to.
struct TouchPlan {
    Eigen::Matrix2Xd xy;   ///< M, mm
    Eigen::VectorXd z;     ///< heights already measured by the operator, mm; NaN elsewhere
    Eigen::VectorXi curve; ///< number of the line, from 0, or kNoLine
    Eigen::VectorXi role;  ///< values of Role

    Eigen::Index size() const { return xy.cols(); }
};

/// Appends the touches of one line.
/// @param points  2xN, mm, in a frame that is M rotated by `theta`   @param roles  N
void append_line(TouchPlan& plan, const Eigen::Matrix2Xd& points, double theta, int curve,
                 const std::vector<Role>& roles);

/// Plans the touches of a job after Wang 2007, 4.4.4: plan_plane, plan_swept or plan_freeform.
/// @throws InputError if the boundaries leave no room for them; the message asks for other boundary points
TouchPlan plan_touches(const job::Job& job);

/// Points of the sampling boundary S that no touch is at: farther than the probe's accuracy from each, and from each
/// other, since the difference of two touches closer than that does not determine a slope.
/// @param touched  2xN, M, mm
/// @return columns of job.sampling
std::vector<Eigen::Index> untouched_sampling_points(const job::Job& job, const Eigen::Matrix2Xd& touched);

/// Appends the points of the sampling boundary {s_i} (Wang 2007, 3.3 and 4.4.4) that no touch is at, with the heights
/// that the operator has measured, as touches near the sampling boundary, on no line.
/// @throws InputError if the job has no sampling boundary
void append_sampling_boundary(TouchPlan& plan, const job::Job& job);

/// Crossings of a line with S and B on either side of the anomaly, as parameters t in the order S, B, B, S.
using Crossings = Eigen::Vector4d;

/// Crossings of the line origin + t · direction with the free area S \ B: on either side of the anomaly the outermost
/// free point and the one closest to the anomaly. Further crossings with non-convex polygons, in between, are left out.
/// @return  nothing if the line misses B or if either side has no free interval of at least `min_length`, mm
std::optional<Crossings> crossings_around(const job::Boundaries& boundaries, const Eigen::Vector2d& origin,
                                          const Eigen::Vector2d& direction, double min_length);

} // namespace fettle::sampling
