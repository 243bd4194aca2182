#include "sampling/planar.h"

#include "core/error.h"

namespace fettle {

namespace {
// Three points fix a plane with nothing left to tell a bad touch; Wang 2007, table 4-2.
constexpr Eigen::Index kLeastTouches = 4;
} // namespace

TouchPlan plan_plane(const Job& job)
{
    const Eigen::Index n = job.anomaly.cols();
    if (n < kLeastTouches)
        throw InputError(job.source, "anomaly: " + std::to_string(n) + " boundary points, a plane needs at least " +
                                         std::to_string(kLeastTouches) + ": touch " +
                                         std::to_string(kLeastTouches - n) + " more around the anomaly");
    TouchPlan plan;
    plan.xy = job.anomaly.topRows<2>();
    plan.z = job.anomaly.row(2);
    plan.curve = Eigen::VectorXi::Zero(n);
    plan.role = Eigen::VectorXi::Constant(n, static_cast<int>(Role::anomaly_boundary));
    return plan;
}

} // namespace fettle
