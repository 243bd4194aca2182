// fettle-grind for the budget of errors: a machine whose following error, whose transducer and whose wheel can be
// perfect.

#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "gantry/dynamic.h"
#include "gantry/quasi_static.h"
#include "plan/plan.h"
#include "removal/height_field.h"
#include "strategy/run.h"

#include <cmath>
#include <memory>
#include <ostream>
#include <random>

using namespace fettle;

namespace {

constexpr double kCell = 0.1; // mm
// No wheel is lost.
constexpr double kNoWear = 1e9;
// Steps of a perfect transducer, mm.
constexpr double kPerfect = 1e-7;

/// The head's transducer between a machine and the strategy: resolution, noise, and a zero that is not quite right.
class Transducer final : public gantry::Gantry {
  public:
    Transducer(gantry::Gantry& machine, const gantry::Head& head, double offset, const job::ForceRange& force,
               std::uint64_t seed)
        : machine_(machine), head_(head), force_(force), random_(seed)
    {
        offset_ = offset * normal_(random_);
        read(machine_.status());
    }
    gantry::GantryStatus travel(const Eigen::Vector3d& tool_point) override
    {
        return read(machine_.travel(tool_point));
    }
    gantry::GantryStatus travel_low(const Eigen::Vector3d& tool_point, double over, double free) override
    {
        return read(machine_.travel_low(tool_point, over, free));
    }
    gantry::GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override
    {
        return read(machine_.grind(tool_point, feed));
    }
    gantry::GantryStatus lift(double commanded_z) override { return read(machine_.lift(commanded_z)); }
    double touch_off() override
    {
        const double radius = machine_.touch_off();
        read(machine_.status());
        return radius;
    }
    void change_wheel() override
    {
        machine_.change_wheel();
        read(machine_.status());
    }
    double probe(const Eigen::Vector2d& xy, double lowest) override
    {
        const double z = machine_.probe(xy, lowest);
        read(machine_.status());
        return z;
    }
    gantry::GantryStatus status() const override { return last_; }

  private:
    gantry::GantryStatus read(gantry::GantryStatus status)
    {
        const double analog = status.deflection + offset_ + head_.noise * normal_(random_);
        status.deflection = std::max(0.0, std::round(analog / head_.lvdt) * head_.lvdt);
        status.force = status.deflection > 0 ? force_.preload + force_.stiffness * status.deflection : 0;
        last_ = status;
        return status;
    }

    gantry::Gantry& machine_;
    gantry::Head head_;
    job::ForceRange force_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    double offset_ = 0;
    gantry::GantryStatus last_;
};

std::unique_ptr<gantry::VirtualGantry> simulated_gantry(const removal::HeightField& stock, const job::Job& job,
                                                        gantry::Machine machine, bool following, bool wear)
{
    machine.head.noise = 0;
    machine.head.lvdt = kPerfect;
    if (following) {
        gantry::DynamicOptions options;
        if (!wear) options.grinding_ratio = kNoWear;
        return std::make_unique<gantry::DynamicGantry>(stock, job, machine, options);
    }
    gantry::QuasiStaticOptions options;
    if (!wear) options.grinding_ratio = kNoWear;
    return std::make_unique<gantry::QuasiStaticGantry>(stock, job, options);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Grind with chosen errors of the machine.", [](cli::Tool& t) {
        const std::string& plan_file = t.main_input("PLAN", "What fettle-plan wrote");
        const std::string& stock_file = t.required_text("--stock", "PART", "The part as it is");
        const std::string& machine_file = t.required_text("--machine", "FILE", "The machine");
        const bool& following = t.flag("--following", "The drives follow as those of the machine");
        const bool& lvdt = t.flag("--lvdt", "The transducer is that of the machine");
        const double& offset =
            t.number("--lvdt-offset", 0, "MM", "Of its zero, standard deviation", core::Range::at_least(0));
        const bool& wear = t.flag("--wear", "The wheel wears");
        t.reference("Wang 2007, 6.2: sources of error 5, 6 and 9");
        t.parse();

        const plan::Plan plan = plan::read_plan(plan_file);
        const units::Units& units = plan.job.units;
        const removal::HeightField stock =
            removal::stock_from_scan(sampling::read_scan(stock_file, plan.job, {}), plan.job, kCell, stock_file);
        const gantry::Machine machine = gantry::read_machine(machine_file);
        const auto simulated = simulated_gantry(stock, plan.job, machine, following, wear);
        Transducer transducer(*simulated, machine.head, offset, plan.job.force, t.seed());
        const strategy::GrindRun run = fettle::strategy::run(plan, lvdt ? static_cast<gantry::Gantry&>(transducer)
                                                                        : static_cast<gantry::Gantry&>(*simulated));
        cloud::write_pcd(t.output(), removal::to_cloud(stock, simulated->stock()), units);
        t.report()
            .set("finished", run.finished)
            .set("machine_time", simulated->status().time)
            .set("coverings", run.counts.coverings)
            .set("peak_force", run.force.peak / units.newton());
        if (!run.finished) t.warn(plan_file + ": " + run.failure);
        return run.finished ? cli::Verdict::yes : cli::Verdict::no;
    });
}
