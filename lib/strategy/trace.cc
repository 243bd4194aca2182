#include "strategy/trace.h"

#include "cloud/cloud.h"
#include "cloud/fields.h"
#include "core/error.h"
#include "removal/wheel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::strategy {
namespace {

/// Distance of two positions of the wheel. Its rim leaves a ridge of step² / 8R between them: 0.0002 mm for 0.2 mm and
/// R = 25.4 mm.
constexpr double kReplayStepCells = 2;

constexpr const char* kTime = "t";
constexpr std::array<const char*, 7> kFields = {"layer", "pass", "event", "force", "feed", "peak_force", "deflection"};
constexpr const char* kRadius = "radius";

} // namespace

cloud::Cloud to_cloud(const std::vector<TraceRow>& trace)
{
    const Eigen::Index n = trace.size();
    cloud::Cloud cloud;
    cloud.xyz.resize(3, n);
    Eigen::MatrixXd rows(n, kFields.size() + 2);
    for (Eigen::Index i = 0; i < n; ++i) {
        const TraceRow& row = trace[i];
        cloud.xyz.col(i) = row.tool;
        rows.row(i) << row.time, row.layer, row.pass, int(row.event), row.force, row.feed, row.peak_force,
            row.deflection, row.radius;
    }
    cloud::set_field(cloud, kTime, rows.col(0), 8); // a float resolves a day's run to 8 ms only
    for (std::size_t k = 0; k < kFields.size(); ++k) cloud::set_field(cloud, kFields[k], rows.col(k + 1));
    cloud::set_field(cloud, kRadius, rows.rightCols(1), 8);
    return cloud;
}

std::vector<TraceRow> trace_from_cloud(const cloud::Cloud& cloud, const std::string& source)
{
    try {
        const Eigen::VectorXi layer = cloud::integer_field(cloud, "layer"), pass = cloud::integer_field(cloud, "pass"),
                              event = cloud::integer_field(cloud, "event");
        const Eigen::VectorXd time = cloud::field(cloud, kTime);
        std::vector<TraceRow> trace;
        for (Eigen::Index i = 0; i < cloud.size(); ++i) {
            if (event[i] < 0 || event[i] > int(Event::roughed))
                throw core::InputError("event " + std::to_string(event[i]) + " of point " + std::to_string(i + 1) +
                                       " is not an event of a trace");
            trace.push_back({.time = time[i],
                             .tool = cloud.xyz.col(i),
                             .layer = layer[i],
                             .pass = pass[i],
                             .event = Event(event[i])});
        }
        const auto take = [&](const char* name, double TraceRow::*to) {
            const Eigen::VectorXd values = cloud::field(cloud, name);
            for (std::size_t i = 0; i < trace.size(); ++i) trace[i].*to = values[i];
        };
        take("force", &TraceRow::force);
        take("feed", &TraceRow::feed);
        take("peak_force", &TraceRow::peak_force);
        take("deflection", &TraceRow::deflection);
        take(kRadius, &TraceRow::radius);
        return trace;
    } catch (const core::InputError& error) {
        throw core::InputError(source, error.what());
    }
}

removal::HeightField replay_removal(const std::vector<TraceRow>& trace, const job::Job& job, removal::HeightField stock)
{
    removal::WheelInStock wheel(stock, job.wheel.width);
    const Eigen::Matrix2d R_working_machine = job::rotation_working_machine(job.theta);
    for (std::size_t i = 1; i < trace.size(); ++i) {
        if (!(trace[i].feed > 0)) continue;
        const Eigen::Vector3d from = trace[i - 1].tool, motion = trace[i].tool - from;
        const int steps = std::max(1, int(std::ceil(motion.norm() / (kReplayStepCells * stock.cell))));
        const double radius = trace[i].radius > 0 ? trace[i].radius : job.wheel.radius;
        for (int n = 1; n <= steps; ++n) {
            const Eigen::Vector3d at = from + motion * (double(n) / steps);
            wheel.place(R_working_machine * at.head<2>(), radius, at.z());
            wheel.cut(at.z());
        }
    }
    return stock;
}

} // namespace fettle::strategy
