#include "strategy/trace.h"

#include "cloud/cloud.h"
#include "removal/wheel.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

/// Between two places of the wheel its rim leaves a ridge of step² / 8R: 0.0002 mm for 0.2 mm and R = 25.4 mm.
constexpr double kStep = 2; // cells

} // namespace

Cloud to_cloud(const std::vector<TraceRow>& trace)
{
    const Eigen::Index n = Eigen::Index(trace.size());
    Cloud cloud;
    cloud.xyz.resize(3, n);
    Eigen::MatrixXd rows(n, 6);
    for (Eigen::Index i = 0; i < n; ++i) {
        const TraceRow& row = trace[std::size_t(i)];
        cloud.xyz.col(i) = row.tool;
        rows.row(i) << row.time, row.layer, row.pass, int(row.event), row.force, row.feed;
    }
    set_field(cloud, "t", rows.col(0), 8); // a float resolves a day's run to 8 ms only
    const char* names[] = {"layer", "pass", "event", "force", "feed"};
    for (int k = 0; k < 5; ++k) set_field(cloud, names[k], rows.col(k + 1));
    return cloud;
}

HeightField ground_by(const std::vector<TraceRow>& trace, const Job& job, HeightField stock)
{
    WheelInStock wheel(stock, job.wheel.width);
    const Eigen::Matrix2d R_working_machine = rotation_working_machine(job.theta);
    for (std::size_t i = 1; i < trace.size(); ++i) {
        if (!(trace[i].feed > 0)) continue;
        const Eigen::Vector3d from = trace[i - 1].tool, way = trace[i].tool - from;
        const int steps = std::max(1, int(std::ceil(way.norm() / (kStep * stock.cell))));
        for (int n = 1; n <= steps; ++n) {
            const Eigen::Vector3d at = from + way * (double(n) / steps);
            wheel.place(R_working_machine * at.head<2>(), job.wheel.radius, at.z());
            wheel.cut(at.z());
        }
    }
    return stock;
}

} // namespace fettle
