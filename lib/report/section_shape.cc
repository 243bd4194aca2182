#include "draw/figures.h"
#include "report/sections.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

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

constexpr double kDegrees = 180 / std::numbers::pi;

/// Distance of a place from the nominal element: across its axis, along its normal, or from its centre.
double distance_to_nominal(const FormReport& actual, const FormReport& nominal)
{
    const Eigen::Vector3d shift = actual.place - nominal.place;
    if (nominal.direction.size() == 0) return shift.norm();
    const Eigen::Vector3d along = nominal.direction.normalized();
    const bool is_flat = nominal.form == "flatness";
    return is_flat ? shift.dot(along) : (shift - along * shift.dot(along)).norm();
}

/// Nominal, actual and deviation of the element of least squares. Without a nominal element only the form error has
/// a nominal value, 0.
draw::Html element_table(const RunFiles& run)
{
    const FormReport& actual = *run.form;
    const FormReport* nominal = run.nominal ? &*run.nominal : nullptr;
    const std::string length = ", " + units::to_string(run.units.length);
    std::vector<std::vector<draw::Html>> rows;
    const auto add = [&](const std::string& name, const std::string& key, std::optional<double> wanted, double found) {
        const draw::Html dash = "\u2013";
        const std::string path = "form.elements." + key;
        rows.push_back({name, wanted ? number_figure(path + ".nominal", *wanted) : dash,
                        number_figure(path + ".actual", found),
                        wanted ? number_figure(path + ".deviation", found - *wanted) : dash});
    };
    const auto of_nominal = [&](auto member) {
        return nominal != nullptr ? std::optional<double>(member(*nominal)) : std::nullopt;
    };
    if (actual.radius)
        add("Diameter" + length, "diameter", of_nominal([](const FormReport& f) { return 2 * f.radius.value_or(0); }),
            2 * *actual.radius);
    const bool is_centre = actual.form == "sphericity";
    for (int axis = 0; is_centre && axis < 3 && actual.place.size() == 3; ++axis)
        add(std::string("Centre ") + "xyz"[axis] + length, std::string("centre.") + "xyz"[axis],
            of_nominal([axis](const FormReport& f) { return f.place[axis]; }), actual.place[axis]);
    if (nominal != nullptr && !is_centre && actual.place.size() == 3 && nominal->place.size() == 3)
        add("Distance from nominal" + length, "distance", 0, distance_to_nominal(actual, *nominal));
    if (nominal != nullptr && actual.direction.size() == 3 && nominal->direction.size() == 3) {
        const Eigen::Vector3d a = actual.direction, b = nominal->direction;
        add("Angle to nominal, \u00B0", "angle", 0, kDegrees * std::atan2(a.cross(b).norm(), std::abs(a.dot(b))));
    }
    add("Form error (minimum zone)" + length, "form_error", 0, actual.numbers.at("minimum_zone"));
    return table("Element of least squares", {"", "Nominal", "Actual", "Deviation"}, rows, 1);
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
    return section("form", "Form", draw::element("div", {{"class", "columns"}}, left + right) + element_table(run));
}

} // namespace fettle::report
