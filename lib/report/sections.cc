#include "report/sections.h"

#include "draw/figures.h"

#include <algorithm>

namespace fettle::report {

draw::Html section(const std::string& id, const std::string& heading, const draw::Html& content)
{
    if (content.empty()) return {};
    return draw::element("section", {{"id", id}}, draw::element("h2", heading) + content) +
           draw::Html::from_markup("\n");
}

draw::Html property_table(const Properties& rows)
{
    draw::Html body;
    for (const auto& [name, value] : rows)
        body += draw::element("tr", draw::element("th", name) + draw::element("td", value));
    return draw::element("table", {{"class", "facts"}}, draw::element("tbody", body));
}

draw::Html table(const std::string& caption, const std::vector<draw::Html>& names,
                 const std::vector<std::vector<draw::Html>>& rows, std::size_t numbers)
{
    const auto row_of = [&](const std::vector<draw::Html>& cells, bool heading) {
        draw::Html row;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const draw::Attributes right = i >= numbers ? draw::Attributes{{"class", "number"}} : draw::Attributes{};
            row += draw::element(heading || i < std::min<std::size_t>(numbers, 1) ? "th" : "td", right, cells[i]);
        }
        return draw::element("tr", row);
    };
    draw::Html body;
    for (const std::vector<draw::Html>& cells : rows) body += row_of(cells, false);
    draw::Html content = caption.empty() ? draw::Html() : draw::element("caption", caption);
    if (!names.empty()) content += draw::element("thead", row_of(names, true));
    content += draw::element("tbody", body);
    return draw::element("div", {{"class", "scroll"}}, draw::element("table", content));
}

draw::Html drawing_with_caption(const draw::Html& drawing, const std::string& caption)
{
    if (drawing.empty()) return {};
    return draw::element("figure", drawing + (caption.empty() ? draw::Html() : draw::element("figcaption", caption)));
}

draw::Html number_figure(const std::string& key, double value)
{
    return draw::number_element(key, value, draw::short_text(value));
}

draw::Html count_figure(const std::string& key, double count)
{
    return draw::number_element(key, count, draw::count_text(count));
}

draw::Html length_figure(const std::string& key, double mm, const units::Units& units)
{
    return number_figure(key, mm / units.mm()) + " " + units::to_string(units.length);
}

draw::Html force_figure(const std::string& key, double newton, const units::Units& units)
{
    return number_figure(key, newton / units.newton()) + " " + units::to_string(units.force);
}

} // namespace fettle::report
