#include "belt/design_file.h"

#include "belt/assess.h"
#include "compare/comparison_report.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "job/shape_warnings.h"
#include "mesh/shape_file.h"

namespace fettle::belt {

namespace {

bool looks_like_json(std::string_view bytes)
{
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && bytes[first] == '{';
}

void check_scan_options(const SurfelSampling& options)
{
    if (options.precision) throw core::InputError("--precision", "goes with patches and meshes, not with a scan");
    if (options.edge_spacing) throw core::InputError("--edge-spacing", "a scan has no boundary curves");
}

} // namespace

SampledDesign read_design(const std::string& path, const std::optional<units::Units::Length>& unit,
                          const SurfelSampling& options)
{
    const std::string bytes = core::read_file(path);
    const std::string source = core::display_name(path);
    if (looks_like_json(core::strip_byte_order_mark(bytes, source))) {
        if (unit) throw core::InputError("--file-units", "patches name their units themselves");
        const std::vector<surface::Patch> patches = surface::parse_patches(bytes, source);
        return core::with_error_prefix(source, [&] { return sample_surfels(patches, options); });
    }
    if (bytes.empty()) throw core::InputError(source, "empty, expected patches, a mesh or a scan");
    const mesh::ShapeFile design = mesh::parse_shape(bytes, source, mesh::resolve_file_units(unit));
    const auto* mesh = std::get_if<mesh::Mesh>(&design.shape);
    if (mesh == nullptr) check_scan_options(options);
    SampledDesign sampled = mesh != nullptr
                                ? core::with_error_prefix(source, [&] { return sample_surfels(*mesh, options); })
                                : sample_surfels(std::get<cloud::Cloud>(design.shape), source, options);
    sampled.warnings = job::shape_warnings(design, source, design.units);
    return sampled;
}

json::Value to_json(const SampledDesign& design, const StockRays& rays)
{
    json::Value report = compare::to_json(displacement_statistics(design.surfels), units::Units{});
    return report.set("surfels", design.surfels.size())
        .set("patches", design.patches)
        .set("on_edges", design.edges.on_edges)
        .set("shrunk", design.edges.shrunk)
        .set("min_spacing", design.min_spacing)
        .set("no_hit", rays.missed)
        .set("several_hits", rays.multiple)
        .set("turned_patches", rays.flipped_patches);
}

} // namespace fettle::belt
