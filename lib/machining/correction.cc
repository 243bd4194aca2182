#include "machining/correction.h"

#include "machining/drop_cutter.h"
#include "machining/straight_way.h"
#include "mesh/mesh_index.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace fettle::machining {
namespace {

using Eigen::Vector3d;

enum class TipState { correct, shifted, held, in_air, unknown };

/// A sample of a feed move, and its correction.
struct Tip {
    Vector3d position;
    double travelled = 0; ///< distance along the path, mm
    Vector3d shift = Vector3d::Zero();
    TipState state = TipState::unknown;
};

/// Side of a cell of the machined grid, mm: each cell is two triangles.
double grid_step(const mesh::Mesh& mesh)
{
    double area = 0;
    for (const auto& t : mesh.triangles.colwise()) {
        const Eigen::Vector2d a = mesh.vertices.col(t[0]).head<2>();
        const Eigen::Vector2d b = mesh.vertices.col(t[1]).head<2>() - a, c = mesh.vertices.col(t[2]).head<2>() - a;
        area += std::abs(b.x() * c.y() - b.y() * c.x());
    }
    return std::sqrt(area / std::max<Eigen::Index>(mesh.triangles.cols(), 1));
}

class TipCorrection {
  public:
    TipCorrection(const Cutter& cutter, const mesh::Mesh& machined, const mesh::Mesh& design, const PatchErrors& errors,
                  double reach)
        : cutter_(cutter), machined_(machined), index_(machined), drop_(design, cutter), errors_(errors), reach_(reach)
    {
    }

    /// Sets state and shift by the error where the cutter touches the design.
    void set_shift(Tip& tip) const
    {
        const auto touch = drop_(tip.position.head<2>());
        if (!touch) return;
        const auto below = index_.highest(touch->contact.x(), touch->contact.y());
        if (!below) return;
        const Eigen::Index t = below->triangle;
        if (std::isnan(errors_.mu[t])) return;
        const Vector3d normal = errors_.normal.col(t);
        const double distance = (touch->contact - tip.position).head<2>().norm();
        const double lower_side = tip.position.z() + rise(cutter_, std::min(distance, cutter_.radius));
        const double mu = normal.z() * z_error(t, below->point);
        tip.state = TipState::correct;
        if ((lower_side - below->point.z()) * normal.z() > reach_) {
            tip.state = TipState::in_air;
        } else if (std::abs(mu) > kThinningTolerance) { // append() would drop smaller shifts
            tip.state = TipState::shifted;
            tip.shift = -mu * normal;
        }
    }

    /// Lifts a shifted tip out of the design. If that takes more than `reach`, the shift runs into a wall or a narrow
    /// corner; then the tip moves straight up or down instead, until the cutter touches.
    void prevent_gouging(Tip& tip) const
    {
        if (tip.shift.isZero(0)) return;
        const Vector3d wanted = tip.position + tip.shift;
        const auto touch = drop_(wanted.head<2>());
        if (!touch || touch->z <= wanted.z()) return;
        if (touch->z - wanted.z() <= reach_) {
            tip.shift.z() += touch->z - wanted.z();
            return;
        }
        tip.state = TipState::held;
        const auto below = drop_(tip.position.head<2>());
        const double vertical = tip.shift.z() == 0 ? 0 : tip.shift.squaredNorm() / tip.shift.z(); // -mu/N·Z
        tip.shift = Vector3d(0, 0, below ? std::max(vertical, below->z - tip.position.z()) : 0);
    }

  private:
    /// Linear interpolation between the corners of a machined triangle.
    double z_error(Eigen::Index t, const Vector3d& point) const
    {
        const Eigen::Vector3i corners = machined_.triangles.col(t);
        Eigen::Matrix3d homogeneous;
        for (int k = 0; k < 3; ++k) homogeneous.col(k) << machined_.vertices.col(corners[k]).head<2>(), 1;
        const Vector3d weights = homogeneous.inverse() * Vector3d(point.x(), point.y(), 1);
        return weights.dot(Vector3d(errors_.z_error(corners)));
    }

