#include "core/constants.h"
#include "core/error.h"
#include "draw/figures.h"
#include "draw/picture.h"
#include "draw/svg_sheet.h"
#include "job/region.h"
#include "report/sections.h"
#include "view/view.h"

#include <algorithm>
#include <cmath>

namespace fettle::report {
namespace {

/// Name of the file of that SourceFile::role, for messages.
const std::string& source_of(const RunFiles& run, const std::string& role)
{
    return std::ranges::find(run.sources, role, &SourceFile::role)->name;
}

/// Picture of a part. @param role  SourceFile::role of the part, for messages
draw::Html picture_of(const RunFiles& run, const std::string& role, const mesh::MeshOrCloud& part,
                      const draw::PictureOptions& options, const std::string& caption)
try {
    std::optional<draw::SvgSheet> sheet;
    draw::draw_picture(part, options,
                       [&](int width, int height) -> draw::Sheet& { return sheet.emplace(width, height); });
    return drawing_with_caption(sheet->drawing(caption), caption);
} catch (const core::InputError& error) {
    throw core::InputError(source_of(run, role), error.what());
}

/// One view of the part before, after and its errors, to be turned. Where it cannot be shown the pictures below it
/// stand for it.
draw::Html rotatable_view(const RunFiles& run, const draw::PictureOptions& options)
{
    std::vector<view::Layer> layers;
    if (run.errors) {
        const mesh::CloudMesh part{*run.errors, {}};
        layers.push_back({"errors", part, view::default_fields(part.points), source_of(run, "error map")});
    }
    if (run.before)
        layers.push_back({"before", mesh::as_cloud_mesh(*run.before), {"z"}, source_of(run, "part before")});
    if (run.after) layers.push_back({"after", mesh::as_cloud_mesh(*run.after), {"z"}, source_of(run, "part after")});
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

/// The highest point inside B, mm; NaN without a job or a point.
double top_inside(const RunFiles& run, const mesh::MeshOrCloud& part)
{
    double top = core::kNaN;
    if (!run.job) return top;
    const Eigen::Matrix3Xd& xyz = mesh::coordinates_of(part);
    const std::vector<job::Region> regions = job::classify_regions(*run.job, xyz);
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        if (regions[i] == job::Region::inside) top = std::fmax(top, xyz(2, i));
    return top;
}

std::string length_text(double mm, const units::Units& units)
{
    return draw::short_text(mm / units.mm()) + " " + units::to_string(units.length);
}

/// What the pictures before and after show.
struct HeightCaptions {
    std::string before = "Before: heights, with hill shading", after = "After: heights, with hill shading";
};
HeightCaptions height_captions(const RunFiles& run)
{
    HeightCaptions captions;
    const double before = run.before ? top_inside(run, *run.before) : core::kNaN,
                 after = run.after ? top_inside(run, *run.after) : core::kNaN;
    if (!std::isnan(before)) captions.before += "; inside B up to " + length_text(before, run.units);
    if (!std::isnan(after)) captions.after += "; inside B up to " + length_text(after, run.units);
    if (before > after) captions.after += ", " + length_text(before - after, run.units) + " lower than before";
    captions.before += ".";
    captions.after += ".";
    return captions;
}

/// What the error map shows, where a tolerance judges it.
std::string error_finding(const RunFiles& run)
{
    if (!run.comparison || run.comparison->judged.empty()) return {};
    const NamedNumbers& n = run.comparison->region(run.comparison->judged);
    return ": " + draw::fixed_text(100 * n.at("within"), 2) + " % of the points " +
           (run.comparison->judged == "inside" ? "inside B" : "of the part") + " within \u00B1" +
           draw::short_text(run.comparison->tolerance) + " " + units::to_string(run.units.length) + ", mean " +
           draw::short_text(n.at("mean"));
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
    const HeightCaptions captions = height_captions(run);
    if (run.before) html += picture_of(run, "part before", *run.before, options, captions.before);
    if (run.after) html += picture_of(run, "part after", *run.after, options, captions.after);
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
                           "Error map" + error_finding(run) +
                               ". Blue is material left (under-cut), red is over-cut, grey is undefined." + scale);
        options.towards_eye = Eigen::Vector3d(1, -2, 1.5).normalized(); // shows the surface and the material left on it
        html += picture_of(run, "error map", *run.errors, options,
                           "The same from the side, where what is left stands over the surface around it.");
    }
    return section("maps", "Maps", html);
}

} // namespace fettle::report
