#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/direction.h"
#include "machining/finishing_run.h"
#include "machining/limits.h"
#include "machining/path_options.h"

#include <numbers>
#include <optional>

using namespace fettle;

namespace {

const std::string kDescription = "Plan a zig-zag finishing path over a design, as G-code.\n"
                                 "At every point the cutter comes down upright until it touches the design, a "
                                 "facet, an edge or a vertex. Lengths "
                                 "in mm, feeds in mm/s; the program is in mm, places are those of the tool tip.";

struct Options {
    cli::Tool& t;
    const std::string& design = t.main_input("DESIGN", "The design: STL, PLY, OBJ or OFF");
    const std::optional<units::Units::Length>& unit = t.length_unit("--file-units", "Unit of DESIGN, if it is not mm");
    const std::string& cutter =
        t.required_text("--cutter", "CUTTER", "ball:D, flat:D, bull:D,r or taper:D,halfangle_deg,r");
    const std::optional<double>& scallop =
        t.optional_number("--scallop", "MM", "Height of the ridges that may stand between passes, also on slopes",
                          machining::kLengthRange);
    const std::optional<double>& step_over = t.optional_number(
        "--step-over", "MM", "Distance between passes seen from above, instead of --scallop", machining::kLengthRange);
    const std::optional<double>& overhang = t.optional_number(
        "--overhang", "MM",
        "Length of the passes beyond the design's box; else as far as the tip is from the contact on slopes",
        machining::kLengthOrZeroRange);
    const double& angle = t.number("--angle", 0, "DEG", "Direction of the passes, counter-clockwise from X",
                                   core::Range::between(-360, 360));
    const std::string& axis = t.text("--axis", "0,0,1", "X,Y,Z", "Tool axis, from tip to holder (as in fettle-mill)");
    const double& feed = t.number("--feed", 10, "MM/S", "Feed", machining::kSpeedRange);
    const double& clearance =
        t.number("--clearance", 5, "MM", "Height of rapid moves over the highest point", machining::kLengthRange);
    const double& allowance =
        t.number("--allowance", 0, "MM", "Stock to be left everywhere, along Z", machining::kLengthOrZeroRange);
    const bool& pcd = t.flag("--pcd", "Write points with field feed (0: rapid) instead of G-code");
    const cloud::CloudOutput out{t, {"nc", "ngc", "gcode", "tap"}};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-part --without-anomaly parts/wang3.json | fettle-finish --file-units in --cutter ball:12 "
              "--scallop 0.05 > "
              "finish.nc",
              "passes over a convex sphere");
    t.reference(
        "Guan & Xiong (CL points that fettle-mill cuts along); contacts in closed form: machining/drop_cutter.cc");
}

machining::FinishingRequest finishing_request(const Options& o)
{
    if (o.scallop.has_value() == o.step_over.has_value())
        throw core::InputError("give either --scallop or --step-over");
    o.out.require(o.pcd, "points are written with --pcd, G-code without it");
    machining::FinishingRequest request{o.design,  o.unit,      {},         core::parse_direction(o.axis, "--axis"),
                                        o.scallop, o.step_over, o.overhang, {}};
    request.cutter = machining::parse_cutter_option(o.cutter);
    request.options.angle = o.angle * std::numbers::pi / 180;
    request.options.feed = o.feed;
    request.options.clearance = o.clearance;
    request.options.allowance = o.allowance;
    return request;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        add_usage(t);
        t.parse();

        const machining::FinishingRun run = machining::plan_finishing(finishing_request(o));
        for (const std::string& warning : run.warnings) t.warn(warning);
        if (o.pcd)
            o.out.write(machining::to_cloud(run), units::Units{});
        else
            machining::write_gcode(t.output(), run.path, "fettle-finish: " + o.cutter + ", tool tip");
        t.report()
            .set("points", run.path.size())
            .set("step_over", run.options.step_over)
            .set("overhang", run.options.overhang);
        return cli::Verdict::yes;
    });
}
