#include "compare/picture.h"
#include "core/error.h"
#include "report/sections.h"
#include "report/svg_sheet.h"

#include <algorithm>

namespace fettle {
namespace {

/// @param what  the part's role among the sources, for messages
Html picture_of(const RunFiles& run, const std::string& what, const MeshOrCloud& part, const PictureOptions& options,
                const std::string& caption)
try {
    std::optional<SvgSheet> sheet;
    draw_picture(part, options, [&](int width, int height) -> Sheet& { return sheet.emplace(width, height); });
    return drawing_with_caption(sheet->drawing(caption), caption);
} catch (const InputError& error) {
    const auto file = std::find_if(run.sources.begin(), run.sources.end(),
                                   [&](const SourceFile& source) { return source.what == what; });
    throw InputError(file->name, error.what());
}

} // namespace

Html maps_section(const RunFiles& run)
{
    PictureOptions options;
    options.units = run.units;
    options.within = run.job;
    constexpr int kWidth = 560; // its letters are then as large as those of the page
    options.width = kWidth;
    options.fineness = 2;
    Html html;
    if (run.before)
        html += picture_of(run, "part before", *run.before, options, "Before: heights, shaded as hills are.");
    if (run.after) html += picture_of(run, "part after", *run.after, options, "After: heights, shaded as hills are.");
    if (run.errors) {
        options.field = "error";
        std::string scale;
        if (run.comparison && run.comparison->tolerance > 0) {
            options.scale = run.comparison->tolerance;
            scale = " The colours end at the tolerance.";
        }
        html += picture_of(run, "error map", *run.errors, options,
                           "Error map: blue is material left (under-cut), red is over-cut, grey is undefined." + scale);
        options.from = Eigen::Vector3d(1, -2, 1.5).normalized(); // shows both the surface and what stands on it
        html += picture_of(run, "error map", *run.errors, options, "The same from the side.");
    }
    return section("maps", "Maps", html);
}

} // namespace fettle