    const Cutter& cutter_;
    const mesh::Mesh& machined_;
    mesh::MeshIndex index_;
    DropCutter drop_;
    const PatchErrors& errors_;
    double reach_;
};

/// Samples of a move, at most one grid step apart in plan view; the chords of an arc stay within kArcChordTolerance.
std::vector<Vector3d> sample_move(const CutterMove& move, double grid)
{
    const Eigen::Vector2d start = move.from.head<2>() - move.centre;
    const double radius = start.norm();
    const double horizontal = move.sweep_angle == 0 ? (move.to - move.from).head<2>().norm() : length(move);
    double max_step = horizontal > 0 ? grid / horizontal : 1; // as a fraction of the move
    if (move.sweep_angle != 0 && kArcChordTolerance < radius)
        max_step = std::min(max_step, 2 * std::acos(1 - kArcChordTolerance / radius) / std::abs(move.sweep_angle));
    const auto count = static_cast<int>(std::ceil(1 / std::min(max_step, 1.0)));
    std::vector<Vector3d> tips;
    for (int k = 0; k <= count; ++k) {
        const double t = static_cast<double>(k) / count;
        Vector3d tip = move.from + t * (move.to - move.from);
        if (move.sweep_angle != 0) tip.head<2>() = move.centre + Eigen::Rotation2Dd(t * move.sweep_angle) * start;
        tips.push_back(k == count ? move.to : tip);
    }
    return tips;
}

/// Interpolates the shifts of tips without an error, linearly in the distance travelled.
/// @param run  tips of consecutive feed moves
void interpolate_unknown(std::span<Tip*> run)
{
    const Tip* before = nullptr;
    for (std::size_t i = 0; i < run.size();) {
        if (run[i]->state != TipState::unknown) {
            before = run[i++];
            continue;
        }
        std::size_t end = i;
        while (end < run.size() && run[end]->state == TipState::unknown) ++end;
        const Tip* after = end < run.size() ? run[end] : before;
        if (!before) before = after;
        if (!before) return;
        const double gap = after->travelled - before->travelled;
        for (; i < end; ++i) {
            const double t = gap > 0 ? (run[i]->travelled - before->travelled) / gap : 0;
            run[i]->shift = before->shift + t * (after->shift - before->shift);
        }
    }
}

/// Tips of every move with their shifts; rapid moves have none.
std::vector<std::vector<Tip>> corrected_tips(const std::vector<CutterMove>& moves, double grid,
                                             const TipCorrection& correction)
{
    std::vector<std::vector<Tip>> tips(moves.size());
    tbb::parallel_for(std::size_t{0}, moves.size(), [&](std::size_t m) {
        if (moves[m].rapid()) return;
        for (const Vector3d& p : sample_move(moves[m], grid)) correction.set_shift(tips[m].emplace_back(Tip{p}));
    });
    std::vector<Tip*> run;
    for (std::size_t m = 0; m <= moves.size(); ++m) {
        if (m == moves.size() || tips[m].empty()) {
            interpolate_unknown(run);
            run.clear();
            continue;
        }
        for (Tip& tip : tips[m]) {
            if (!run.empty()) tip.travelled = run.back()->travelled + (tip.position - run.back()->position).norm();
            run.push_back(&tip);
        }
    }
    tbb::parallel_for(std::size_t{0}, moves.size(), [&](std::size_t m) {
        for (Tip& tip : tips[m]) correction.prevent_gouging(tip);
    });
    return tips;
}

/// Shifts of the start of the first move and of the ends of all moves. A vertical lift or plunge stays vertical: its
/// upper end shifts sideways as far as its lower one.
std::vector<Vector3d> end_shifts(const std::vector<CutterMove>& moves, const std::vector<std::vector<Tip>>& tips)
{
    std::vector<Vector3d> shifts(moves.size() + 1, Vector3d::Zero());
    for (std::size_t m = 0; m < moves.size(); ++m) {
        if (tips[m].empty()) continue;
        shifts[m] = tips[m].front().shift;
        shifts[m + 1] = tips[m].back().shift;
    }
    for (std::size_t m = 0; m < moves.size(); ++m) {
        const CutterMove& move = moves[m];
        if (move.sweep_angle != 0 || move.from.head<2>() != move.to.head<2>()) continue;
        const bool down = move.to.z() < move.from.z();
        Vector3d& upper = shifts[down ? m : m + 1];
        if (upper.isZero(0)) upper.head<2>() = shifts[down ? m + 1 : m].head<2>();
    }
    return shifts;
}

void count_tip(CorrectedPath& path, const Tip& tip)
{
    path.shifted += !tip.shift.isZero(0);
    path.blocked += tip.state == TipState::held;
    path.in_air += tip.state == TipState::in_air;
    path.unknown += tip.state == TipState::unknown;
    path.max_shift = std::max(path.max_shift, tip.shift.norm());
}

/// Replaces one move by straight moves along a polyline, thinned.
void append(std::vector<CutterMove>& moves, CutterMove move, const std::vector<Vector3d>& polyline)
{
    move.sweep_angle = 0;
    for (std::size_t k = 0; k + 1 < polyline.size();) {
        move.from = polyline[k];
        k += last_on_line(std::span(polyline).subspan(k));
        move.to = polyline[k];
        moves.push_back(move);
    }
}

} // namespace

CorrectedPath correct(const std::vector<CutterMove>& moves, const Cutter& cutter, const mesh::Mesh& machined,
                      const mesh::Mesh& design, const PatchErrors& errors, double reach)
{
    const TipCorrection correction(cutter, machined, design, errors, reach);
    const auto tips = corrected_tips(moves, grid_step(machined), correction);
    const std::vector<Vector3d> ends = end_shifts(moves, tips);
    CorrectedPath path;
    for (std::size_t m = 0; m < moves.size(); ++m) {
        std::vector<Vector3d> polyline = {moves[m].from + ends[m]};
        bool changed = !ends[m].isZero(0) || !ends[m + 1].isZero(0);
        for (std::size_t k = 1; k < tips[m].size(); ++k) {
            const Tip& tip = tips[m][k];
            count_tip(path, tip);
            if (k + 1 == tips[m].size()) break;
            polyline.push_back(tip.position + tip.shift);
            changed = changed || !tip.shift.isZero(0);
        }
        polyline.push_back(moves[m].to + ends[m + 1]);
        if (changed)
            append(path.moves, moves[m], polyline);
        else
            path.moves.push_back(moves[m]);
    }
    return path;
}

cloud::Cloud corrected_points(const ToolPath& path, const CorrectedPath& corrected, bool contacts)
{
    const auto& moves = corrected.moves;
    std::vector<Eigen::Index> points = {0};
    for (const CutterMove& move : moves) points.push_back(move.source_line - 1);
    cloud::Cloud cloud = contacts ? cloud::Cloud{} : cloud::select_points(*path.points, points);
    cloud.xyz.resize(3, points.size());
    Eigen::VectorXd feeds(cloud.size());
    cloud.xyz.col(0) = moves.front().from;
    feeds[0] = 0;
    for (std::size_t m = 0; m < moves.size(); ++m) {
        cloud.xyz.col(m + 1) = moves[m].to;
        feeds[m + 1] = moves[m].feed;
    }
    cloud::set_field(cloud, "feed", feeds);
    return cloud;
}

} // namespace fettle::machining
