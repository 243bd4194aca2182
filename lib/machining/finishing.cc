#include "machining/finishing.h"

#include "core/error.h"
#include "core/text.h"
#include "machining/drop_cutter.h"
#include "machining/nc_writer.h"
#include "machining/straight_way.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <span>

namespace fettle {
namespace {

/// Points of a pass in a step-over: chords of this length stand off a surface by a ninth of what the passes leave.
constexpr double kPointsPerStep = 3;
constexpr double kMostPoints = 1e8;
/// How far straight moves may be from where the cutter touches: a twentieth of the finest tolerance in use, mm.
constexpr double kChord = 0.005;
/// Points are no nearer to each other than half of this, mm: a tenth of the finest cells in use.
constexpr double kFinest = 0.01;
using Line = std::vector<std::optional<Eigen::Vector3d>>; ///< of tips; nothing where the cutter meets nothing

class Path {
  public:
    Path(double safe, double feed) : safe_(safe), feed_(feed) {}

    /// Goes along a line, through the air where there is nothing.
    void follow(const Line& line)
    {
        for (std::size_t i = 0; i < line.size(); ++i) {
            std::vector<Eigen::Vector3d> touched;
            for (; i < line.size() && line[i]; ++i) touched.push_back(*line[i]);
            for (std::size_t k = 0; k < touched.size(); ++k) {
                reach(touched[k]);
                if (k + 1 == touched.size()) break;
                k += straight_to(std::span(touched).subspan(k)) - 1;
            }
            if (i < line.size()) lift();
        }
    }
    void lift()
    {
        if (!points.empty() && points.back().tip.z() < safe_)
            add({points.back().tip.x(), points.back().tip.y(), safe_}, 0);
    }

    std::vector<TipPoint> points;

  private:
    void add(const Eigen::Vector3d& tip, double feed) { points.push_back({tip, feed}); }
    void reach(const Eigen::Vector3d& tip)
    {
        const bool above = points.empty() || points.back().tip.z() >= safe_;
        if (above) add({tip.x(), tip.y(), safe_}, 0);
        if (points.back().tip != tip) add(tip, feed_);
    }

