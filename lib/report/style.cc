#include "report/style.h"

namespace fettle::report {

namespace {

// Colours: Okabe and Ito (2008) for categories; the ends of the error maps' scale for over- and under-cut.
constexpr const char* kStyle = R"css(
:root { --ink: #1c2733; --soft: #5a6672; --rule: #d9dfe5; --pale: #f4f6f8; --blue: #0072b2; --orange: #d55e00;
        --green: #007a5a; --purple: #7a4a9c; --over: #b2182b; --under: #2166ac; }
* { box-sizing: border-box; }
html { background: #e9edf0; }
body { margin: 0 auto; max-width: 60rem; padding: 2.6rem 3rem 2rem; background: #fff; color: var(--ink);
       font: .94rem/1.5 "Source Sans 3", "Segoe UI", "Helvetica Neue", Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif;
       font-variant-numeric: tabular-nums lining-nums; }
header { border-bottom: 2px solid var(--ink); padding-bottom: .7rem; margin-bottom: 1.4rem; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0; font-weight: 650; overflow-wrap: anywhere; }
header dl.head { display: flex; flex-wrap: wrap; gap: .3rem 2rem; margin: .7rem 0 0; }
header dl.head dt { color: var(--soft); font-size: .8rem; }
header dl.head dd { margin: 0; font-weight: 600; overflow-wrap: anywhere; }
header p { margin: .3rem 0 0; color: var(--soft); overflow-wrap: anywhere; }
h2 { font-size: 1.12rem; margin: 2.1rem 0 .7rem; padding-bottom: .25rem; border-bottom: 1px solid var(--rule); font-weight: 650; }
h3 { font-size: .95rem; margin: 1.2rem 0 .4rem; font-weight: 650; }
p { margin: .5rem 0; max-width: 46rem; }
.note { color: var(--soft); font-size: .88rem; }
.verdict { display: flex; gap: 1.1rem; align-items: center; border: 1px solid var(--rule); border-left: .55rem solid var(--soft);
           padding: .9rem 1.2rem; background: var(--pale); }
.verdict.within { border-left-color: var(--green); }
.verdict.out { border-left-color: var(--orange); }
.verdict .sign { font-size: 2.3rem; line-height: 1; font-weight: 700; }
.verdict.within .sign, .verdict.within strong { color: var(--green); }
.verdict.out .sign, .verdict.out strong { color: #b34700; }
.verdict strong { display: block; font-size: 1.35rem; line-height: 1.25; font-weight: 650; }
.verdict.force { border-left-color: var(--over); margin-top: .7rem; }
.verdict.force .sign, .verdict.force strong, .verdict.force p { color: var(--over); }
.verdict p { margin: .15rem 0 0; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(7.7rem, 1fr)); gap: .7rem; margin: 1rem 0 0; padding: 0; list-style: none; }
.tiles li { border: 1px solid var(--rule); padding: .5rem .6rem .55rem; }
.tiles b { display: block; font-size: 1.15rem; font-weight: 600; line-height: 1.3; white-space: nowrap; }
.tiles span.label { color: var(--soft); font-size: .82rem; line-height: 1.3; display: block; }
.columns { display: grid; grid-template-columns: 1fr 1fr; gap: 0 2.2rem; align-items: start; }
table { border-collapse: collapse; width: 100%; margin: .4rem 0 .9rem; font-size: .92rem; }
caption { max-width: calc(100vw - 3.2rem); text-align: left; color: var(--soft); font-size: .85rem; padding-bottom: .2rem; }
th, td { padding: .22rem .6rem .22rem 0; text-align: left; vertical-align: baseline; border-bottom: 1px solid var(--rule); }
thead th { border-bottom: 1px solid var(--ink); font-weight: 600; font-size: .85rem; vertical-align: bottom; }
tbody th { font-weight: 400; color: var(--soft); }
td.number { white-space: nowrap; }
td.number, th.number { text-align: right; padding-right: .4rem; padding-left: .6rem; }
table.facts th { width: 50%; } .stacked table + table { margin-top: -.9rem; }
.columns > figure { margin-top: 0; }
table tr.chosen td, table tr.chosen th { font-weight: 650; color: var(--ink); }
td.bar { width: 30%; }
td.bar i { display: block; height: .62rem; background: var(--blue); min-width: 1px; }
.over-text { color: var(--over); } .under-text { color: var(--under); }
.share { display: flex; height: 1.1rem; margin: .3rem 0 .2rem; }
.share i { display: block; } .share .a { background: var(--blue); } .share .b { background: #e69f00; } .share .c { background: #b9c2ca; }
.key { display: flex; flex-wrap: wrap; gap: 0 1.4rem; padding: 0; margin: 0 0 .6rem; list-style: none; font-size: .88rem; }
.key i { display: inline-block; width: .75rem; height: .75rem; margin-right: .4rem; }
.key .a { background: var(--blue); } .key .b { background: #e69f00; } .key .c { background: #b9c2ca; }
figure { margin: .8rem 0 1.1rem; }
figure img, figure svg { display: block; width: 100%; height: auto; }
figcaption { color: var(--soft); font-size: .88rem; margin-top: .3rem; }
.player img { max-width: 50rem; }
.player .controls { display: flex; gap: .8rem; align-items: center; margin-bottom: .4rem; } .player input { flex: 1 1 auto; }
.player button { font: inherit; font-size: .85rem; padding: .2rem .7rem; border: 1px solid #b4bdc5; border-radius: 3px; background: #fff; cursor: pointer; }
.view .stage { height: 30rem; flex: none; }
.hash { font: .78rem "DejaVu Sans Mono", "Liberation Mono", Consolas, monospace; overflow-wrap: anywhere; color: var(--soft); }
.name { overflow-wrap: anywhere; }
footer { margin-top: 2rem; border-top: 1px solid var(--rule); padding-top: .5rem; color: var(--soft); font-size: .82rem; }
sub { font-size: .78em; line-height: 0; }
svg tspan { font-size: 9px; } svg tspan.line { font-size: 12px; }
svg text { font-size: 12px; fill: var(--soft); }
svg .panel { fill: var(--ink); font-weight: 600; }
svg .over { fill: var(--over); } svg .under { fill: var(--under); }
svg .grid { stroke: var(--rule); stroke-width: 1; } svg .axis { stroke: var(--soft); stroke-width: 1; }
svg .limit { stroke: var(--orange); stroke-width: 1.2; stroke-dasharray: 5 3; }
svg .force { fill: none; stroke: var(--blue); stroke-width: .9; stroke-linejoin: round; }
svg .layer, svg .feed { fill: none; stroke: var(--ink); stroke-width: 1; }
svg .time-axis { fill: none; } svg .cursor { stroke: var(--orange); stroke-width: 1.4; visibility: hidden; }
svg .idle { fill: #e3e7eb; }
svg .sign-blue { fill: var(--blue); } svg .sign-green { fill: var(--green); } svg .sign-orange { fill: #e69f00; }
svg .sign-purple { fill: var(--purple); } svg .sign-cross { fill: none; stroke: var(--orange); stroke-width: 2; }
svg .bin { stroke: #8a949e; stroke-width: .6; }
svg .gauge-out { fill: #ead9cf; } svg .gauge-in { fill: #e4efe9; }
svg .whisker { stroke: var(--ink); stroke-width: 1.4; } svg .spread { fill: #56748f; } svg .mean { fill: #fff; stroke: var(--ink); stroke-width: 1.6; }
svg .edge-b { fill: #1c27330a; stroke: var(--ink); stroke-width: 2; } svg .edge-s { fill: none; stroke: var(--purple); stroke-width: 1.2; }
svg .pass { fill: none; stroke: #b4bdc5; stroke-width: .8; } svg .start { fill: none; stroke: var(--green); stroke-width: 2; }
svg .touch { fill: var(--blue); } svg .touch-edge { fill: #fff; stroke: var(--blue); stroke-width: 1.4; }
svg .outlier { fill: none; stroke: var(--orange); stroke-width: 1.8; } svg .scale-bar { fill: var(--ink); } svg .axis-w { stroke: var(--ink); stroke-width: 1.4; }
@media (max-width: 44rem) { body { padding: 1.2rem; } .columns { grid-template-columns: 1fr; } .scroll { overflow-x: auto; } }
@page { size: A4; margin: 15mm 15mm 17mm; @bottom-right { content: counter(page) " / " counter(pages); font: 8pt sans-serif; color: #5a6672; } }
@media print {
  html { background: #fff; font-size: 12.6px; }
  body { max-width: none; padding: 0; line-height: 1.4; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  h2 { margin-top: 1.5rem; }
  h2, h3, caption { break-after: avoid; }
  figure, table, tr, .verdict, .tiles, .columns { break-inside: avoid; }
  p { orphans: 3; widows: 3; }
}
)css";

} // namespace

draw::Html style_sheet() { return draw::Html::from_markup("<style>" + std::string(kStyle) + "</style>\n"); }

} // namespace fettle::report
