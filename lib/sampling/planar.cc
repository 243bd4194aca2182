#include "sampling/planar.h"

#include "job/open_side.h"
#include "sampling/freeform.h"

namespace fettle::sampling {

namespace {
// Three points determine a plane without residuals that could reveal a bad touch; Wang 2007, table 4-2.
constexpr Eigen::Index kMinTouches = 4;
} // namespace

TouchPlan plan_plane(const job::Job& job)
{
    const Eigen::Index n = job.anomaly.cols();
    if (n < kMinTouches)
        throw core::InputError(job.source, "anomaly: " + std::to_string(n) +
                                               " boundary points, a plane needs at least " +
                                               std::to_string(kMinTouches) + ": touch " +
                                               std::to_string(kMinTouches - n) + " more around the anomaly");
    const std::vector<Eigen::Index> corners =
        job::corners_on_metal(job.anomaly.topRows<2>(), job.sampling.topRows<2>());
    const auto touches = Eigen::Index(corners.size());
    if (touches < kMinTouches)
        throw NoRoomError(job.source, "sampling: only " + std::to_string(touches) +
                                          " boundary points of the anomaly have room to touch beyond them, a plane "
                                          "needs " +
                                          std::to_string(kMinTouches) + ": widen the sampling boundary");
    TouchPlan plan;
    plan.xy = job.anomaly.topRows<2>()(Eigen::all, corners);
    plan.z = job.anomaly.row(2)(corners);
    plan.curve = Eigen::VectorXi::Zero(touches);
    plan.role = Eigen::VectorXi::Constant(touches, static_cast<int>(Role::anomaly_boundary));
    return plan;
}

} // namespace fettle::sampling
