#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/direction.h"
#include "core/file.h"
#include "core/text.h"
#include "machining/cutter.h"
#include "machining/discretization.h"
#include "machining/milling.h"
#include "machining/milling_summary.h"
#include "machining/number_list.h"
#include "machining/refinement.h"
#include "machining/tilt.h"
#include "machining/tool_path.h"
#include "machining/workpiece.h"
#include "mesh/mesh_file.h"
#include "mesh/shape_file.h"
#include "sampling/scan.h"

#include <ostream>

using namespace fettle;

namespace {

Holder parse_holder(const std::string& text)
{
    const auto numbers = numbers_of(text, {"the diameter", "the height over the tip"});
    if (!(numbers[0] > 0 && numbers[1] > 0)) throw InputError("both must be positive, got " + text);
    return {numbers[0] / 2, numbers[1]};
}

Workpiece read_stock(const std::string& stock, std::optional<Units::Length> unit, double cell,
                     const Eigen::Matrix3d& R_tilted_machine)
{
    constexpr std::string_view kBox = "box:";
    return named("--stock", [&] {
        if (!stock.starts_with(kBox)) {
            const Units::Length length = unit.value_or(Units::Length::mm);
            return std::visit(
                [&](auto shape) { return scanned_workpiece(Scan(turned(std::move(shape), R_tilted_machine)), cell); },
                read_shape(stock, Units{length}).shape);
        }
        if (unit) throw InputError("a box is in mm; --stock-units belongs to a file");
        return box_workpiece(stock.substr(kBox.size()), cell, R_tilted_machine);
    });
}

void report(json::Value& out, const NcProgram& program, const HeightField& left)
{
    json::Value words;
    for (const auto& [word, count] : program.without_motion) words.set(word, count);
    out.set("moves", program.moves.size())
        .set("unplaced_rapids", program.unplaced.size())
        .set("chorded_arcs", program.chorded)
        .set("arc_chord_error", kArcChord)
        .set("words_without_motion", words)
        .set("columns", static_cast<int>(left.columns()))
        .set("rows", static_cast<int>(left.rows()))
        .set("step", left.cell)
        .set("cells_without_material", static_cast<double>(left.z.isNaN().count()));
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Machines a stock virtually: cuts a map of heights with a cutter along a path of three axes, upright or "
        "tilted.\n"
        "Every cell's centre comes to the lowest height at which the cutter passes over it, computed from whole moves. "
        "Lengths in mm, feeds in mm/s; a program states its own (F in length a minute). Exit 1 if a rapid move went "
        "through material or the holder collides.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& path = t.input(
            "PATH",
            "Points of the tool tip with, if they vary, feeds (field feed, 0: rapid), PCD; or a program, G-code");
        const std::string& stock =
            t.required_file("--stock", "STOCK", "box:x0,y0,z0,x1,y1,z1, or STL, PLY, OBJ or PCD");
        const auto& stock_units = t.length_unit("--stock-units", "Unit of the stock's file, if it is not mm");
        const std::string& cutter_text =
            t.required_text("--cutter", "CUTTER",
                            "ball:D, flat:D, bull:D,r or taper:D,halfangle_deg,r: diameter, radius of corner or tip");
        const auto& step = t.number_if_given("--step", "MM", "Side of a cell", Range::positive());
        const auto& tolerance = t.number_if_given(
            "--tolerance", "MM", "Instead of --step: cells so small that errors of the grid are within it",
            Range::positive());
        const std::string& design = t.other_file(
            "--design", "FILE", "With --tolerance: the design, whose curvatures and slopes count; else a plane");
        const auto& design_units = t.length_unit("--design-units", "Unit of the design, if it is not mm");
        const bool& published = t.flag("--as-published", "With --tolerance: without regard to slopes");
        const std::string& points = t.choice(
            "--points", "cl", {"cl", "cc"}, "Are points those of the tip, or where the cutter touches (with normals)?");
        const std::string& axis_text = t.text("--axis", "0,0,1", "X,Y,Z",
                                              "Of the tool, from tip to holder (3+2 axes); a program is then in the "
                                              "frame that is turned the shortest way so that this points up");
        const double& feed = t.number("--feed", 10, "MM/S", "Feed of points without one", Range::positive());
        const double& rapid = t.number("--rapid", 200, "MM/S", "Rate of rapid moves", Range::positive());
        const std::string& holder = t.text("--holder", "", "D,HEIGHT",
                                           "A cylinder above the cutter, this high over the tip, that must not touch");
        const int& refine = t.count(
            "--refine", 0,
            "Where the machined surface is steeper than 60 degrees: halve the way between cells so often", 0, 5);
        const bool& pcd = t.flag("--pcd", "Write a point for each cell, field removed, instead of triangles");
        const std::string& trace =
            t.other_output("--trace", "Every move: where it ends, when, and what it met (fields t, feed, removed, "
                                      "volume, holder, place), PCD");
        const bool& ascii = t.flag("--ascii", "PCDs as text");
        t.example(
            "fettle-mill programs/pocket.nc --stock box:0,0,-12,80,60,0 --cutter ball:6 --step 0.2 --holder 40,30 "
            "--report mill.json > machined.stl",
            "a pocket with an island, and what it takes");
        t.reference("Guan & Xiong, Virtual machining accuracy verification by triangular patch comparison: steps 1, 2, "
                    "eq. 1 to 3");
        t.parse();

