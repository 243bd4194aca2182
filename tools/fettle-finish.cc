#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/direction.h"
#include "core/file.h"
#include "machining/cutter.h"
#include "machining/discretization.h"
#include "machining/finishing.h"
#include "machining/tilt.h"
#include "mesh/mesh_file.h"

#include <numbers>
#include <ostream>

using namespace fettle;

int main(int argc, char** argv)
{
    const std::string description = "Plans a zig-zag finishing path over a design, as G-code.\n"
                                    "At every point the cutter comes down upright until it touches the design, a "
                                    "facet, an edge or a vertex. Lengths "
                                    "in mm, feeds in mm/s; the program is in mm, places are those of the tool tip.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& path = t.input("DESIGN", "The design: STL, PLY, OBJ or OFF");
        const auto& unit = t.length_unit("--file-units", "Unit of DESIGN, if it is not mm");
        const std::string& cutter_text =
            t.required_text("--cutter", "CUTTER", "ball:D, flat:D, bull:D,r or taper:D,halfangle_deg,r");
        const auto& scallop = t.number_if_given(
            "--scallop", "MM", "Height of the ridges that may stand between passes, also on slopes", Range::positive());
        const auto& step_over =
            t.number_if_given("--step-over", "MM", "Instead: between passes, seen from above", Range::positive());
        const auto& overhang = t.number_if_given(
            "--overhang", "MM",
            "Of the passes beyond the design's box; else as far as the tip is from the contact on slopes",
            Range::at_least(0));
        const double& angle = t.number("--angle", 0, "DEG", "Of the passes, counter-clockwise from X");
        const std::string& axis_text =
            t.text("--axis", "0,0,1", "X,Y,Z", "Of the tool, from tip to holder (fettle-mill)");
        const double& feed = t.number("--feed", 10, "MM/S", "Feed", Range::positive());
        const double& clearance =
            t.number("--clearance", 5, "MM", "Of rapid moves over the highest point", Range::positive());
        const double& allowance = t.number("--allowance", 0, "MM", "To be left everywhere along Z", Range::at_least(0));
        const bool& pcd = t.flag("--pcd", "Write points with field feed (0: rapid) instead of G-code");
        const bool& ascii = t.flag("--ascii", "With --pcd: as text");
        t.example("fettle-part --without-anomaly parts/wang3.json | fettle-finish --file-units in --cutter ball:12 "
                  "--scallop 0.05 > "
                  "finish.nc",
                  "passes over a convex sphere");
        t.reference(
            "Guan & Xiong (CL points that fettle-mill cuts along); contacts in closed form: machining/drop_cutter.cc");
        t.parse();

        if (scallop.has_value() == step_over.has_value()) throw InputError("give either --scallop or --step-over");
        if (ascii && !pcd) throw InputError("--ascii", "belongs to --pcd");
        const Cutter cutter = named("--cutter", [&] { return parse_cutter(cutter_text); });
        const Eigen::Matrix3d R_tilted_machine = rotation_tilted_machine(parse_direction(axis_text, "--axis"));
        const Mesh design = turned(read_mesh(path, unit.value_or(Units::Length::mm)), R_tilted_machine);
        FinishingOptions options;
        options.angle = angle * std::numbers::pi / 180;
        options.feed = feed;
        options.clearance = clearance;
        options.allowance = allowance;
        const auto points = named(display_name(path), [&] {
            const DesignShape shape = shape_of(design);
            options.step_over = step_over ? *step_over : step_over_for(*scallop, cutter, shape);
            options.overhang = overhang ? *overhang : overhang_for(cutter, shape);
            return finishing_path(design, cutter, options);
        });
        if (pcd)
            write_pcd(t.output(), turned(to_cloud(points), R_tilted_machine.transpose()), Units{},
                      ascii ? PcdEncoding::ascii : PcdEncoding::binary);
        else
            write_gcode(t.output(), points, "fettle-finish: " + cutter_text + ", tool tip");
        t.report().set("points", points.size()).set("step_over", options.step_over).set("overhang", options.overhang);
        return Verdict::yes;
    });
}
