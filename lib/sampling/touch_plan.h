#pragma once

#include "job/boundary.h"
#include "job/job.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle {

/// What a touch is for; the numbers are those of the field `role`.
enum class Role {
    anomaly_boundary = 0,
    near_anomaly = 1,
    near_sampling_boundary = 2,
    estimated = 3,
    ruling_line = 4,
    section_curve = 5
};

/// The `curve` of a touch that is on no line.
inline constexpr int kNoLine = -1;

/// Where to touch the part, in the order of the lines that the touches belong to.
struct TouchPlan {
    Eigen::Matrix2Xd xy;   ///< M, mm
    Eigen::VectorXd z;     ///< where the operator has touched already, mm; NaN elsewhere
    Eigen::VectorXi curve; ///< number of the line, from 0, or kNoLine
    Eigen::VectorXi role;  ///< as Role

    Eigen::Index size() const { return xy.cols(); }
};

/// Appends touches of one line. @param working  2xN, W, mm
void append_line(TouchPlan& plan, const Eigen::Matrix2Xd& working, double theta, int curve,
                 const std::vector<Role>& roles);

/// Chooses the touch points of a job as Wang 2007, 4.4.4 does: plan_plane, plan_swept or plan_freeform.
/// @throws InputError if the boundaries leave no room for them; the message asks for other boundary points
TouchPlan plan_touches(const Job& job);

/// Where a line crosses S and B on either side of the anomaly, parameters of the line: S, B, B, S.
using Crossings = Eigen::Vector4d;

/// The line origin + t · direction in the free area S \ B: on either side of the anomaly the outermost free point and
/// the one next to the anomaly. Non-convex polygons cross more often; the crossings between are left out.
/// Nothing if the line misses B, or if either side has no free stretch longer than `least`.
std::optional<Crossings> crossings_around(const Boundaries& boundaries, const Eigen::Vector2d& origin,
                                          const Eigen::Vector2d& direction, double least);

} // namespace fettle
