// Figure 5-8 of Wang 2007: how an anomaly goes, stage by stage, with the paths of the wheel in each layer; below,
// layer, force and feed over the time.

#include "cli/tool.h"
#include "cloud/pcd.h"
#include "draw/canvas.h"
#include "draw/chart.h"
#include "draw/figures.h"
#include "job/boundary.h"
#include "plan/plan.h"
#include "removal/height_field.h"
#include "strategy/trace.h"
#include "strategy/trace_file.h"

#include <cmath>
#include <ostream>

using namespace fettle;

namespace {

using Eigen::Vector2d;

constexpr int kStages = 6, kColumns = 3;
const Vector2d kPanel(270, 252), kTimes(830, 220); // pixels
constexpr double kHead = 56, kGap = 12;
constexpr double kRim = 20; // cells around B: on a slope the tool point lies beside the contact
// The trace is replayed in so many pieces to find the stages.
constexpr std::size_t kPieces = 120;

/// Rows first … end of the trace, and the stock after them.
struct Stage {
    std::size_t first, end;
    removal::HeightField stock;
};

/// The beginning, and ends of equal shares of the removed volume.
std::vector<Stage> stages(const std::vector<strategy::TraceRow>& rows, const job::Job& job,
                          const removal::HeightField& stock)
{
    const double whole = removal::volume_between(stock, strategy::replay_removal(rows, job, stock));
    std::vector<Stage> result = {{0, 0, stock}};
    removal::HeightField now = stock;
    const std::size_t piece = std::max<std::size_t>(rows.size() / kPieces, 1);
    for (std::size_t i = 0; i + 1 < rows.size(); i += piece) {
        const std::size_t end = std::min(i + piece, rows.size() - 1);
        now = strategy::replay_removal({rows.begin() + std::ptrdiff_t(i), rows.begin() + std::ptrdiff_t(end + 1)}, job,
                                       now);
        const double due = whole * double(result.size()) / (kStages - 1);
        const bool last = end + 1 == rows.size();
        if (last || (std::ssize(result) < kStages - 1 && removal::volume_between(stock, now) >= due))
            result.push_back({result.back().end, end + 1, now});
    }
    return result;
}

/// Places of W on a panel: the cells around B.
struct Map {
    Vector2d corner, size, origin; ///< pixels; mm
    double scale;                  ///< pixels per mm
    Eigen::Index first_column, columns, first_row, rows;

