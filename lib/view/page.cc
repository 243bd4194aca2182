#include "core/error.h"
#include "draw/base64.h"
#include "view/view.h"
#include "view/view_script.h"

namespace fettle::view {
namespace {

constexpr const char* kStyle = R"css(
.fettle-view { display: flex; flex-direction: column; }
.fettle-view .bar { display: flex; flex-wrap: wrap; gap: .3rem .8rem; padding: .3rem 0; }
.fettle-view .group { display: inline-flex; flex-wrap: wrap; gap: .2rem; }
.fettle-view button { font: inherit; font-size: .85rem; padding: .2rem .6rem; border: 1px solid #b4bdc5; border-radius: 3px; background: #fff; color: #1c2733; cursor: pointer;
  max-width: 22rem; overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.fettle-view button[aria-pressed="true"] { background: #1c2733; color: #fff; border-color: #1c2733; }
.fettle-view .stage { position: relative; flex: 1 1 auto; min-height: 18rem; overflow: hidden; border: 1px solid #aaa; }
.fettle-view .stage canvas { position: absolute; left: 0; top: 0; width: 100%; height: 100%; }
.fettle-view .stage canvas:first-child { cursor: grab; touch-action: none; outline-offset: -2px; }
.fettle-view .over { pointer-events: none; }
.fettle-view .stage canvas.legend { left: auto; right: 0; }
.fettle-view .stage canvas.axes { top: auto; bottom: 0; }
.fettle-view .tip { position: absolute; pointer-events: none; background: #1c2733e6; color: #fff; font-size: .8rem; line-height: 1.35; padding: .3rem .5rem; border-radius: 3px; }
.fettle-view .tip[hidden], .fettle-view .tip:empty { display: none; }
.fettle-view .tip span { display: block; white-space: nowrap; }
.fettle-view canvas.profile { width: 100%; height: 13rem; flex: none; border: 1px solid #aaa; border-top: 0; }
.fettle-view canvas.profile[hidden] { display: none; }
.fettle-view textarea.picks { width: 100%; box-sizing: border-box; font: .8rem/1.4 "DejaVu Sans Mono", "Liberation Mono", Consolas, monospace; }
.fettle-view p.help { color: #5a6672; font-size: .78rem; margin: .25rem 0; max-width: none; }
.fettle-view.with-webgl .fallback { display: none; }
.fettle-view.without-webgl > *:not(.fallback) { display: none; }
.fettle-view .fallback img, .fettle-view .fallback svg { max-width: 100%; height: auto; }
@media print { .fettle-view { display: none; } }
)css";

constexpr const char* kPageStyle = R"css(
html, body { height: 100%; margin: 0; }
body { display: flex; flex-direction: column; box-sizing: border-box; padding: .5rem .8rem; background: #fff; color: #1c2733; font: .94rem/1.4 "Source Sans 3", "Segoe UI", Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.15rem; margin: 0; overflow-wrap: anywhere; }
.fettle-view { flex: 1 1 auto; min-height: 0; }
)css";

draw::Html style(const char* rules) { return draw::element("style", draw::Html::from_markup(rules)); }

} // namespace

draw::Html view_style() { return style(kStyle); }

// In XML a script is text with markup in it, in HTML it is not: the page is both.
draw::Html view_script()
{
    return draw::element("script", draw::Html::from_markup("//<![CDATA[\n\"use strict\";\n(() => {\n" +
                                                           std::string(kViewScript) + "})();\n//]]>"));
}

std::string view_page(const std::vector<Layer>& layers, const ViewOptions& options, const std::string& title)
{
    const std::string headline = title.empty() ? layers.front().name : title;
    draw::PictureOptions picture = options.picture;
    picture.field = layers.front().part.is_mesh() ? "z" : layers.front().fields.front();
    picture.towards_eye = Eigen::Vector3d(1, -2, 1.5).normalized();
    const std::string png = core::with_error_prefix(
        layers.front().name, [&] { return draw::picture(as_shape(layers.front().part), picture); });
    const draw::Html fallback =
        draw::element("p", "This browser has no WebGL 2: a picture instead of the view.") +
        draw::empty_element("img", {{"alt", headline}, {"src", "data:image/png;base64," + draw::base64(png)}});
    const draw::Html head =
        draw::empty_element("meta", {{"charset", "utf-8"}}) +
        draw::empty_element("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}) +
        draw::element("title", headline) + view_style() + style(kPageStyle);
    const draw::Html body = (title.empty() ? draw::Html() : draw::element("h1", title)) +
                            view_element(layers, options, fallback) + view_script();
    return "<!DOCTYPE html>\n" +
           draw::element("html", {{"lang", "en"}}, draw::element("head", head) + draw::element("body", body)).bytes() +
           "\n";
}

} // namespace fettle::view
