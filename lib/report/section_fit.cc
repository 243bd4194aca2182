#include "draw/figures.h"
#include "report/sections.h"

#include <algorithm>
#include <cmath>

namespace fettle::report {
namespace {

draw::Html weight_bar(double weight)
{
    return draw::element("i", {{"style", "width:" + draw::fixed_text(100 * weight, 1) + "%"}});
}

/// Name of a fit method for readers.
std::string method_name(const std::string& method)
{
    return method == "gp" ? "smooth (Gaussian process)" : method == "bspline" ? "B-spline" : method;
}

constexpr double kMinShownP = 1e-4; // smaller p-values are not told apart

/// Text of a p-value; very small ones are given as a bound.
std::string p_text(double p) { return p < kMinShownP ? "< " + draw::short_text(kMinShownP) : draw::short_text(p); }

/// What a low goodness of fit says; empty of one that is not.
draw::Html goodness_note(const surface::Surface& surface)
{
    constexpr double kLow = 0.01; // one good fit in a hundred
    const double p = surface.goodness;
    if (!(p > 0 && p < kLow)) return {};
    if (!surface.outliers.empty())
        return draw::element("p", {{"class", "note"}}, "The outliers count in the goodness of fit.");
    return draw::element(
        "p", {{"class", "note"}},
        "Of touches as accurate as the probe is said to be, " +
            (p < kMinShownP ? "fewer than one fit in " : std::string("one fit in ")) +
            draw::count_text(std::round(1 / std::max(p, kMinShownP))) +
            " has residuals as large: the surface may be of another type, or the touches less accurate.");
}

/// Table of the fitted surface types, the most probable first, with their weights as bars.
draw::Html surface_types(const surface::Surface& surface)
{
    draw::Html rows;
    const auto add = [&](const std::string& key, const std::string& method, double score, double weight, bool chosen) {
        rows += draw::element(
            "tr", chosen ? draw::Attributes{{"class", "chosen"}} : draw::Attributes{},
            draw::element("th", method_name(method)) +
                draw::element("td", {{"class", "number"}},
                              draw::number_element(key + "score", score, draw::fixed_text(score, 1))) +
                draw::element("td", {{"class", "number"}},
                              draw::number_element(key + "weight", weight, draw::fixed_text(100 * weight, 1)) + " %") +
                draw::element("td", {{"class", "bar"}}, weight_bar(weight)));
    };
    add("surface.fit.", surface.method, surface.score, surface.weight, true);
    for (std::size_t i = 0; i < surface.alternatives.size(); ++i) {
        const surface::Alternative& other = surface.alternatives[i];
        add("surface.alternatives." + std::to_string(i) + ".", other.method, other.score, other.weight, false);
    }
    const draw::Html names = draw::element("th", "Surface") + draw::element("th", {{"class", "number"}}, "Score") +
                             draw::element("th", {{"class", "number"}}, "Weight") + draw::element("th", "");
    return draw::element(
        "table", draw::element("caption", "Surface types weighted by Schwarz's information criterion (a lower score is "
                                          "better)") +
                     draw::element("thead", draw::element("tr", names)) + draw::element("tbody", rows));
}

draw::Html outlier_table(const surface::Surface& surface, const units::Units& units)
{
    if (surface.outliers.empty()) return {};
    std::vector<std::vector<draw::Html>> rows;
    for (const Eigen::Index i : surface.outliers) {
        std::vector<draw::Html> row = {"touch " + std::to_string(i)};
        for (const double coordinate : surface.touches.col(i)) row.push_back(draw::short_text(coordinate / units.mm()));
        rows.push_back(row);
    }
    const std::string unit = ", " + units::to_string(units.length);
    return table("Outliers, left out of the fit (touches counted from 0)", {"", "x" + unit, "y" + unit, "z" + unit},
                 rows, 1);
}

} // namespace

draw::Html fit_section(const RunFiles& run)
{
    if (!run.surface) {
        if (!run.samples) return {};
        return section("fit", "Touches", property_table({{"Touches", draw::count_text(double(run.samples->size()))}}));
    }
    const surface::Surface& surface = *run.surface;
    const units::Units& units = run.units;
    const double used = double(surface.touches.cols()) - double(surface.outliers.size());
    Properties rows = {{"Desired surface", method_name(surface.method)}, {"Touches used", draw::count_text(used)}};
    if (!surface.outliers.empty())
        rows.emplace_back("Outliers, left out", draw::count_text(double(surface.outliers.size())));
    if (surface.ignored > 0) rows.emplace_back("Points not used", draw::count_text(surface.ignored));
    if (surface.touch_sigma > 0)
        rows.emplace_back("Standard deviation of a touch",
                          length_figure("surface.fit.touch_sigma", surface.touch_sigma, units));
    rows.emplace_back("Residuals, root mean square", length_figure("surface.fit.rms", surface.rms, units));
    if (surface.goodness > 0)
        rows.emplace_back("Goodness of fit (p of \u03C7\u00B2)",
                          draw::number_element("surface.fit.goodness", surface.goodness, p_text(surface.goodness)));
    draw::Html html = draw::element("div", property_table(rows) + goodness_note(surface));
    if (!surface.alternatives.empty())
        html = draw::element("div", {{"class", "columns"}}, html + surface_types(surface));
    return section("fit", "Touches and fit", html + outlier_table(surface, units));
}

draw::Html margin_section(const RunFiles& run)
{
    if (!run.surface || !run.surface->prediction) return {};
    const surface::Prediction& p = *run.surface->prediction;
    const units::Units& units = run.units;
    Properties rows;
    if (p.confidence > 0)
        rows.emplace_back(
            "Confidence that nothing is over-ground",
            draw::number_element("surface.prediction.confidence", p.confidence, draw::short_text(100 * p.confidence)) +
                " %");
    rows.emplace_back("The surface is raised by", length_figure("surface.prediction.shift", p.shift, units));
    rows.emplace_back("Predicted error band of the fit", length_figure("surface.predicted_band", p.band, units));
    if (p.clamped) rows.emplace_back("Regression", "below the probe's accuracy, which was used instead");
    const draw::Html why = draw::element(
        "p", {{"class", "note"}},
        p.method == "wang" ? "By Wang's regressions (2007, 4.5)."
                           : "By the fit's own covariance over the whole of B at once. The shift remains as "
                             "material left; over-cut cannot be repaired.");
    return section("margin", "Margin",
                   draw::element("div", {{"class", "columns"}}, property_table(rows) + draw::element("div", why)));
}

} // namespace fettle::report
