#include "belt/assess.h"
#include "belt/sampling.h"
#include "belt/stock.h"
#include "belt/surfel.h"
#include "cli/tool.h"
#include "cloud/pcd.h"
#include "compare/comparison_report.h"
#include "core/file.h"
#include "core/lines.h"
#include "mesh/shape_file.h"

#include <numbers>
#include <ostream>

using namespace fettle;

namespace {

bool looks_like_json(std::string_view bytes)
{
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && bytes[first] == '{';
}

/// Patches, a mesh or a scan, told by content.
SampledDesign sample_design(const std::string& path, const std::optional<Units::Length>& unit,
                            const SurfelSampling& options)
{
    const std::string bytes = read_whole(path);
    const std::string source = display_name(path);
    if (looks_like_json(without_mark(bytes, source))) {
        if (unit) throw InputError("--file-units", "patches name their units themselves");
        return sample_surfels(parse_patches(bytes, source), options);
    }
    if (bytes.empty()) throw InputError(source, "empty, expected patches, a mesh or a scan");
    const MeshOrCloud design = parse_shape(bytes, source, units_of(unit)).shape;
    if (const Mesh* mesh = std::get_if<Mesh>(&design)) return sample_surfels(*mesh, options);
    if (options.precision) throw InputError("--precision", "goes with patches and meshes, not with a scan");
    if (options.edge_spacing) throw InputError("--edge-spacing", "a scan has no boundary curves");
    return sample_surfels(std::get<Cloud>(design), source, options);
}

std::string share_of(Eigen::Index count, const Surfels& surfels)
{
    return std::to_string(count) + " of " + std::to_string(surfels.size()) + " surfels ";
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "A workpiece as surfels: discs on the design, and how far the stock stands over each of them.\n"
        "The design is sampled patch by patch: B-spline patches (JSON) on a u-v lattice, a mesh on lattices over "
        "pieces "
        "between its edges, a scan by thinning. Along edges and borders boundary re-sampling puts small surfels; "
        "others shrink there. Displacements come from rays along the normals. Out: points on the design with normal, "
        "radius, u v, patch (from 0), area and displacement; mm. Exit 1 if no ray meets the stock.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& path =
            t.input("DESIGN", "Patches (JSON), a mesh (STL, PLY, OBJ, OFF) or a scan with normals");
        const auto& unit = t.length_unit("--file-units", "Unit of a mesh or scan, if it is not mm");
        const std::string& stock_path = t.required_file("--stock", "FILE", "The stock: a mesh or a scan");
        const auto& stock_unit = t.length_unit("--stock-units", "Unit of the stock, if it is not mm");
        SurfelSampling options;
        const double& spacing =
            t.number("--spacing", options.spacing, "MM",
                     "Neighbours are no farther apart: no more than a cell of the contact grid", Range::positive());
        const auto& precision = t.number_if_given(
            "--precision", "MM", "Discs bend off the surface by no more: closer where it is curved", Range::positive());
        const auto& edge_spacing = t.number_if_given(
            "--edge-spacing", "MM", "Of surfels along edges [half the least spacing]", Range::positive());
        const double& sharp =
            t.number("--sharp", 30, "DEG", "Between two normals, more is an edge", Range::inside(0, 90));
        const double& reach =
            t.number("--reach", 5, "MM", "The stock is looked for so far either way", Range::positive());
        const bool& ascii = t.flag("--ascii", "Text instead of binary");
        t.example("fettle-surfel parts/patch_saddle.json --stock <(fettle-part parts/patch_saddle_1x1.json) "
                  "--stock-units in --spacing 1 > work.pcd",
                  "a saddle with a stub on it, as surfels 1 mm apart");
        t.reference("Ren et al. 2006, Surfel-based modelling of free-form surfaces (boundary re-sampling: fig. 3)");
        t.parse();

        if (path == "-" && stock_path == "-") throw InputError("only one of DESIGN and --stock can be stdin");
        options.spacing = spacing;
        options.precision = precision;
        options.edge_spacing = edge_spacing;
        options.sharp = sharp * std::numbers::pi / 180;
        SampledDesign design = sample_design(path, unit, options);
        Surfels& surfels = design.surfels;
        const StockRays rays = cast_on_stock(surfels, read_shape(stock_path, units_of(stock_unit)).shape, reach);
        write_pcd(t.output(), to_cloud(surfels), Units{}, ascii ? PcdEncoding::ascii : PcdEncoding::binary);

        t.report() = to_json(displacement_statistics(surfels), Units{});
        t.report()
            .set("surfels", static_cast<std::size_t>(surfels.size()))
            .set("patches", design.patches)
            .set("on_edges", static_cast<std::size_t>(design.edges.on_edges))
            .set("shrunk", static_cast<std::size_t>(design.edges.shrunk))
            .set("least_spacing", design.least_spacing)
            .set("no_hit", static_cast<std::size_t>(rays.missed))
            .set("several_hits", static_cast<std::size_t>(rays.several))
            .set("turned_patches", static_cast<std::size_t>(rays.turned_patches));
        if (rays.missed > 0)
            t.warn(display_name(stock_path) + ": none of it is met by " + share_of(rays.missed, surfels) +
                   "within --reach: they have no displacement");
        if (rays.several > 0)
            t.warn(display_name(stock_path) + ": met more than once by " + share_of(rays.several, surfels) +
                   "within --reach: the nearest place counts");
        return rays.missed < surfels.size() ? Verdict::yes : Verdict::no;
    });
}
