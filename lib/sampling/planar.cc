#include "sampling/planar.h"

#include "core/error.h"

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
    TouchPlan plan;
    plan.xy = job.anomaly.topRows<2>();
    plan.z = job.anomaly.row(2);
    plan.curve = Eigen::VectorXi::Zero(n);
    plan.role = Eigen::VectorXi::Constant(n, static_cast<int>(Role::anomaly_boundary));
    return plan;
}

} // namespace fettle::sampling
