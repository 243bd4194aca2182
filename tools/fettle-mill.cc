#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "geometry/bounding_box.h"
#include "machining/discretization.h"
#include "machining/limits.h"
#include "machining/milling.h"
#include "machining/milling_summary.h"
#include "machining/part_mesh.h"
#include "machining/path_options.h"
#include "machining/refinement.h"
#include "machining/stock_frames.h"
#include "machining/tilt.h"
#include "machining/workpiece.h"

#include <optional>
#include <ostream>

using namespace fettle;

namespace {

const std::string kDescription =
    "Machine a stock virtually: cut a map of heights with a cutter along a path of three axes, upright or tilted.\n"
    "Every cell's centre comes to the lowest height at which the cutter passes over it, computed from whole moves. "
    "Lengths in mm, feeds in mm/s; a program states its own (F in length a minute). Exit 1 if a rapid move went "
    "through material or the holder collides.";

struct Options {
    cli::Tool& t;
    const std::string& path_file = t.main_input(
        "PATH", "Points of the tool tip with, if they vary, feeds (field feed, 0: rapid), PCD; or a program, G-code");
    const std::string& stock =
        t.required_file_option("--stock", "STOCK", "box:x0,y0,z0,x1,y1,z1, or STL, PLY, OBJ or PCD");
    const std::optional<units::Units::Length>& stock_units =
        t.length_unit("--stock-units", "Unit of the stock's file, if it is not mm");
    const std::string& cutter = t.required_text(
        "--cutter", "CUTTER", "ball:D, flat:D, bull:D,r or taper:D,halfangle_deg,r: diameter, radius of corner or tip");
    const std::optional<double>& step = t.optional_number("--step", "MM", "Side of a cell", machining::kLengthRange);
    const std::optional<double>& tolerance = t.optional_number(
        "--tolerance", "MM", "Bound on the grid's error, instead of --step: takes the largest cells that keep it",
        machining::kLengthRange);
    const std::string& design = t.optional_file(
        "--design", "FILE", "With --tolerance: the design, whose curvatures and slopes count; else a plane");
    const std::optional<units::Units::Length>& design_units =
        t.length_unit("--design-units", "Unit of the design, if it is not mm");
    const bool& published = t.flag("--as-published", "With --tolerance: without regard to slopes");
    machining::ToolPathOptions path{t};
    const double& rapid = t.number("--rapid", 200, "MM/S", "Speed of rapid moves", machining::kSpeedRange);
    const std::string& holder =
        t.text("--holder", "", "D,HEIGHT", "A cylinder above the cutter, this high over the tip, that must not touch");
    const int& refine =
        t.count("--refine", 0,
                "Where the machined surface is steeper than 60 degrees: halve the grid's step this many times", 0, 5);
    const bool& pcd = t.flag("--pcd", "Write a point for each cell, field removed, instead of triangles");
    const std::string& trace = t.optional_output(
        "--trace", "Every move: its end, time and engagement (fields t, feed, removed, volume, holder, place)",
        cloud::cloud_formats());
    const cloud::CloudOutput out{t, {"stl"}};
    draw::Frames frames{t};
};

void add_usage(cli::Tool& t)
{
    t.example("fettle-mill programs/pocket.nc --stock box:0,0,-12,80,60,0 --cutter ball:6 --step 0.2 --holder 40,30 "
              "--report mill.json > machined.stl",
              "a pocket with an island, and its time and volume");
    t.reference("Guan & Xiong, Virtual machining accuracy verification by triangular patch comparison: steps 1, 2, "
                "eq. 1 to 3");
}

void check(const Options& o)
{
    if (o.refine > 0 && o.pcd) throw core::InputError("--refine", "belongs to triangles, not to --pcd");
    if (o.step.has_value() == o.tolerance.has_value()) throw core::InputError("give either --step or --tolerance");
    if (o.step && (!o.design.empty() || o.published))
        throw core::InputError("--design and --as-published belong to --tolerance");
    o.out.require(o.pcd, "points are written with --pcd, triangles as STL without it", !o.trace.empty());
    o.frames.check_folder();
}

void warn_of_size(const Options& o, const std::string& name, const std::string& part, const Eigen::Vector3d& size,
                  const machining::Cutter& cutter)
{
    const std::string doubt = machining::cutter_size_warning(part, size, cutter);
    if (!doubt.empty()) o.t.warn(core::display_name(name) + ": " + doubt);
}

machining::DesignShape read_design_shape(const Options& o, const machining::Cutter& cutter,
                                         const Eigen::Matrix3d& R_tilted_machine)
{
    if (o.design.empty()) return {};
    const machining::PartMesh part = machining::read_design(o.design, o.design_units, R_tilted_machine);
    for (const std::string& warning : part.warnings) o.t.warn(warning);
    warn_of_size(o, o.design, "the design", geometry::bounding_box(part.mesh.vertices).sizes(), cutter);
    return cli::with_error_prefix(core::display_name(o.design),
                                  [&] { return machining::estimate_design_shape(part.mesh); });
}

/// Writes the triangles of the machined surface. @return  number of refined squares
std::size_t write_triangles(const Options& o, const machining::Workpiece& piece, const machining::Cutter& cutter,
                            const std::vector<machining::CutterMove>& moves, const Eigen::Matrix3d& R_tilted_machine)
{
    std::optional<machining::Refinement> refinement;
    if (o.refine > 0) refinement.emplace(piece, piece.stock, cutter, moves, 1 << o.refine);
    machining::write_stl(o.t.output(), piece.stock, refinement ? &*refinement : nullptr, R_tilted_machine);
    return refinement ? refinement->count() : 0;
}

void warn_of_path(const Options& o, const machining::MillingSummary& sum, const machining::ToolPath& path)
{
    const std::string source = core::display_name(o.path_file) + ": ", place = path.points ? "point" : "line";
    if (const std::string doubt = machining::unit_warning(path.program); !doubt.empty()) o.t.warn(source + doubt);
    if (path.program.tool_change > 0)
        o.t.warn(source + "line " + std::to_string(path.program.tool_change) +
                 " changes the tool: the moves after it are cut with the same --cutter");
    if (sum.rapid_cuts.moves > 0) o.t.warn(source + describe(sum.rapid_cuts, "rapid moves through material", place));
    if (sum.holder_collisions.moves > 0)
        o.t.warn(source + describe(sum.holder_collisions, "moves with the holder in material", place));
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        Options o{t};
        add_usage(t);
        t.parse();
        check(o);

        const machining::Cutter cutter = machining::parse_cutter_option(o.cutter);
        machining::MillingOptions options;
        if (!o.holder.empty())
            options.holder = cli::with_error_prefix("--holder", [&] { return machining::parse_holder(o.holder); });
        const Eigen::Matrix3d R_tilted_machine = machining::rotation_tilted_machine(o.path.axis());
        const machining::ToolPath path = o.path.read(o.path_file, cutter);
        const std::vector<machining::CutterMove>& moves = path.program.moves;
        const machining::DesignShape shape = read_design_shape(o, cutter, R_tilted_machine);
        const machining::Spacing spacing =
            o.step ? machining::Spacing{*o.step}
                   : machining::spacing_for(*o.tolerance, machining::sampling_radius(cutter), shape, o.published);
        machining::Workpiece piece = cli::with_error_prefix("--stock", [&] {
            return machining::read_workpiece(o.stock, o.stock_units, spacing.step, R_tilted_machine);
        });
        options.floor = piece.floor;
        if (!piece.warning.empty()) t.warn(piece.warning);
        warn_of_size(o, o.stock, "the stock", piece.size, cutter);

        std::optional<removal::HeightField> before;
        if (o.pcd || o.frames.wanted()) before = piece.stock;
        const auto engagements = machining::mill(piece.stock, cutter, moves, options);
        const machining::MillingSummary sum = machining::summarise(moves, engagements, o.rapid);

        const auto upright = [&](cloud::Cloud cloud) {
            return machining::rotated(std::move(cloud), R_tilted_machine.transpose());
        };
        std::size_t refined = 0;
        if (o.pcd)
            o.out.write(upright(removal::to_cloud(*before, piece.stock)), units::Units{});
        else
            refined = write_triangles(o, piece, cutter, moves, R_tilted_machine);
        const cloud::Cloud trace = machining::trace_of(moves, engagements, o.rapid);
        if (!o.trace.empty()) o.out.write(o.trace, upright(trace), units::Units{});
        if (o.frames.wanted()) {
            machining::add_frames(o.frames, *before, cutter, moves, cloud::field(trace, "t"), options);
            o.frames.finish("The stock while it is milled.");
        }
        t.report() = machining::to_json(sum, path.program, piece.stock);
        t.report().set("refined_squares", refined);
        if (o.tolerance) t.report().set("discretization", machining::to_json(spacing, shape));
        warn_of_path(o, sum, path);
        return sum.rapid_cuts.moves + sum.holder_collisions.moves == 0 ? cli::Verdict::yes : cli::Verdict::no;
    });
}
