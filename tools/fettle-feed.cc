#include "belt/belt_plan.h"
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"

#include <limits>
#include <ostream>

using namespace fettle;

namespace {

/// NaN where the wheel is off the part.
void set_chosen(Cloud& cloud, const BeltPlan& plan)
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    Eigen::VectorXd force = Eigen::VectorXd::Constant(cloud.size(), kNone), depth = force, feed = force;
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
        const BeltPoint& point = plan.path[static_cast<std::size_t>(i)];
        if (!point.is_on()) continue;
        (point.pressing.by_force ? force : depth)[i] = point.pressing.amount;
        feed[i] = point.feed;
    }
    if (!force.array().isNaN().all()) set_field(cloud, "force", force, 8);
    if (!depth.array().isNaN().all()) set_field(cloud, "depth", depth, 8);
    set_field(cloud, "feed", feed, 8);
}

void report(json::Value& out, const BeltPlan& plan, double unit, double mm)
{
    out.set("points", plan.path.size())
        .set("touched", static_cast<std::size_t>(plan.touched))
        .set("reached", static_cast<std::size_t>(plan.reached))
        .set("constant", plan.constant / unit)
        .set("rms_before", plan.rms_before / mm)
        .set("rms_constant", plan.rms_constant / mm)
        .set("rms_planned", plan.rms_planned / mm)
        .set("ratio", plan.rms_planned / plan.rms_constant)
        .set("time_constant", plan.time_constant)
        .set("time_planned", plan.time_planned)
        .set("at_least", static_cast<std::size_t>(plan.at_least))
        .set("at_most", static_cast<std::size_t>(plan.at_most))
        .set("rounds", plan.rounds)
        .set("converged", plan.converged);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Choose the feed, or the force, at each contact point of a belt path, so that what the belt removes meets the "
        "allowance.\n"
        "A grinding simulation (fettle-belt) says what each point takes from each surfel; the best feeds or forces "
        "within the limits are a bounded least-squares problem, solved anew with the simulation of its answer until "
        "the error shrinks no more. Out: the path with force (or depth) and feed. Report: the error (rms over the "
        "surfels that the path reaches) before grinding, with the best constant, and as planned.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& path_file = t.input("PATH", "contact points with poses (fettle-path), PCD");
        const std::string& points = t.required_file("--on", "SURFELS", "Surfels with their displacement, PCD");
        const std::string& wheel_file = t.required_file("--wheel", "FILE", "The wheel, JSON");
        const std::string& vary = t.choice("--vary", "feed", {"feed", "force"}, "What is chosen");
        const double& least = t.number("--least", 1, "N or LENGTH/S", "Limit of what is chosen", Range::positive());
        const double& most = t.number("--most", 100, "N or LENGTH/S", "Limit of what is chosen", Range::positive());
        const auto& force = t.number_if_given("--force", "FORCE", "As of fettle-belt, N", Range::positive());
        const auto& depth = t.number_if_given("--depth", "LENGTH", "As of fettle-belt", Range::positive());
        const auto& feed = t.number_if_given("--feed", "LENGTH/S", "As of fettle-belt", Range::positive());
        const double& dwell = t.number("--dwell", 0, "S", "As of fettle-belt", Range::at_least(0));
        const double& worn = t.number("--worn", 0, "J", "As of fettle-belt", Range::at_least(0));
        const double& wanted = t.number("--wanted", 0, "LENGTH", "Displacement to be left", {});
        const auto& smoothness = t.number_if_given(
            "--smoothness", "LENGTH",
            "A change by the mean from a point to the next counts as this error of a surfel [0.01 mm]",
            Range::at_least(0));
        const int& rounds = t.count("--rounds", 8, "Simulations after that of the constant, at most", 1, 1000);
        const std::string& gridding = t.choice("--gridding", "kriging", {"kriging", "shepard"}, "As of fettle-contact");
        const int& cells = t.count("--cells", 24, "As of fettle-contact", 8, 512);
        const double& tolerance = t.number("--tolerance", 1e-4, "SHARE", "As of fettle-contact", {1e-9, 1e-2});
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-part parts/keel.json -o keel.stl && fettle-surfel keel.stl --stock keel.stl --spacing 1 "
                  "-o keel.pcd && fettle-feed paths/keel.pcd --on keel.pcd --wheel wheels/rubber.json --force 20 "
                  "--wanted -0.05 --report plan.json > planned.pcd",
                  "0.05 mm off the keel");
        t.reference("Ren et al. 2006, eq. 5; Moré & Toraldo 1991");
        t.parse();

        if (force && depth) throw InputError("--force", "and --depth: one of them says how the wheel is pressed on");
        if (least > most) throw InputError("--least", "is above --most");
        CloudFile path = read_cloud(path_file);
        const CloudFile file = read_cloud(points);
        const Surfels surfels = surfels_of(file.cloud, display_name(points));
        const ContactWheel wheel = read_contact_wheel(wheel_file);
        const double mm = path.units.mm(), unit = vary == "force" ? 1 : mm;
        const BeltSettings settings{force, depth ? std::optional(*depth * mm) : std::nullopt, feed ? *feed * mm : 20,
                                    dwell};
        BeltPlanOptions options;
        options.belt.press = {gridding == "shepard" ? Gridding::shepard : Gridding::kriging, cells, tolerance};
        options.belt.worn = worn * kJoule;
        options.by_force = vary == "force";
        options.least = least * unit;
        options.most = most * unit;
        options.wanted = wanted * mm;
        if (smoothness) options.smoothness = *smoothness * mm;
        options.rounds = rounds;
        const BeltPlan plan = named(display_name(path_file), [&] {
            return plan_belt(surfels, wheel, belt_path(path.cloud, settings), options, t.progress("planning"));
        });
        set_chosen(path.cloud, plan);
        report(t.report(), plan, unit, mm);
        write_pcd(t.output(), path.cloud, path.units, ascii ? PcdEncoding::ascii : PcdEncoding::binary);
        return Verdict::yes;
    });
}
