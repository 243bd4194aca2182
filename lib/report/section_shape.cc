#include "draw/figures.h"
#include "report/sections.h"

namespace fettle::report {

namespace {

draw::Html matrix_table(const std::string& key, const Eigen::Matrix4d& matrix, const std::string& caption)
{
    std::vector<std::vector<draw::Html>> rows(4);
    for (Eigen::Index i = 0; i < 4; ++i)
        for (Eigen::Index j = 0; j < 4; ++j)
            rows[std::size_t(i)].push_back(draw::number_element(key + "." + std::to_string(i) + "." + std::to_string(j),
                                                                matrix(i, j), draw::fixed_text(matrix(i, j), 5)));
    return table(caption, {}, rows, 0);
}

/// What the operator compares with the place that was taken. @param unit  after a blank
draw::Html other_place(const OtherPlace& place, const std::string& unit)
{
    const auto number = [&](const std::string& key) {
        return number_figure("alignment.next." + key, place.numbers.at(key));
    };
    const draw::Html numbers =
        property_table({{"Another place fits nearly as well: turned by", number("turn_deg") + "\u00B0"},
                        {"Shifted by", number("shift") + unit},
                        {"Misfit", number("misfit") + unit}});
    const draw::Html matrix =
        matrix_table("alignment.next.transform", place.transform, "Its transform; fettle-align --start begins there");
    return draw::element("div", {{"class", "columns"}}, numbers + matrix);
}

} // namespace

draw::Html registration_section(const RunFiles& run)
{
    if (!run.alignment) return {};
    const NamedNumbers& n = run.alignment->numbers;
    const std::string unit = " " + units::to_string(run.units.length);
    const auto number = [&](const std::string& key) { return number_figure("alignment." + key, n.at(key)); };
    Properties properties = {
        {"Points on the reference",
         draw::number_element("alignment.overlap", n.at("overlap"), draw::fixed_text(100 * n.at("overlap"), 1)) +
             " % of " + count_figure("alignment.count", n.at("count"))},
        {"Distance, median", number("median") + unit},
        {"Distance, 95th percentile", number("p95") + unit},
        {"Distance, root mean square", number("rms") + unit},
        {"Degrees of freedom determined", number("determined") + " of 6"}};
    if (!run.alignment->doubt.empty()) properties.push_back({"Doubtful", run.alignment->doubt});
    const draw::Html numbers = property_table(properties);
    const draw::Html matrix = matrix_table("alignment.transform", run.alignment->transform,
                                           "Transform: reference = matrix \u00B7 scan, lengths in" + unit);
    return section("registration", "Registration",
                   draw::element("div", {{"class", "columns"}}, numbers + matrix) +
                       (run.alignment->other_place ? other_place(*run.alignment->other_place, unit) : draw::Html()));
}

draw::Html form_section(const RunFiles& run)
{
    if (!run.form) return {};
    const NamedNumbers& n = run.form->numbers;
    const std::string unit = " " + units::to_string(run.units.length);
    const auto length = [&](const std::string& key) { return number_figure("form." + key, n.at(key)) + unit; };
    const auto count = [&](const std::string& key) { return count_figure("form." + key, n.at(key)); };
    const draw::Html name = run.form->form + (run.form->parameter.empty() ? "" : " (" + run.form->parameter + ")");
    const draw::Html left = property_table(
        {{"Form error", name}, {"Minimum zone", length("minimum_zone")}, {"Least squares", length("least_squares")}});
    const draw::Html right = property_table({{"Points", count("count")},
                                             {"Points without coordinates", count("dropped")},
                                             {"Outliers, left out", count("outliers")}});
    return section("form", "Form", draw::element("div", {{"class", "columns"}}, left + right));
}

} // namespace fettle::report
