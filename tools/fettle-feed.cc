#include "belt/belt_options.h"
#include "belt/belt_report.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"

#include <optional>

using namespace fettle;

namespace {

constexpr double kMaxLength = 1e6; ///< mm, in or m: larger than any part
/// Range of forces and feeds, N, mm/s, in/s or m/s. Their inverses and squares neither overflow nor vanish.
constexpr core::Range kLimitRange{1e-9, 1e9};

const std::string kDescription =
    "Choose the feed, or the force, at each contact point of a belt path, so that what the belt removes meets the "
    "allowance.\n"
    "A grinding simulation (fettle-belt) says what each point takes from each surfel; the best feeds or forces "
    "within the limits are a bounded least-squares problem, solved anew with the simulation of its answer until "
    "the error shrinks no more, and with --lower and --upper on, until no larger share of the area comes within. "
    "Out: the path with force (or depth) and feed. Report: the error (rms over the "
    "surfels that the path reaches), and the share within of all, before grinding, with the best constant, and as "
    "planned.";

struct Options {
    cli::Tool& t;
    const std::string& path = t.main_input("PATH", "contact points with poses (fettle-path), PCD");
    const std::string& surfels = t.required_file_option("--on", "SURFELS", "Surfels with their displacement, PCD");
    const std::string& wheel = t.required_file_option("--wheel", "FILE", "The wheel, JSON");
    const bool& by_force = t.choice<bool>("--vary", {{"feed", false}, {"force", true}}, "What is chosen");
    const std::optional<double>& min =
        t.optional_number("--min", "N or LENGTH/S", "Lower limit of what is chosen [1 N or 1 mm/s]", kLimitRange);
    const std::optional<double>& max =
        t.optional_number("--max", "N or LENGTH/S", "Upper limit of what is chosen [100 N or 100 mm/s]", kLimitRange);
    const belt::GrindingOptions grinding{t};
    const double& target =
        t.number("--wanted", 0, "LENGTH", "Displacement to be left", core::Range::between(-kMaxLength, kMaxLength));
    const std::optional<double>& lower_error = t.optional_number(
        "--lower", "LENGTH", "With --upper: what is left from here …", core::Range::between(-kMaxLength, kMaxLength));
    const std::optional<double>& upper_error = t.optional_number(
        "--upper", "LENGTH", "… to here is within: as much of the area as can be, not the least error",
        core::Range::between(-kMaxLength, kMaxLength));
    const std::optional<double>& smoothness =
        t.optional_number("--smoothness", "LENGTH",
                          "A change by the mean from a point to the next counts as this error of a surfel [0.01 mm]",
                          core::Range::between(0, kMaxLength));
    const int& rounds = t.count("--rounds", 8, "Max. number of simulations after that of the constant", 1, 1000);
    const belt::ContactOptions contact{t, 24, 1e-4};
    const cloud::CloudOutput out{t};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-part parts/keel.json -o keel.stl && fettle-surfel keel.stl --stock keel.stl --spacing 1 "
              "-o keel.pcd && fettle-feed paths/keel.pcd --on keel.pcd --wheel wheels/rubber.json --force 20 "
              "--wanted -0.01 --report plan.json > planned.pcd",
              "0.01 mm off the keel");
    t.reference("Ren et al. 2006, eq. 5; Moré & Toraldo 1991; Holland & Welsch 1977 (share of the area)");
}

/// The options of the plan in mm; `mm`: the unit of the path in mm.
belt::BeltPlanOptions plan_options(const Options& o, double mm)
{
    const double unit = o.by_force ? 1 : mm;
    belt::BeltPlanOptions options;
    options.belt.contact = o.contact.values();
    options.belt.prior_work = o.grinding.prior_work();
    options.by_force = o.by_force;
    if (o.min) options.min = *o.min * unit;
    if (o.max) options.max = *o.max * unit;
    if (options.min > options.max) throw core::InputError("--min", "is above --max");
    options.target_displacement = o.target * mm;
    if (o.lower_error.has_value() != o.upper_error.has_value())
        throw core::InputError("--lower and --upper go together");
    if (o.lower_error) {
        if (!(*o.lower_error < *o.upper_error)) throw core::InputError("--lower", "is not below --upper");
        options.tolerance = {*o.lower_error * mm, *o.upper_error * mm};
    }
    if (o.smoothness) options.smoothness = *o.smoothness * mm;
    options.max_rounds = o.rounds;
    return options;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();
        o.contact.check();
        o.grinding.check();

        cloud::CloudFile path = cloud::read_cloud(o.path);
        const belt::Surfels surfels = belt::read_surfels(o.surfels).surfels;
        const belt::ContactWheel wheel = belt::read_contact_wheel(o.wheel);
        const double mm = path.units.mm();
        const belt::BeltPlanOptions options = plan_options(o, mm);
        const belt::BeltPlan plan = cli::with_error_prefix(core::display_name(o.path), [&] {
            return belt::plan_belt(surfels, wheel, belt::belt_path(path.cloud, o.grinding.settings(mm)), options,
                                   t.progress("planning"));
        });
        belt::set_plan(path.cloud, plan);
        t.report() = belt::to_json(plan, o.by_force, path.units);
        o.out.write(path.cloud, path.units);
        return cli::Verdict::yes;
    });
}