    Map(const Vector2d& where, const removal::HeightField& stock, const job::Polygon& anomaly) : corner(where)
    {
        const Vector2d min_cell = (anomaly.rowwise().minCoeff() - stock.origin) / stock.cell;
        const Vector2d max_cell = (anomaly.rowwise().maxCoeff() - stock.origin) / stock.cell;
        first_column = Eigen::Index(std::max(min_cell.x() - kRim, 0.0));
        first_row = Eigen::Index(std::max(min_cell.y() - kRim, 0.0));
        columns = std::min(Eigen::Index(max_cell.x() + kRim), stock.columns()) - first_column;
        rows = std::min(Eigen::Index(max_cell.y() + kRim), stock.rows()) - first_row;
        origin = stock.origin + stock.cell * Vector2d(double(first_column), double(first_row));
        const Vector2d extent = stock.cell * Vector2d(double(columns), double(rows));
        scale = ((kPanel - Vector2d(kGap, 2 * kGap + 10)).array() / extent.array()).minCoeff();
        size = extent * scale;
    }
    Vector2d operator()(const Vector2d& at) const
    {
        const Vector2d d = (at - origin) * scale;
        return corner + Vector2d(d.x(), size.y() - d.y());
    }
};

void draw_heights(draw::Canvas& sheet, const Map& map, const removal::HeightField& stock,
                  const Eigen::ArrayXXd& desired, double max_cell)
{
    std::vector<std::uint8_t> rgb;
    for (Eigen::Index j = map.first_row + map.rows - 1; j >= map.first_row; --j)
        for (Eigen::Index i = map.first_column; i < map.first_column + map.columns; ++i) {
            const double over = (stock.z(i, j) - desired(i, j)) / max_cell;
            // 34 steps: more than the eye distinguishes, and a third of the picture's bytes.
            const double grey = std::isfinite(over) ? 250 - 5 * std::round(34 * std::clamp(over, 0.0, 1.0)) : 250;
            rgb.insert(rgb.end(), 3, std::uint8_t(grey));
        }
    sheet.image(map.corner, map.size, int(map.columns), rgb);
}

/// Layer 1 is blue, those above it go from yellow to purple, so that no two of many are alike.
draw::Rgb layer_colour(int layer, int highest)
{
    const Eigen::Array3d low = {240, 175, 20}, high = {110, 0, 120};
    if (layer <= 1) return draw::curve_colour(0);
    const double share = highest > 2 ? double(layer - 2) / double(highest - 2) : 0;
    const Eigen::Array3d colour = low + share * (high - low);
    return {static_cast<std::uint8_t>(colour[0]), static_cast<std::uint8_t>(colour[1]),
            static_cast<std::uint8_t>(colour[2])};
}

void draw_paths(draw::Canvas& sheet, const Map& map, const std::vector<strategy::TraceRow>& rows, const Stage& stage,
                const Eigen::Matrix2d& R_working_machine, int highest)
{
    for (std::size_t i = std::max<std::size_t>(stage.first, 1); i < stage.end; ++i) {
        if (!(rows[i].feed > 0)) continue;
        Eigen::Matrix2Xd line(2, 2);
        line.col(0) = map(R_working_machine * rows[i - 1].tool.head<2>());
        line.col(1) = map(R_working_machine * rows[i].tool.head<2>());
        sheet.line(line, layer_colour(rows[i].layer, highest), rows[i].layer > 1 ? 2 : 1);
    }
}

draw::Chart over_time(const std::vector<strategy::TraceRow>& rows, const units::Units& units)
{
    draw::Chart chart;
    chart.title =
        "force (" + units::to_string(units.force) + "), feed (" + units::to_string(units.length) + "/s) and layer";
    chart.x_label = "time, s";
    const auto add = [&](const std::string& name, const auto& value) {
        draw::Curve curve{name, Eigen::Matrix2Xd(2, std::ssize(rows)), draw::curve_colour(chart.curves.size()), false};
        for (std::size_t i = 0; i < rows.size(); ++i) curve.points.col(Eigen::Index(i)) << rows[i].time, value(rows[i]);
        chart.curves.push_back(curve);
    };
    add("force", [&](const strategy::TraceRow& row) { return row.force / units.newton(); });
    add("layer", [](const strategy::TraceRow& row) { return double(row.layer); });
    add("feed", [&](const strategy::TraceRow& row) { return row.feed / units.mm(); });
    return chart;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "How an anomaly goes, stage by stage.", [](cli::Tool& t) {
        const std::string& plan_file = t.main_input("PLAN", "What fettle-plan wrote");
        const std::string& stock_file = t.required_text("--stock", "PART", "The part as it was");
        const std::string& trace_file = t.required_text("--trace", "FILE", "What fettle-grind did");
        const std::string& title = t.text("--title", "", "TEXT", "Name of the part");
        t.reference("Wang 2007, figure 5-8");
        t.parse();

        const plan::Plan plan = plan::read_plan(plan_file);
        const removal::HeightField stock = removal::stock_from_scan(sampling::read_scan(stock_file, plan.job, {}),
                                                                    plan.job, plan.job.wheel.width / 32, stock_file);
        const std::vector<strategy::TraceRow> rows = strategy::read_trace(trace_file, plan.job.units);
        const Eigen::Matrix2d R_working_machine = job::rotation_working_machine(plan.job.theta);
        Eigen::ArrayXXd desired(stock.columns(), stock.rows());
        for (Eigen::Index j = 0; j < stock.rows(); ++j)
            for (Eigen::Index i = 0; i < stock.columns(); ++i)
                desired(i, j) = surface::height(plan.surface, R_working_machine.transpose() * stock.centre(i, j));
        const Eigen::ArrayXXd over = stock.z - desired;
        const double max_cell = over.isFinite().select(over, 0).maxCoeff();
        const job::Polygon anomaly = job::working_boundaries(plan.job).anomaly;

        const std::vector<Stage> shown = stages(rows, plan.job, stock);
        draw::Canvas sheet(int(kTimes.x() + 2 * kGap), int(kHead + 2 * kPanel.y() + kTimes.y()));
        int highest = 1;
        double peak = 0;
        for (const strategy::TraceRow& row : rows) {
            highest = std::max(highest, row.layer);
            peak = std::max(peak, row.force);
        }
        const double newton = plan.job.units.newton();
        sheet.text("Wang 2007, figure 5-8: " + title + " in " + std::to_string(highest) + " layers, with " +
                       draw::short_text(peak / newton) + " of " + draw::short_text(plan.job.force.max / newton) + " " +
                       units::to_string(plan.job.units.force) + " at most",
                   {kGap, 18}, 14, draw::Canvas::kInk, draw::Canvas::Align::left, true);
        for (int layer = 1; layer <= highest; ++layer)
            sheet.text("layer " + std::to_string(layer), {kGap + 80 * (layer - 1), 42}, 11,
                       layer_colour(layer, highest));
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const Vector2d corner(kGap + double(k % kColumns) * kPanel.x(), kHead + double(k / kColumns) * kPanel.y());
            const double time = shown[k].end ? rows[shown[k].end - 1].time : 0;
            sheet.text(k ? "after " + std::to_string(std::lround(time)) + " s" : "before", corner + Vector2d(0, 8), 11);
            const Map map(corner + Vector2d(0, 20), stock, anomaly);
            draw_heights(sheet, map, shown[k].stock, desired, max_cell);
            draw_paths(sheet, map, rows, shown[k], R_working_machine, highest);
            Eigen::Matrix2Xd outline = anomaly;
            for (Eigen::Index i = 0; i < outline.cols(); ++i) outline.col(i) = map(anomaly.col(i));
            sheet.line(outline, draw::Canvas::kInk, 1.5, true);
        }
        draw::draw_chart(sheet, {kGap, kHead + 2 * kPanel.y()}, kTimes, over_time(rows, plan.job.units));
        t.output() << sheet.png();
        return cli::Verdict::yes;
    });
}
