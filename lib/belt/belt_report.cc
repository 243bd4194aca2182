#include "belt/belt_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::belt {

json::Value to_json(const WheelContact& press, const units::Units& units)
{
    const double mm = units.mm(), newton = units.newton();
    const Contact& contact = press.contact;
    json::Value report;
    return report.set("force", contact.force / newton)
        .set("peak_pressure", contact.pressure.maxCoeff() * mm * mm / newton)
        .set("indentation", contact.indentation / mm)
        .set("area", press.area() / (mm * mm))
        .set("cell", Eigen::VectorXd(press.grid.cell_size / mm))
        .set("iterations", contact.iterations)
        .set("near_edge", press.is_near_edge);
}

json::Value to_json(const BeltRun& run, const units::Units& units)
{
    const double mm = units.mm(), newton = units.newton();
    double force = 0, peak = 0, area = 0;
    for (const BeltTrace& at : run.trace)
        if (!std::isnan(at.force)) {
            force = std::max(force, at.force);
            peak = std::max(peak, at.peak_pressure);
            area = std::max(area, at.area);
        }
    json::Value report;
    return report.set("points", run.trace.size())
        .set("time", run.trace.empty() ? 0 : run.trace.back().time)
        .set("removed_volume", run.removed_volume / (mm * mm * mm))
        .set("work", run.work / kNewtonMmPerJoule)
        .set("touched", (run.removed.array() > 0).count())
        .set("surfels", run.removed.size())
        .set("deepest", run.removed.maxCoeff() / mm)
        .set("max_force", force / newton)
        .set("peak_pressure", peak * mm * mm / newton)
        .set("max_area", area / (mm * mm))
        .set("near_edge", run.near_edge)
        .set("coarse_grids", run.coarse_grids);
}

json::Value to_json(const BeltPlan& plan, bool by_force, const units::Units& units)
{
    const double mm = units.mm();
    json::Value report;
    report.set("points", plan.path.size())
        .set("touched", plan.touched)
        .set("reached", plan.reached)
        .set("constant", plan.constant / (by_force ? units.newton() : mm))
        .set("rms_before", plan.rms_before / mm)
        .set("rms_constant", plan.rms_constant / mm)
        .set("rms_planned", plan.rms_planned / mm)
        .set("ratio", plan.rms_planned / plan.rms_constant);
    if (plan.within)
        report.set("within_before", plan.within->before)
            .set("within_constant", plan.within->constant)
            .set("within_planned", plan.within->planned);
    return report.set("time_constant", plan.time_constant)
        .set("time_planned", plan.time_planned)
        .set("at_min", plan.at_min)
        .set("at_max", plan.at_max)
        .set("rounds", plan.rounds)
        .set("converged", plan.converged);
}

std::string edge_warning(Eigen::Index near_edge, const WheelContactOptions& options)
{
    if (near_edge == 0 || options.solver == LayerSolver::fem || options.cells_per_side <= kMaxEdgeCells) return "";
    return std::to_string(near_edge) +
           " contacts are nearer to the wheel's edge than 1.5 thicknesses of its layer, where "
           "it is softer than computed; --solver fem and up to " +
           std::to_string(kMaxEdgeCells) + " --cells see the edge";
}

std::string coarse_grid_warning(const BeltRun& run, int cells_per_side)
{
    if (run.coarse_grids == 0) return "";
    const int enough = static_cast<int>(std::ceil(cells_per_side * run.max_cell_spacings / kMaxCellSpacings));
    return std::to_string(run.coarse_grids) +
           " contacts have cells larger than the surfels are apart: ripples from surfel to surfel may stay or "
           "arise; --cells " +
           std::to_string(enough) + " grinds them off, or take fewer surfels";
}

void set_trace(cloud::Cloud& path, const std::vector<BeltTrace>& trace)
{
    const auto add = [&](const char* name, double BeltTrace::*member) {
        Eigen::VectorXd values(path.size());
        for (Eigen::Index i = 0; i < path.size(); ++i) values[i] = trace[i].*member;
        cloud::set_field(path, name, values, 8);
    };
    add("t", &BeltTrace::time);
    add("force", &BeltTrace::force);
    add("indentation", &BeltTrace::indentation);
    add("pressure", &BeltTrace::peak_pressure);
    add("area", &BeltTrace::area);
    add("removed_volume", &BeltTrace::removed_volume);
}

void set_feeds(cloud::Cloud& path, const std::vector<BeltPoint>& points)
{
    Eigen::VectorXd feed(path.size());
    for (Eigen::Index i = 0; i < path.size(); ++i)
        feed[i] = points[i].is_on_part() ? points[i].feed : std::numeric_limits<double>::quiet_NaN();
    cloud::set_field(path, "feed", feed, 8);
}

void set_plan(cloud::Cloud& path, const BeltPlan& plan)
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    Eigen::VectorXd force = Eigen::VectorXd::Constant(path.size(), kNone), depth = force;
    for (Eigen::Index i = 0; i < path.size(); ++i) {
        const BeltPoint& point = plan.path[i];
        if (!point.is_on_part()) continue;
        (point.load.by_force ? force : depth)[i] = point.load.value;
    }
    if (!force.array().isNaN().all()) cloud::set_field(path, "force", force, 8);
    if (!depth.array().isNaN().all()) cloud::set_field(path, "depth", depth, 8);
    set_feeds(path, plan.path);
}

} // namespace fettle::belt
