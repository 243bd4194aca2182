// The planned alternative to the force-led strategy (Wang 2007, 5.1): all material that may lie above the desired
// surface is thought of as a prism over the whole anomaly, and ground off layer by layer, each covered once, whether
// there is metal or not. The force is not used.
//
// The plan is as bold as it can be. By the removal law a line of s (the step-over) at the feed v loses c F / (s v), so
// its layers are c F_max / (s v) apart: where the metal is whole, the head settles at F_max. At the end layer 1 is
// covered until it is within tolerance, as in the other strategy.

#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/error.h"
#include "core/file.h"
#include "gantry/quasi_static.h"
#include "job/boundary.h"
#include "plan/plan.h"
#include "removal/height_field.h"
#include "strategy/run.h"
#include "strategy/trace.h"

#include <cmath>
#include <ostream>

using namespace fettle;

namespace {

constexpr double kCellsPerWidth = 64; // as fettle-grind
// The force is not used.
constexpr double kNoForce = 1e6; // N
// One covering is enough, however much is left.
constexpr double kNoTolerance = 1e3; // mm
// Lines are read from a file: a step-over equal to their distance within rounding reaches the next one.
constexpr double kRelativeLineTolerance = 1e-6;

/// Distance of neighbouring layers, mm.
double layer_distance(const job::Job& job, double removal_factor)
{
    return job.removal_coefficient * removal_factor * job.force.max / (job.feed.step_over * job.feed.rate);
}

/// Largest height of the metal over the desired surface inside B, mm.
double highest_metal(const removal::HeightField& stock, const plan::Plan& plan)
{
    const job::Polygon anomaly = job::working_boundaries(plan.job).anomaly;
    const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(plan.job.theta).transpose();
    double highest = 0;
    for (Eigen::Index j = 0; j < stock.rows(); ++j)
        for (Eigen::Index i = 0; i < stock.columns(); ++i) {
            const Eigen::Vector2d at = stock.centre(i, j);
            if (!job::contains(anomaly, at)) continue;
            const double over = stock.z(i, j) - surface::height(plan.surface, R_machine_working * at);
            if (over > highest) highest = over;
        }
    return highest;
}

plan::Plan without_force(plan::Plan plan)
{
    plan.job.force.max = kNoForce;
    return plan;
}

/// One covering of the layer that lies `offset` over the desired surface, on lines a step-over apart: those that are
/// closer are for the finish of layer 1.
plan::Plan covering(plan::Plan plan, double offset)
{
    std::vector<plan::Pass> passes;
    for (std::size_t i = 0; i < plan.passes.size(); ++i)
        if (passes.empty() || i + 1 == plan.passes.size() ||
            plan.passes[i + 1].line > passes.back().line + plan.job.feed.step_over * (1 + kRelativeLineTolerance))
            passes.push_back(plan.passes[i]);
    plan.passes = passes;
    plan.surface.shift += offset;
    plan.job.tolerance = kNoTolerance;
    return plan;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Grind a prism over the anomaly away, without a look at the force.", [](cli::Tool& t) {
            const std::string& plan_file = t.main_input("PLAN", "What fettle-plan wrote");
            const std::string& stock_file = t.required_text("--stock", "PART", "The part as it is");
            const auto& tall = t.optional_number(
                "--height", "LENGTH", "Of the prism; default: of the metal that is there", core::Range::positive());
            const double& removal =
                t.number("--removal-factor", 1, "FACTOR", "As fettle-grind", core::Range::positive());
            const double& planned =
                t.number("--planned-factor", 1, "FACTOR", "Factor that the plan assumes", core::Range::positive());
            const std::string& trace_file = t.text("--trace", "", "FILE", "What the machine did, PCD");
            t.reference("Wang 2007, 5.1: the virtual stock");
            t.parse();

            const plan::Plan given = plan::read_plan(plan_file), plan = without_force(given);
            const units::Units& units = plan.job.units;
            const removal::HeightField stock =
                removal::stock_from_scan(sampling::read_scan(stock_file, plan.job, {}), plan.job,
                                         plan.job.wheel.width / kCellsPerWidth, stock_file);
            const double distance = layer_distance(given.job, planned);
            const double height = tall ? *tall * units.mm() : highest_metal(stock, plan);
            const int layers = std::max(1, int(std::ceil(height / distance)));

            gantry::QuasiStaticOptions options;
            options.removal_factor = removal;
            gantry::QuasiStaticGantry gantry(stock, plan.job, options);
            std::vector<strategy::TraceRow> trace;
            double peak = 0;
            int coverings = 0;
            for (int layer = layers; layer >= 1; --layer) {
                strategy::GrindRun run =
                    fettle::strategy::run(layer > 1 ? covering(plan, (layer - 1) * distance) : plan, gantry);
                if (!run.finished) throw core::InputError(plan_file, run.failure);
                for (strategy::TraceRow& row : run.trace) row.layer = layer;
                trace.insert(trace.end(), run.trace.begin(), run.trace.end());
                peak = std::max(peak, run.force.peak);
                coverings = run.counts.coverings;
            }
            if (!trace_file.empty())
                cloud::write_pcd(t.output_file(trace_file), strategy::to_cloud(trace), units,
                                 cloud::PcdEncoding::ascii);
            const gantry::GrindTotals& totals = gantry.totals();
            json::Value out;
            out.set("layers", layers)
                .set("layer_distance", distance / units.mm())
                .set("prism_height", height / units.mm())
                .set("coverings", coverings)
                .set("grinding_time", totals.grinding_time)
                .set("travel_time", totals.travel_time)
                .set("service_time", totals.service_time)
                .set("peak_force", peak / units.newton())
                .set("removed_volume", removal::volume_between(stock, gantry.stock()) / std::pow(units.mm(), 3));
            t.output() << out;
            return cli::Verdict::yes;
        });
}
