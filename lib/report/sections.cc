#include "report/sections.h"

#include "report/figures.h"

#include <algorithm>

namespace fettle {

Html section(const std::string& id, const std::string& heading, const Html& content)
{
    if (content.empty()) return {};
    return element("section", {{"id", id}}, element("h2", heading) + content) + Html::markup("\n");
}

Html facts(const Facts& rows)
{
    Html body;
    for (const auto& [name, value] : rows) body += element("tr", element("th", name) + element("td", value));
    return element("table", {{"class", "facts"}}, element("tbody", body));
}

Html table(const std::string& caption, const std::vector<Html>& names, const std::vector<std::vector<Html>>& rows,
           std::size_t numbers)
{
    const auto row_of = [&](const std::vector<Html>& cells, bool heading) {
        Html row;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const Attributes right = i >= numbers ? Attributes{{"class", "number"}} : Attributes{};
            row += element(heading || i < std::min<std::size_t>(numbers, 1) ? "th" : "td", right, cells[i]);
        }
        return element("tr", row);
    };
    Html body;
    for (const std::vector<Html>& cells : rows) body += row_of(cells, false);
    Html content = caption.empty() ? Html() : element("caption", caption);
    if (!names.empty()) content += element("thead", row_of(names, true));
    content += element("tbody", body);
    return element("div", {{"class", "scroll"}}, element("table", content));
}

Html drawing_with_caption(const Html& drawing, const std::string& caption)
{
    if (drawing.empty()) return {};
    return element("figure", drawing + (caption.empty() ? Html() : element("figcaption", caption)));
}

Html length_figure(const std::string& key, double mm, const Units& units)
{
    const double value = mm / units.mm();
    return figure(key, value, short_text(value)) + " " + to_string(units.length);
}

Html force_figure(const std::string& key, double newton, const Units& units)
{
    const double value = newton / units.newton();
    return figure(key, value, short_text(value)) + " " + to_string(units.force);
}

} // namespace fettle
