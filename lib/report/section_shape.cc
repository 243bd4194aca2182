#include "report/figures.h"
#include "report/sections.h"

namespace fettle {

Html registration_section(const RunFiles& run)
{
    if (!run.alignment) return {};
    const Figures& n = run.alignment->numbers;
    const std::string unit = " " + to_string(run.units.length);
    const auto shown = [&](const std::string& key, const std::string& text) {
        return figure("alignment." + key, n.at(key), text);
    };
    const auto length = [&](const std::string& key) { return shown(key, short_text(n.at(key))) + unit; };
    const Html numbers = facts({{"Points on the reference", shown("overlap", fixed_text(100 * n.at("overlap"), 1)) +
                                                                " % of " + shown("count", count_text(n.at("count")))},
                                {"Distance, median", length("median")},
                                {"Distance, 95th percentile", length("p95")},
                                {"Distance, root mean square", length("rms")},
                                {"Motions determined", shown("determined", short_text(n.at("determined"))) + " of 6"}});
    std::vector<std::vector<Html>> rows;
    for (Eigen::Index i = 0; i < 4; ++i) {
        std::vector<Html> row;
        for (Eigen::Index j = 0; j < 4; ++j) {
            const std::string key = "alignment.transform." + std::to_string(i) + "." + std::to_string(j);
            row.push_back(figure(key, run.alignment->transform(i, j), fixed_text(run.alignment->transform(i, j), 5)));
        }
        rows.push_back(row);
    }
    const Html matrix = table("Transform: reference = matrix \u00B7 scan, lengths in" + unit, {}, rows, 0);
    return section("registration", "Registration", element("div", {{"class", "columns"}}, numbers + matrix));
}

Html form_section(const RunFiles& run)
{
    if (!run.form) return {};
    const Figures& n = run.form->numbers;
    const std::string unit = " " + to_string(run.units.length);
    const auto shown = [&](const std::string& key, const std::string& text) {
        return figure("form." + key, n.at(key), text);
    };
    const Html name = run.form->form + (run.form->parameter.empty() ? "" : " (" + run.form->parameter + ")");
    const Html left = facts({{"Form error", name},
                             {"Minimum zone", shown("minimum_zone", short_text(n.at("minimum_zone"))) + unit},
                             {"Least squares", shown("least_squares", short_text(n.at("least_squares"))) + unit}});
    const Html right = facts({{"Points", shown("count", count_text(n.at("count")))},
                              {"Without coordinates", shown("dropped", count_text(n.at("dropped")))},
                              {"Outliers left out", shown("outliers", count_text(n.at("outliers")))}});
    return section("form", "Form", element("div", {{"class", "columns"}}, left + right));
}

} // namespace fettle