    double safe_, feed_;
};

/// Puts tips between two others, until the way between neighbours is no lower than the cutter may be by more than
/// kChord. At a jump, over the rim of a wall, that never is so: there the tip goes straight up or down beside it.
void refine(Line& line, const DropCutter& drop, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
            double allowance)
{
    const Eigen::Vector3d middle = (from + to) / 2;
    const auto touch = drop(middle.head<2>());
    if (!touch) return;
    const Eigen::Vector3d tip(middle.x(), middle.y(), touch->z + allowance);
    if (std::abs(tip.z() - middle.z()) <= kChord) return;
    if ((to - from).head<2>().norm() > kFinest) {
        refine(line, drop, from, tip, allowance);
        line.push_back(tip);
        refine(line, drop, tip, to, allowance);
    } else {
        const bool up = to.z() > from.z();
        const Eigen::Vector3d& low = up ? from : to;
        line.push_back(Eigen::Vector3d(low.x(), low.y(), std::max({from.z(), to.z(), tip.z()})));
    }
}

/// Lines of tips along the passes, in turn forwards and backwards, and between their ends.
std::vector<Line> touched_lines(const Mesh& design, const Cutter& cutter, const FinishingOptions& options)
{
    const Eigen::Vector2d u(std::cos(options.angle), std::sin(options.angle)), v(-u.y(), u.x());
    Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& vertex : design.vertices.colwise()) {
        const Eigen::Array2d at(u.dot(vertex.head<2>()), v.dot(vertex.head<2>()));
        low = low.min(at);
        high = high.max(at);
    }
    low -= options.overhang;
    high += options.overhang;
    const Eigen::Array2d size = high - low;
    const double along = options.step_over / kPointsPerStep;
    const double passes = std::ceil(size.y() / options.step_over) + 1, points = std::ceil(size.x() / along) + 1;
    if (!(passes * points <= kMostPoints))
        throw InputError("a step-over of " + to_text(options.step_over) + " mm makes " +
                         to_short_text(passes * points) + " points; at most " + to_short_text(kMostPoints) +
                         " are possible");
    const auto across_at = [&](double pass) { return low.y() + size.y() * (passes > 1 ? pass / (passes - 1) : 0.5); };
    const auto along_at = [&](double point) { return low.x() + size.x() * (points > 1 ? point / (points - 1) : 0.5); };
    const DropCutter drop(design, cutter);
    const auto tip = [&](double a, double b) -> std::optional<Eigen::Vector3d> {
        const Eigen::Vector2d xy = a * u + b * v;
        const auto touch = drop(xy);
        if (!touch) return std::nullopt;
        return Eigen::Vector3d(xy.x(), xy.y(), touch->z + options.allowance);
    };
    std::vector<Line> lines(static_cast<std::size_t>(passes));
    tbb::parallel_for(std::size_t{0}, lines.size(), [&](std::size_t p) {
        const bool forwards = p % 2 == 0;
        const double b = across_at(static_cast<double>(p));
        Line coarse;
        for (double k = 0; k < points; ++k) coarse.push_back(tip(along_at(forwards ? k : points - 1 - k), b));
        if (p + 1 < lines.size()) {
            const double end = along_at(forwards ? points - 1 : 0), next = across_at(static_cast<double>(p + 1));
            for (double k = 1; k <= kPointsPerStep; ++k)
                coarse.push_back(tip(end, b + (next - b) * k / kPointsPerStep));
        }
        for (std::size_t i = 0; i < coarse.size(); ++i) {
            lines[p].push_back(coarse[i]);
            if (i + 1 < coarse.size() && coarse[i] && coarse[i + 1])
                refine(lines[p], drop, *coarse[i], *coarse[i + 1], options.allowance);
        }
    });
    return lines;
}

} // namespace

double step_over_for(double scallop, const Cutter& cutter, const DesignShape& shape)
{
    if (cutter.corner == 0)
        throw InputError("a cutter without ball or corner leaves no scallops by which passes could be spaced");
    const double radius = 1 / (1 / cutter.corner + 1 / shape.convex_radius), height = std::min(scallop, radius);
    return 2 * std::sqrt(height * (2 * radius - height)) * std::cos(shape.slope);
}

double overhang_for(const Cutter& cutter, const DesignShape& shape)
{
    return shape.slope > 0 ? cutter.flat + cutter.corner * std::sin(shape.slope) : 0;
}

std::vector<TipPoint> finishing_path(const Mesh& design, const Cutter& cutter, const FinishingOptions& options)
{
    const auto lines = touched_lines(design, cutter, options);
    Line whole; // so that a straight move may go on from one pass to the next
    for (const Line& line : lines) whole.insert(whole.end(), line.begin(), line.end());
    Path path(design.vertices.row(2).maxCoeff() + options.allowance + options.clearance, options.feed);
    path.follow(whole);
    path.lift();
    if (path.points.empty()) throw InputError("the cutter touches nothing of the design");
    return std::move(path.points);
}

Cloud to_cloud(const std::vector<TipPoint>& path)
{
    Cloud cloud;
    cloud.xyz.resize(3, static_cast<Eigen::Index>(path.size()));
    Eigen::VectorXd feeds(cloud.xyz.cols());
    for (std::size_t i = 0; i < path.size(); ++i) {
        cloud.xyz.col(static_cast<Eigen::Index>(i)) = path[i].tip;
        feeds[static_cast<Eigen::Index>(i)] = path[i].feed;
    }
    set_field(cloud, "feed", feeds);
    return cloud;
}

void write_gcode(std::ostream& out, const std::vector<TipPoint>& path, const std::string& title)
{
    out << "%\n(" << title << ")\nG21 G90 G17 G94\n";
    NcWriter writer(out);
    for (const TipPoint& point : path) writer.go(point.tip, point.feed);
    out << "M30\n%\n";
}

} // namespace fettle
