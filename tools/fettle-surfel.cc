#include "belt/design_file.h"
#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "core/file.h"
#include "job/shape_warnings.h"
#include "mesh/shape_file.h"

#include <numbers>

using namespace fettle;

int main(int argc, char** argv)
{
    const std::string description =
        "Make a workpiece of surfels: discs on the design, and how far the stock stands over each of them.\n"
        "The design is sampled patch by patch: B-spline patches (JSON) on a u-v lattice, a mesh on lattices over "
        "pieces between its edges, a scan by thinning. Along edges and borders boundary re-sampling puts small "
        "surfels; "
        "others shrink there. Displacements come from rays along the normals. Out: points on the design with normal, "
        "radius, u v, patch (from 0), area and displacement; mm. Exit 1 if no ray meets the stock.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const std::string& path =
            t.main_input("DESIGN", "Patches (JSON), a mesh (STL, PLY, OBJ, OFF) or a scan with normals");
        const auto& unit = t.length_unit("--file-units", "Unit of a mesh or scan, if it is not mm");
        const std::string& stock_path = t.required_file_option("--stock", "FILE", "The stock: a mesh or a scan");
        const auto& stock_unit = t.length_unit("--stock-units", "Unit of the stock, if it is not mm");
        belt::SurfelSampling options;
        const double& spacing = t.number("--spacing", options.spacing, "MM",
                                         "Maximum distance between neighbours; no more than a cell of the contact grid",
                                         core::Range::positive());
        const auto& precision =
            t.optional_number("--precision", "MM", "Discs bend off the surface by no more: closer where it is curved",
                              core::Range::positive());
        const auto& edge_spacing =
            t.optional_number("--edge-spacing", "MM", "Spacing of surfels along edges [half the smallest spacing]",
                              core::Range::positive());
        const double& sharp = t.number("--sharp", 30, "DEG", "Between two normals, more is an edge",
                                       core::Range::strictly_between(0, 90));
        const double& reach =
            t.number("--reach", 5, "MM", "Length of the rays, to either side of the design", core::Range::positive());
        const cloud::CloudOutput out{t};
        t.example("fettle-surfel parts/patch_saddle.json --stock <(fettle-part parts/patch_saddle_1x1.json) "
                  "--stock-units in --spacing 1 > work.pcd",
                  "a saddle with a stub on it, as surfels with a spacing of 1 mm");
        t.reference("Ren et al. 2006, Surfel-based modelling of free-form surfaces (boundary re-sampling: fig. 3)");
        t.parse();

        if (path == "-" && stock_path == "-") throw core::InputError("only one of DESIGN and --stock can be stdin");
        options.spacing = spacing;
        options.precision = precision;
        options.edge_spacing = edge_spacing;
        options.sharp_angle = sharp * std::numbers::pi / 180;
        belt::SampledDesign design = belt::read_design(path, unit, options);
        const mesh::ShapeFile stock = mesh::read_shape(stock_path, mesh::resolve_file_units(stock_unit));
        for (const std::string& doubt : design.warnings) t.warn(doubt);
        for (const std::string& doubt : job::shape_warnings(stock, core::display_name(stock_path), stock.units))
            t.warn(doubt);
        const belt::StockRays rays = belt::cast_rays_on_stock(design.surfels, stock.shape, reach);
        out.write(belt::to_cloud(design.surfels), units::Units{});
        t.report() = belt::to_json(design, rays);

        const std::string of_all = " of " + std::to_string(design.surfels.size()) + " surfels ";
        if (rays.missed > 0)
            t.warn(core::display_name(stock_path) + ": the rays of " + std::to_string(rays.missed) + of_all +
                   "miss it: these have no displacement");
        if (rays.multiple > 0)
            t.warn(core::display_name(stock_path) + ": the rays of " + std::to_string(rays.multiple) + of_all +
                   "hit it more than once: the nearest hit counts");
        return rays.missed < design.surfels.size() ? cli::Verdict::yes : cli::Verdict::no;
    });
}
