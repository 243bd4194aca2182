#include "core/error.h"
#include "draw/picture.h"
#include "draw/svg_sheet.h"
#include "report/sections.h"

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

} // namespace

draw::Html maps_section(const RunFiles& run)
{
    draw::PictureOptions options;
    options.units = run.units;
    options.job = run.job;
    constexpr int kWidth = 560; // pixels; its text then has the size of the page's text
    options.width = kWidth;
    options.supersampling = 2;
    draw::Html html;
    if (run.before) html += picture_of(run, "part before", *run.before, options, "Before: heights, with hill shading.");
    if (run.after) html += picture_of(run, "part after", *run.after, options, "After: heights, with hill shading.");
    if (run.errors) {
        options.field = "error";
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
