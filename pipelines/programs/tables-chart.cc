// Figures 4-8 and 4-10 of Wang 2007 and the bands of Table 4-5, drawn.

#include "tables-values.h"

#include "cli/tool.h"
#include "draw/canvas.h"
#include "draw/chart.h"
#include "draw/figures.h"

#include <array>
#include <ostream>

using namespace fettle;
using namespace fettle::study;

namespace {

const Eigen::Vector2d kPanel(560, 420);
const std::array<std::string, 6> kCases = {"concave_2x2", "convex_2x2", "saddle_2x2",
                                           "concave_1x1", "convex_1x1", "saddle_1x1"};

Eigen::Matrix2Xd points(const std::vector<std::pair<double, double>>& pairs)
{
    Eigen::Matrix2Xd result(2, static_cast<Eigen::Index>(pairs.size()));
    for (std::size_t i = 0; i < pairs.size(); ++i)
        result.col(static_cast<Eigen::Index>(i)) << pairs[i].first, pairs[i].second;
    return result;
}

void add(draw::Chart& chart, const std::string& name, const std::vector<std::pair<double, double>>& pairs)
{
    chart.curves.push_back({name, points(pairs), draw::curve_colour(chart.curves.size())});
}

draw::Chart min_points(const Values& values)
{
    draw::Chart chart{"Figure 4-8: least estimated points, saddles", "area of the anomaly, in2", "points", {}};
    add(chart, "eq. 4-3: 1 + 0.22 area", {{0, 1}, {100, 23}});
    for (const std::string& radius : kRadii) add(chart, "radius " + radius + " in", min_point_counts(values, radius));
    return chart;
}

draw::Chart strips(const Values& values)
{
    draw::Chart chart{
        "Figure 4-10: touches in strips around the anomaly", "distance from the anomaly, in", "% of the touches", {}};
    constexpr double kStrip = 0.25;
    for (const std::string& name : kCases) {
        std::vector<std::pair<double, double>> shares;
        for (int i = 0; values.contains("climb/" + name + "/strip" + std::to_string(i)); ++i)
            shares.emplace_back((i + 0.5) * kStrip,
                                mean(measured(values, "climb/" + name + "/strip" + std::to_string(i))));
        add(chart, name, shares);
    }
    return chart;
}

draw::Chart bands(const Values& values)
{
    draw::Chart chart{"Table 4-5: bands", "1-3: 2 x 2 in, 4-6: 1 x 1 in; concave, convex, saddle", "band, in", {}};
    const std::array<double, 6> simple = {.1196, .0991, .1658, .0506, .0497, .0615};
    const std::array<double, 6> searched = {.0961, .0790, .1206, .0272, .0112, .0210};
    std::array<std::vector<std::pair<double, double>>, 4> curves;
    for (std::size_t i = 0; i < kCases.size(); ++i) {
        const double x = static_cast<double>(i + 1);
        curves[0].emplace_back(x, simple[i]);
        curves[1].emplace_back(x, quantile(measured(values, "simple/" + kCases[i]), 0.5));
        curves[2].emplace_back(x, searched[i]);
        curves[3].emplace_back(x, mean(measured(values, "best/" + kCases[i] + "/band")));
    }
    const std::array<std::string, 4> names = {"simple, published", "simple", "searched, published", "searched"};
    for (std::size_t k = 0; k < names.size(); ++k) add(chart, names[k], curves[k]);
    double ours = 0, published = 0;
    for (std::size_t i = 0; i < kCases.size(); ++i) {
        ours += curves[3][i].second;
        published += searched[i];
    }
    chart.title += ", searched " + draw::short_text(ours / published) + " of published";
    return chart;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Figures of Wang's tables.", [](cli::Tool& t) {
        const std::string& path = t.main_input("VALUES", "Lines NAME VALUE of the programs tables-*");
        t.reference("Wang 2007, figures 4-8 and 4-10, Table 4-5");
        t.parse();

        const Values values = read_values(path);
        const std::array<draw::Chart, 3> charts = {min_points(values), strips(values), bands(values)};
        draw::Canvas sheet(static_cast<int>(3 * kPanel.x()), static_cast<int>(kPanel.y()));
        for (std::size_t i = 0; i < charts.size(); ++i)
            draw::draw_chart(sheet, {static_cast<double>(i) * kPanel.x(), 0}, kPanel, charts[i]);
        t.output() << sheet.png();
        return cli::Verdict::yes;
    });
}
