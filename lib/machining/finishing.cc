#include "machining/finishing.h"

#include "core/constants.h"
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

namespace fettle::machining {
namespace {

/// Points of a pass per step-over: the sag of chords of this length is a ninth of the scallop height.
constexpr double kPointsPerStepOver = 3;
constexpr double kMaxPoints = 1e8;
/// Largest deviation of a straight move from the tips that touch, mm: a twentieth of the finest tolerance in use.
constexpr double kChordTolerance = 0.005;
/// Moves shorter than this are not halved, mm: a tenth of the finest cells in use.
constexpr double kMinSplitLength = 0.01;
using TipLine = std::vector<std::optional<Eigen::Vector3d>>; ///< tips; nothing where the cutter misses the design

class PathBuilder {
  public:
    PathBuilder(double safe_z, double feed) : safe_z_(safe_z), feed_(feed) {}

    /// Appends the tips of a line, thinned. Gaps are crossed by rapid moves at the safe height.
    void append(const TipLine& line)
    {
        for (std::size_t i = 0; i < line.size(); ++i) {
            std::vector<Eigen::Vector3d> touched;
            for (; i < line.size() && line[i]; ++i) touched.push_back(*line[i]);
            for (std::size_t k = 0; k < touched.size(); ++k) {
                cut_to(touched[k]);
                if (k + 1 == touched.size()) break;
                k += last_on_line(std::span(touched).subspan(k)) - 1;
            }
            if (i < line.size()) retract();
        }
    }
    void retract()
    {
        if (!points.empty() && points.back().tip.z() < safe_z_)
            add({points.back().tip.x(), points.back().tip.y(), safe_z_}, 0);
    }

    std::vector<TipPoint> points;

  private:
    void add(const Eigen::Vector3d& tip, double feed) { points.push_back({tip, feed}); }
    void cut_to(const Eigen::Vector3d& tip)
    {
        const bool retracted = points.empty() || points.back().tip.z() >= safe_z_;
        if (retracted) add({tip.x(), tip.y(), safe_z_}, 0);
        if (points.back().tip != tip) add(tip, feed_);
    }

    double safe_z_, feed_;
};

/// Inserts tips between two others by bisection, until the middle of each straight move is within kChordTolerance of
/// the tip that touches. At a step of the design, such as the rim of a wall, that never happens: there the move becomes
/// vertical beside the step.
void refine(TipLine& line, const DropCutter& drop, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
            double allowance)
{
    const Eigen::Vector3d middle = (from + to) / 2;
    const auto touch = drop(middle.head<2>());
    if (!touch) return;
    const Eigen::Vector3d tip(middle.x(), middle.y(), touch->z + allowance);
    if (std::abs(tip.z() - middle.z()) <= kChordTolerance) return;
    if ((to - from).head<2>().norm() > kMinSplitLength) {
        refine(line, drop, from, tip, allowance);
        line.push_back(tip);
        refine(line, drop, tip, to, allowance);
    } else {
        const Eigen::Vector3d& low = to.z() > from.z() ? from : to;
        line.push_back(Eigen::Vector3d(low.x(), low.y(), std::max({from.z(), to.z(), tip.z()})));
    }
}

/// Tips along the passes, forwards and backwards alternately, each followed by the link to the next pass.
std::vector<TipLine> tip_lines(const mesh::Mesh& design, const Cutter& cutter, const FinishingOptions& options)
{
    const Eigen::Vector2d u(std::cos(options.angle), std::sin(options.angle)), v(-u.y(), u.x());
    Eigen::Array2d low = Eigen::Array2d::Constant(core::kInfinity), high = -low;
    for (const auto& vertex : design.vertices.colwise()) {
        const Eigen::Array2d uv(u.dot(vertex.head<2>()), v.dot(vertex.head<2>()));
        low = low.min(uv);
        high = high.max(uv);
    }
    low -= options.overhang;
    high += options.overhang;
    const Eigen::Array2d size = high - low;
    const double along = options.step_over / kPointsPerStepOver;
    const double passes = std::ceil(size.y() / options.step_over) + 1, points = std::ceil(size.x() / along) + 1;
    if (!(passes * points <= kMaxPoints))
        throw core::InputError("a step-over of " + core::to_text(options.step_over) + " mm makes " +
                               core::to_short_text(passes * points) + " points; at most " +
                               core::to_short_text(kMaxPoints) + " are possible");
    const auto across_at = [&](double pass) { return low.y() + size.y() * (passes > 1 ? pass / (passes - 1) : 0.5); };
    const auto along_at = [&](double point) { return low.x() + size.x() * (points > 1 ? point / (points - 1) : 0.5); };
    const DropCutter drop(design, cutter);
    const auto tip = [&](double a, double b) -> std::optional<Eigen::Vector3d> {
        const Eigen::Vector2d xy = a * u + b * v;
        const auto touch = drop(xy);
        if (!touch) return std::nullopt;
        return Eigen::Vector3d(xy.x(), xy.y(), touch->z + options.allowance);
    };
    std::vector<TipLine> lines(passes);
    tbb::parallel_for(std::size_t{0}, lines.size(), [&](std::size_t p) {
        const bool forwards = p % 2 == 0;
        const double b = across_at(p);
        TipLine coarse;
        for (double k = 0; k < points; ++k) coarse.push_back(tip(along_at(forwards ? k : points - 1 - k), b));
        if (p + 1 < lines.size()) {
            const double end = along_at(forwards ? points - 1 : 0), next = across_at(p + 1);
            for (double k = 1; k <= kPointsPerStepOver; ++k)
                coarse.push_back(tip(end, b + (next - b) * k / kPointsPerStepOver));
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
        throw core::InputError("a cutter without ball or corner leaves no scallops by which passes could be spaced");
    const double radius = 1 / (1 / cutter.corner + 1 / shape.convex_radius), height = std::min(scallop, radius);
    return 2 * std::sqrt(height * (2 * radius - height)) * std::cos(shape.slope);
}

double overhang_for(const Cutter& cutter, const DesignShape& shape)
{
    return shape.slope > 0 ? cutter.flat + cutter.corner * std::sin(shape.slope) : 0;
}

std::vector<TipPoint> finishing_path(const mesh::Mesh& design, const Cutter& cutter, const FinishingOptions& options)
{
    TipLine all; // joined, so that a straight move may continue from a pass into the link to the next
    for (const TipLine& line : tip_lines(design, cutter, options)) all.insert(all.end(), line.begin(), line.end());
    PathBuilder path(design.vertices.row(2).maxCoeff() + options.allowance + options.clearance, options.feed);
    path.append(all);
    path.retract();
    if (path.points.empty()) throw core::InputError("the cutter does not touch the design anywhere");
    return std::move(path.points);
}

cloud::Cloud to_cloud(const std::vector<TipPoint>& path)
{
    cloud::Cloud cloud;
    cloud.xyz.resize(3, path.size());
    Eigen::VectorXd feeds(cloud.xyz.cols());
    for (std::size_t i = 0; i < path.size(); ++i) {
        cloud.xyz.col(i) = path[i].tip;
        feeds[i] = path[i].feed;
    }
    cloud::set_field(cloud, "feed", feeds);
    return cloud;
}

void write_gcode(std::ostream& out, const std::vector<TipPoint>& path, const std::string& title)
{
    out << "%\n(" << title << ")\nG21 G90 G17 G94\n";
    NcWriter writer(out);
    for (const TipPoint& point : path) writer.move_to(point.tip, point.feed);
    out << "M30\n%\n";
}

} // namespace fettle::machining
