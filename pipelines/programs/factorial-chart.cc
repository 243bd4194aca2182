// Figure 4-14 of Wang 2007: how band and shift depend on the shape and size of the anomaly, on the sampling distance
// and on the curvature; for one kind of surface of the factorial experiment.

#include "factorial.h"

#include "cli/tool.h"
#include "draw/canvas.h"
#include "draw/chart.h"
#include "draw/figures.h"

#include <array>
#include <functional>
#include <ostream>

using namespace fettle;
using namespace factorial;

namespace {

const Eigen::Vector2d kPanel(560, 350); // pixels

using Number = std::function<double(const Cell&)>;

/// Medians of y over the cells of equal x, ascending.
Eigen::Matrix2Xd medians(const Cells& cells, const Number& x, const Number& y)
{
    std::map<double, std::vector<double>> columns;
    for (const Cell& cell : cells) columns[x(cell)].push_back(y(cell));
    Eigen::Matrix2Xd points(2, std::ssize(columns));
    Eigen::Index i = 0;
    for (const auto& [at, values] : columns) points.col(i++) << at, median(values);
    return points;
}

Cells chosen(const Cells& cells, const std::function<bool(const Cell&)>& wanted)
{
    Cells result;
    std::copy_if(cells.begin(), cells.end(), std::back_inserter(result), wanted);
    return result;
}

draw::Chart panel(const std::string& title, const std::string& x_label)
{
    draw::Chart chart;
    chart.title = title;
    chart.x_label = x_label;
    chart.y_label = "in, median of the cells";
    chart.logarithmic = true;
    return chart;
}

/// Bands and shifts of Wang's method, of the default and as published.
draw::Chart by_methods(const std::string& title, const std::string& x_label, const Kind& kind, const Cells& cells,
                       const Number& x)
{
    draw::Chart chart = panel(title, x_label);
    const auto add = [&](const std::string& name, const Number& y) {
        chart.curves.push_back({name, medians(cells, x, y), draw::curve_colour(chart.curves.size())});
    };
    for (const Quantity quantity : {band, shift}) {
        const std::string what = quantity == band ? ", band" : ", shift";
        add("published" + what, [&, quantity](const Cell& cell) { return cell.published(kind, quantity); });
        add(kind.method + what, [&, quantity](const Cell& cell) { return cell.error(kind.method, quantity); });
        add("auto" + what, [quantity](const Cell& cell) { return cell.error("auto", quantity); });
    }
    return chart;
}

/// What the figure shows, for its headline.
std::string finding(const Kind& kind, const Cells& cells)
{
    std::vector<double> ours, published;
    for (const Cell& cell : cells) {
        ours.push_back(cell.error("auto", band));
        published.push_back(cell.published(kind, band));
    }
    return "the default's band is " + draw::short_text(median(ours) / median(published)) + " of the published";
}

/// Wang's method over the shape, for the areas that the experiment has in several shapes.
draw::Chart by_shape(const Kind& kind, const Cells& cells)
{
    draw::Chart chart = panel("(a) shape, " + kind.method, "longer side over shorter side");
    struct Areas {
        std::string name;
        double min, max; ///< in², nearly the same
    };
    const std::array<Areas, 3> areas = {{{"10 in2", 9.9, 10.6}, {"32 in2", 30, 33}, {"57 in2", 55, 61}}};
    for (const Quantity quantity : {band, shift})
        for (const Areas& area : areas)
            chart.curves.push_back(
                {area.name + (quantity == band ? ", band" : ", shift"),
                 medians(
                     chosen(cells, [&](const Cell& c) { return c.area() >= area.min && c.area() <= area.max; }),
                     [](const Cell& cell) { return cell.slimness(); },
                     [&](const Cell& cell) { return cell.error(kind.method, quantity); }),
                 draw::curve_colour(chart.curves.size())});
    return chart;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Figure 4-14 of Wang's factorial experiment, for one kind of surface.", [](cli::Tool& t) {
            std::vector<std::string> names;
            for (const auto& [name, kind] : kinds()) names.push_back(name);
            const std::string& surface = t.positional_choice("SURFACE", names, "Kind of surface");
            const std::string& path = t.main_input("CELLS", "Batches of the program factorial, merged");
            t.reference("Wang 2007, figure 4-14");
            t.parse();

            const Kind& kind = kinds().at(surface);
            const Cells cells = read_study(path).surfaces[surface];
            const Cells squares = chosen(cells, [](const Cell& cell) { return cell.width == cell.length; });
            const std::array<draw::Chart, 4> charts = {
                by_shape(kind, cells),
                by_methods("(b) farthest sampling distance", "distance, in", kind, cells,
                           [](const Cell& cell) { return cell.distance; }),
                by_methods("(c) area, squares", "area, in2", kind, squares,
                           [](const Cell& cell) { return cell.area(); }),
                by_methods("(d) curvature", "curvature, 1/in", kind, cells,
                           [](const Cell& cell) { return 1 / cell.radius; }),
            };
            constexpr double kHead = 30;
            draw::Canvas sheet(static_cast<int>(2 * kPanel.x()), static_cast<int>(2 * kPanel.y() + kHead));
            sheet.text("Wang 2007, figure 4-14: " + surface + ", " + std::to_string(cells.size()) +
                           " cells: " + finding(kind, cells),
                       {kPanel.x(), 18}, 14, draw::Canvas::kInk, draw::Canvas::Align::centre, true);
            for (std::size_t i = 0; i < charts.size(); ++i)
                draw::draw_chart(sheet, Eigen::Vector2d(i % 2 ? kPanel.x() : 0, (i / 2 ? kPanel.y() : 0) + kHead),
                                 kPanel, charts[i]);
            t.output() << sheet.png();
            return cli::Verdict::yes;
        });
}
