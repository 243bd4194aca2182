#include "strategy/trace.h"

#include "cloud/cloud.h"
#include "cloud/fields.h"
#include "core/error.h"
#include "removal/wheel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle {
namespace {

/// Between two places of the wheel its rim leaves a ridge of step² / 8R: 0.0002 mm for 0.2 mm and R = 25.4 mm.
constexpr double kStep = 2; // cells

constexpr const char* kTime = "t";
constexpr std::array<const char*, 7> kFields = {"layer", "pass", "event", "force", "feed", "peak_force", "deflection"};
constexpr const char* kRadius = "radius";

} // namespace

TraceRow row_of(const GantryStatus& status, double radius, double feed)
{
    return {.time = status.time,
            .tool = status.commanded + status.deflection * Eigen::Vector3d::UnitZ(),
            .force = status.force,
            .feed = feed,
            .peak_force = status.peak_force,
            .deflection = status.deflection,
            .radius = radius};
}

GantryStatus status_of(const TraceRow& row)
{
    return {row.time, row.tool - row.deflection * Eigen::Vector3d::UnitZ(), row.deflection, row.force, row.peak_force};
}

Cloud to_cloud(const std::vector<TraceRow>& trace)
{
    const Eigen::Index n = Eigen::Index(trace.size());
    Cloud cloud;
    cloud.xyz.resize(3, n);
    Eigen::MatrixXd rows(n, kFields.size() + 2);
    for (Eigen::Index i = 0; i < n; ++i) {
        const TraceRow& row = trace[std::size_t(i)];
        cloud.xyz.col(i) = row.tool;
        rows.row(i) << row.time, row.layer, row.pass, int(row.event), row.force, row.feed, row.peak_force,
            row.deflection, row.radius;
    }
    set_field(cloud, kTime, rows.col(0), 8); // a float resolves a day's run to 8 ms only
    for (std::size_t k = 0; k < kFields.size(); ++k) set_field(cloud, kFields[k], rows.col(Eigen::Index(k) + 1));
    set_field(cloud, kRadius, rows.rightCols(1), 8);
    return cloud;
}

std::vector<TraceRow> trace_of(const Cloud& cloud, const std::string& source)
{
    try {
        const Eigen::VectorXi layer = whole_numbers(cloud, "layer"), pass = whole_numbers(cloud, "pass"),
                              event = whole_numbers(cloud, "event");
        const Eigen::VectorXd time = field(cloud, kTime);
        std::vector<TraceRow> trace;
        for (Eigen::Index i = 0; i < cloud.size(); ++i) {
            if (event[i] < 0 || event[i] > int(Event::begun))
                throw InputError("event " + std::to_string(event[i]) + " of point " + std::to_string(i + 1) +
                                 " is none of a trace");
            trace.push_back({.time = time[i],
                             .tool = cloud.xyz.col(i),
                             .layer = layer[i],
                             .pass = pass[i],
                             .event = Event(event[i])});
        }
        const auto take = [&](const char* name, double TraceRow::*to) {
            const Eigen::VectorXd values = field(cloud, name);
            for (std::size_t i = 0; i < trace.size(); ++i) trace[i].*to = values[Eigen::Index(i)];
        };
        take("force", &TraceRow::force);
        take("feed", &TraceRow::feed);
        take("peak_force", &TraceRow::peak_force);
        take("deflection", &TraceRow::deflection);
        take(kRadius, &TraceRow::radius);
        return trace;
    } catch (const InputError& error) {
        throw InputError(source, error.what());
    }
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
