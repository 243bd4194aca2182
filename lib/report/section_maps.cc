#include "core/error.h"
#include "draw/picture.h"
#include "draw/svg_sheet.h"
#include "report/sections.h"
#include "view/view.h"

#include <algorithm>

namespace fettle::report {
namespace {

/// Picture of a part. @param role  SourceFile::role of the part, for messages
draw::Html picture_of(const RunFiles& run, const std::string& role, const mesh::MeshOrCloud& part,
                      const draw::PictureOptions& options, const std::string& caption)
try {
    std::optional<draw::SvgSheet> sheet;
    draw::draw_picture(part, options,
                       [&](int width, int height) -> draw::Sheet& { return sheet.emplace(width, height); });
    return drawing_with_caption(sheet->drawing(caption), caption);
} catch (const core::InputError& error) {
    throw core::InputError(std::ranges::find(run.sources, role, &SourceFile::role)->name, error.what());
}

/// One view of the part before, after and its errors, to be turned. Where it cannot be shown the pictures below it
/// stand for it.
draw::Html rotatable_view(const RunFiles& run, const draw::PictureOptions& options)
{
    std::vector<view::Layer> layers;
    if (run.errors) {
        const mesh::CloudMesh part{*run.errors, {}};
        layers.push_back({"errors", part, view::default_fields(part.points)});
    }
    if (run.before) layers.push_back({"before", mesh::as_cloud_mesh(*run.before), {"z"}});
    if (run.after) layers.push_back({"after", mesh::as_cloud_mesh(*run.after), {"z"}});
    if (layers.empty()) return {};
    view::ViewOptions view;
    view.picture = options;
    if (run.comparison && run.comparison->tolerance > 0) view.error_limit = run.comparison->tolerance;
    if (run.surface)
        view.touches = run.surface->touches;
    else if (run.samples)
        view.touches = run.samples->xyz;
    return draw::element("div", {{"class", "view"}}, view::view_element(layers, view, {}));
}

/// Before and after are drawn over the same area, with the same colours.
void set_common_scale(const RunFiles& run, draw::PictureOptions& options)
{
    if (!run.before || !run.after) return;
    const draw::PictureScale before = draw::picture_scale(*run.before, options),
                             after = draw::picture_scale(*run.after, options);
    options.range = {std::min(before.low, after.low), std::max(before.high, after.high)};
    for (const auto* part : {&*run.before, &*run.after})
        for (const Eigen::Vector3d& p : mesh::coordinates_of(*part).colwise())
            if (p.allFinite()) options.extent.extend(p);
}

} // namespace

draw::Html maps_section(const RunFiles& run)
{
    draw::PictureOptions options;
    options.units = run.units;
    options.job = run.job;
    constexpr int kWidth = 560; // pixels; its text then has the size of the page's text
    options.width = kWidth;
    options.supersampling = 2;
    draw::Html html = rotatable_view(run, options);
    set_common_scale(run, options);
    if (run.before) html += picture_of(run, "part before", *run.before, options, "Before: heights, with hill shading.");
    if (run.after) html += picture_of(run, "part after", *run.after, options, "After: heights, with hill shading.");
    if (run.errors) {
        options.field = "error";
        options.range.reset();
        options.extent.setEmpty();
        std::string scale;
        if (run.comparison && run.comparison->tolerance > 0) {
            options.scale = run.comparison->tolerance;
            scale = " The colour scale ends at the tolerance.";
        }
        html += picture_of(run, "error map", *run.errors, options,
                           "Error map: blue is material left (under-cut), red is over-cut, grey is undefined." + scale);
        options.towards_eye = Eigen::Vector3d(1, -2, 1.5).normalized(); // shows the surface and the material left on it
        html += picture_of(run, "error map", *run.errors, options, "Error map from the side.");
    }
    return section("maps", "Maps", html);
}

} // namespace fettle::report