        if (refine > 0 && pcd) throw InputError("--refine", "belongs to triangles, not to --pcd");
        if (step.has_value() == tolerance.has_value()) throw InputError("give either --step or --tolerance");
        if (step && (!design.empty() || published))
            throw InputError("--design and --as-published belong to --tolerance");
        if (ascii && !pcd && trace.empty()) throw InputError("--ascii", "belongs to --pcd and --trace");
        const Cutter cutter = named("--cutter", [&] { return parse_cutter(cutter_text); });
        MillingOptions options;
        if (!holder.empty()) options.holder = named("--holder", [&] { return parse_holder(holder); });
        const Eigen::Vector3d axis = parse_direction(axis_text, "--axis");
        const Eigen::Matrix3d R_tilted_machine = rotation_tilted_machine(axis);
        const std::string source = display_name(path);
        const ToolPath tool_path = parse_tool_path(read_whole(path), source, cutter, {points == "cc", feed, axis});
        const NcProgram& program = tool_path.program;
        const DesignShape shape = design.empty() ? DesignShape{} : named(display_name(design), [&] {
            return shape_of(turned(read_mesh(design, design_units.value_or(Units::Length::mm)), R_tilted_machine));
        });
        const Spacing spacing =
            step ? Spacing{*step} : spacing_for(*tolerance, sampling_radius(cutter), shape, published);
        Workpiece piece = read_stock(stock, stock_units, spacing.step, R_tilted_machine);
        options.floor = piece.floor;

        std::size_t refined = 0;
        std::optional<HeightField> before;
        if (pcd) before = piece.stock;
        const auto bites = mill(piece.stock, cutter, program.moves, options);
        const MillingSummary sum = summarise(program.moves, bites, rapid);
        const PcdEncoding encoding = ascii ? PcdEncoding::ascii : PcdEncoding::binary;
        if (pcd)
            write_pcd(t.output(), turned(to_cloud(*before, piece.stock), R_tilted_machine.transpose()), Units{},
                      encoding);
        else {
            std::optional<Refinement> refinement;
            if (refine > 0) refinement.emplace(piece, piece.stock, cutter, program.moves, 1 << refine);
            write_stl(t.output(), piece.stock, refinement ? &*refinement : nullptr, R_tilted_machine);
            if (refinement) refined = refinement->count();
        }
        if (!trace.empty())
            write_pcd(t.output_file(trace), turned(trace_of(program.moves, bites, rapid), R_tilted_machine.transpose()),
                      Units{}, encoding);
        t.report() = to_json(sum);
        report(t.report(), program, piece.stock);
        t.report().set("refined_squares", refined);
        if (tolerance) t.report().set("discretization", to_json(spacing, shape));
        const std::string unit = tool_path.points ? "point " : "line ";
        const auto warn = [&](const Clash& clash, const std::string& what) {
            if (clash.moves > 0)
                t.warn(source + ": " + what + ": " + std::to_string(clash.moves) + ", the first to " + unit +
                       std::to_string(clash.first_place) + "; up to " + to_short_text(clash.depth) + " mm deep");
        };
        warn(sum.rapid_cuts, "rapid moves through material");
        warn(sum.holder, "moves with the holder in material");
        return sum.rapid_cuts.moves + sum.holder.moves == 0 ? Verdict::yes : Verdict::no;
    });
}
