#include "report/figures.h"
#include "report/sections.h"

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

Html weight_bar(double weight) { return element("i", {{"style", "width:" + fixed_text(100 * weight, 1) + "%"}}); }

/// What a method is called where people read.
std::string name_of(const std::string& method)
{
    return method == "gp" ? "smooth (Gaussian process)" : method == "bspline" ? "B-spline" : method;
}

/// A probability; digits of very small ones mean nothing.
std::string p_text(double p)
{
    constexpr double kLeast = 1e-4;
    return p < kLeast ? "< " + short_text(kLeast) : short_text(p);
}

/// The kinds of surface that were weighed, best first, and their weights as bars.
Html candidates(const Surface& surface)
{
    Html rows;
    const auto add = [&](const std::string& key, const std::string& method, double score, double weight, bool chosen) {
        rows += element("tr", chosen ? Attributes{{"class", "chosen"}} : Attributes{},
                        element("th", name_of(method)) +
                            element("td", {{"class", "number"}}, figure(key + "score", score, fixed_text(score, 1))) +
                            element("td", {{"class", "number"}},
                                    figure(key + "weight", weight, fixed_text(100 * weight, 1)) + " %") +
                            element("td", {{"class", "bar"}}, weight_bar(weight)));
    };
    add("surface.fit.", surface.method, surface.score, surface.weight, true);
    for (std::size_t i = 0; i < surface.alternatives.size(); ++i) {
        const Alternative& other = surface.alternatives[i];
        add("surface.alternatives." + std::to_string(i) + ".", other.method, other.score, other.weight, false);
    }
    const Html names = element("th", "Surface") + element("th", {{"class", "number"}}, "Score") +
                       element("th", {{"class", "number"}}, "Weight") + element("th", "");
    return element("table",
                   element("caption", "Kinds of surface weighed by how well they explain the touches (Schwarz's "
                                      "criterion, less is better)") +
                       element("thead", element("tr", names)) + element("tbody", rows));
}

Html slips(const Surface& surface, const Units& units)
{
    if (surface.gross_errors.empty()) return {};
    std::vector<std::vector<Html>> rows;
    for (const Eigen::Index i : surface.gross_errors) {
        std::vector<Html> row = {"touch " + std::to_string(i)};
        for (const double coordinate : surface.touches.col(i)) row.push_back(short_text(coordinate / units.mm()));
        rows.push_back(row);
    }
    const std::string unit = ", " + to_string(units.length);
    return table("Touches taken for slips and left out (counted from 0)", {"", "x" + unit, "y" + unit, "z" + unit},
                 rows, 1);
}

} // namespace

Html fit_section(const RunFiles& run)
{
    if (!run.surface) {
        if (!run.samples) return {};
        return section("fit", "Touches", facts({{"Touches", count_text(double(run.samples->size()))}}));
    }
    const Surface& surface = *run.surface;
    const Units& units = run.units;
    const double used = double(surface.touches.cols()) - double(surface.gross_errors.size());
    Facts rows = {{"Desired surface", name_of(surface.method)}, {"Touches used", count_text(used)}};
    if (!surface.gross_errors.empty())
        rows.emplace_back("Slips, left out", count_text(double(surface.gross_errors.size())));
    if (surface.ignored > 0) rows.emplace_back("Points not used", count_text(surface.ignored));
    if (surface.touch_sigma > 0)
        rows.emplace_back("Standard deviation of a touch",
                          length_figure("surface.fit.touch_sigma", surface.touch_sigma, units));
    rows.emplace_back("Residuals, root mean square", length_figure("surface.fit.rms", surface.rms, units));
    if (surface.goodness > 0)
        rows.emplace_back("Goodness of fit (p of \u03C7\u00B2)",
                          figure("surface.fit.goodness", surface.goodness, p_text(surface.goodness)));
    Html html = facts(rows);
    if (!surface.alternatives.empty()) html = element("div", {{"class", "columns"}}, html + candidates(surface));
    return section("fit", "Touches and fit", html + slips(surface, units));
}

Html margin_section(const RunFiles& run)
{
    if (!run.surface || !run.surface->prediction) return {};
    const Prediction& p = *run.surface->prediction;
    const Units& units = run.units;
    Facts rows;
    if (p.confidence > 0)
        rows.emplace_back("Confidence that nothing is over-ground",
                          figure("surface.prediction.confidence", p.confidence, short_text(100 * p.confidence)) + " %");
    rows.emplace_back("The surface is raised by", length_figure("surface.prediction.shift", p.shift, units));
    rows.emplace_back("Predicted error band of the fit", length_figure("surface.predicted_band", p.band, units));
    if (p.clamped) rows.emplace_back("Regression", "below the probe's accuracy, which was used instead");
    const Html why =
        element("p", {{"class", "note"}},
                p.method == "wang" ? "By Wang's regressions (2007, 4.5)."
                                   : "By the fit's own covariance over the whole of B at once. What is raised stays as "
                                     "material left; over-cut cannot be mended.");
    return section("margin", "Margin", element("div", {{"class", "columns"}}, facts(rows) + element("div", why)));
}

} // namespace fettle
