#include "machining/correction.h"

#include "machining/drop_cutter.h"
#include "machining/straight_way.h"
#include "mesh/mesh_index.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace fettle {
namespace {

using Eigen::Vector3d;

/// Corrections that are smaller change nothing: what a path's thinning leaves out, mm.
constexpr double kNothing = kThinning;

enum class Fate { right, shifted, held, in_air, unknown };

/// A tip of a feed move, and how it is to be moved.
struct Tip {
    Vector3d at;
    double way = 0; ///< along the path, mm
    Vector3d shift = Vector3d::Zero();
    Fate fate = Fate::unknown;
};

/// Sides of the squares that a machined grid's triangles are halves of.
double grid_of(const Mesh& mesh)
{
    double area = 0;
    for (const auto& t : mesh.triangles.colwise()) {
        const Eigen::Vector2d a = mesh.vertices.col(t[0]).head<2>();
        const Eigen::Vector2d b = mesh.vertices.col(t[1]).head<2>() - a, c = mesh.vertices.col(t[2]).head<2>() - a;
        area += std::abs(b.x() * c.y() - b.y() * c.x());
    }
    return std::sqrt(area / static_cast<double>(std::max<Eigen::Index>(mesh.triangles.cols(), 1)));
}

class Correction {
  public:
    Correction(const Cutter& cutter, const Mesh& machined, const Mesh& design, const PatchErrors& errors, double reach)
        : cutter_(cutter), machined_(machined), index_(machined), drop_(design, cutter), errors_(errors), reach_(reach)
    {
    }

    /// Looks up the error under a tip.
    void look_up(Tip& tip) const
    {
        const auto touch = drop_(tip.at.head<2>());
        if (!touch) return;
        const auto below = index_.highest(touch->contact.x(), touch->contact.y());
        if (!below) return;
        const Eigen::Index t = below->triangle;
        if (std::isnan(errors_.mu[t])) return;
        const Vector3d normal = errors_.normal.col(t);
        const double beside = (touch->contact - tip.at).head<2>().norm();
        const double lower_side = tip.at.z() + rise(cutter_, std::min(beside, cutter_.radius));
        const double mu = normal.z() * z_error(t, below->point);
        tip.fate = Fate::right;
        if ((lower_side - below->point.z()) * normal.z() > reach_)
            tip.fate = Fate::in_air;
        else if (std::abs(mu) > kNothing)
            tip.fate = Fate::shifted;
        if (tip.fate == Fate::shifted) tip.shift = -mu * normal;
    }

    /// Lifts a shifted tip out of the design. Where that would be far it is a wall or a narrow corner that the shift
    /// runs into, and the tip goes straight up or down instead, until the cutter touches.
    void hold(Tip& tip) const
    {
        if (tip.shift.isZero(0)) return;
        const Vector3d wanted = tip.at + tip.shift;
        const auto rests = drop_(wanted.head<2>());
        if (!rests || rests->z <= wanted.z()) return;
        if (rests->z - wanted.z() <= reach_) {
            tip.shift.z() += rests->z - wanted.z();
            return;
        }
        tip.fate = Fate::held;
        const auto below = drop_(tip.at.head<2>());
        const double upright = tip.shift.z() == 0 ? 0 : tip.shift.squaredNorm() / tip.shift.z(); // -mu/N·Z
        tip.shift = Vector3d(0, 0, below ? std::max(upright, below->z - tip.at.z()) : 0);
    }

  private:
    /// Between the corners of a machined triangle.
    double z_error(Eigen::Index t, const Vector3d& point) const
    {
        const Eigen::Vector3i corners = machined_.triangles.col(t);
        Eigen::Matrix3d sides;
        for (int k = 0; k < 3; ++k) sides.col(k) << machined_.vertices.col(corners[k]).head<2>(), 1;
        const Vector3d weights = sides.inverse() * Vector3d(point.x(), point.y(), 1);
        return weights.dot(Vector3d(errors_.z_error(corners)));
    }

    const Cutter& cutter_;
    const Mesh& machined_;
    MeshIndex index_;
    DropCutter drop_;
    const PatchErrors& errors_;
    double reach_;
};

/// Tips of a move, no farther apart than a grid seen from above; those of an arc no farther from it than kArcChord.
std::vector<Vector3d> tips_of(const CutterMove& move, double grid)
{
    const Eigen::Vector2d start = move.from.head<2>() - move.centre;
    const double radius = start.norm();
    const double level = move.sweep == 0 ? (move.to - move.from).head<2>().norm() : length(move);
    double most = level > 0 ? grid / level : 1; // of the whole
    if (move.sweep != 0 && kArcChord < radius)
        most = std::min(most, 2 * std::acos(1 - kArcChord / radius) / std::abs(move.sweep));
    const auto count = static_cast<int>(std::ceil(1 / std::min(most, 1.0)));
    std::vector<Vector3d> tips;
    for (int k = 0; k <= count; ++k) {
        const double share = static_cast<double>(k) / count;
        Vector3d tip = move.from + share * (move.to - move.from);
        if (move.sweep != 0) tip.head<2>() = move.centre + Eigen::Rotation2Dd(share * move.sweep) * start;
        tips.push_back(k == count ? move.to : tip);
    }
    return tips;
}

/// Tips whose error is not known go as those before and after them do, in between in proportion to the way.
/// @param run  of feed moves that follow each other
void fill(std::span<Tip*> run)
{
    const Tip* before = nullptr;
    for (std::size_t i = 0; i < run.size();) {
        if (run[i]->fate != Fate::unknown) {
            before = run[i++];
            continue;
        }
        std::size_t end = i;
        while (end < run.size() && run[end]->fate == Fate::unknown) ++end;
        const Tip* after = end < run.size() ? run[end] : before;
        if (!before) before = after;
        if (!before) return;
        const double way = after->way - before->way;
        for (; i < end; ++i) {
            const double share = way > 0 ? (run[i]->way - before->way) / way : 0;
            run[i]->shift = before->shift + share * (after->shift - before->shift);
        }
    }
}

/// The tips of all feed moves, of rapid ones none, each with its shift.
std::vector<std::vector<Tip>> shifted_tips(const std::vector<CutterMove>& moves, double grid,
                                           const Correction& correction)
{
    std::vector<std::vector<Tip>> tips(moves.size());
    tbb::parallel_for(std::size_t{0}, moves.size(), [&](std::size_t m) {
        if (moves[m].rapid()) return;
        for (const Vector3d& at : tips_of(moves[m], grid)) correction.look_up(tips[m].emplace_back(Tip{at}));
    });
    std::vector<Tip*> run;
    for (std::size_t m = 0; m <= moves.size(); ++m) {
        if (m == moves.size() || tips[m].empty()) {
            fill(run);
            run.clear();
            continue;
        }
        for (Tip& tip : tips[m]) {
            if (!run.empty()) tip.way = run.back()->way + (tip.at - run.back()->at).norm();
            run.push_back(&tip);
        }
    }
    tbb::parallel_for(std::size_t{0}, moves.size(), [&](std::size_t m) {
        for (Tip& tip : tips[m]) correction.hold(tip);
    });
    return tips;
}

/// How the beginning of the first and the ends of all moves shift. What goes straight up or down into the air stays so:
/// its upper end goes beside as far as its lower one.
std::vector<Vector3d> shifts_of_ends(const std::vector<CutterMove>& moves, const std::vector<std::vector<Tip>>& tips)
{
    std::vector<Vector3d> shifts(moves.size() + 1, Vector3d::Zero());
    for (std::size_t m = 0; m < moves.size(); ++m) {
        if (tips[m].empty()) continue;
        shifts[m] = tips[m].front().shift;
        shifts[m + 1] = tips[m].back().shift;
    }
    for (std::size_t m = 0; m < moves.size(); ++m) {
        const CutterMove& move = moves[m];
        if (move.sweep != 0 || move.from.head<2>() != move.to.head<2>()) continue;
        const bool down = move.to.z() < move.from.z();
        Vector3d& upper = shifts[down ? m : m + 1];
        if (upper.isZero(0)) upper.head<2>() = shifts[down ? m + 1 : m].head<2>();
    }
    return shifts;
}

void count(CorrectedPath& path, const Tip& tip)
{
    path.shifted += !tip.shift.isZero(0);
    path.held += tip.fate == Fate::held;
    path.in_air += tip.fate == Fate::in_air;
    path.unknown += tip.fate == Fate::unknown;
    path.greatest_shift = std::max(path.greatest_shift, tip.shift.norm());
}

/// Moves along a way in the place of one, thinned.
void append(std::vector<CutterMove>& moves, CutterMove move, const std::vector<Vector3d>& way)
{
    move.sweep = 0;
    for (std::size_t k = 0; k + 1 < way.size();) {
        move.from = way[k];
        k += straight_to(std::span(way).subspan(k));
        move.to = way[k];
        moves.push_back(move);
    }
}

} // namespace

CorrectedPath correct(const std::vector<CutterMove>& moves, const Cutter& cutter, const Mesh& machined,
                      const Mesh& design, const PatchErrors& errors, double reach)
{
    const Correction correction(cutter, machined, design, errors, reach);
    const double grid = grid_of(machined);
    const auto tips = shifted_tips(moves, grid, correction);
    const std::vector<Vector3d> ends = shifts_of_ends(moves, tips);
    CorrectedPath path;
    for (std::size_t m = 0; m < moves.size(); ++m) {
        std::vector<Vector3d> way = {moves[m].from + ends[m]};
        bool changed = !ends[m].isZero(0) || !ends[m + 1].isZero(0);
        for (std::size_t k = 1; k < tips[m].size(); ++k) {
            const Tip& tip = tips[m][k];
            count(path, tip);
            if (k + 1 == tips[m].size()) break;
            way.push_back(tip.at + tip.shift);
            changed = changed || !tip.shift.isZero(0);
        }
        way.push_back(moves[m].to + ends[m + 1]);
        if (changed)
            append(path.moves, moves[m], way);
        else
            path.moves.push_back(moves[m]);
    }
    return path;
}

Cloud corrected_points(const ToolPath& path, const CorrectedPath& corrected, bool contacts)
{
    const auto& moves = corrected.moves;
    std::vector<Eigen::Index> points = {0};
    for (const CutterMove& move : moves) points.push_back(static_cast<Eigen::Index>(move.place) - 1);
    Cloud cloud = contacts ? Cloud{} : select(*path.points, points);
    cloud.xyz.resize(3, static_cast<Eigen::Index>(points.size()));
    Eigen::VectorXd feeds(cloud.size());
    cloud.xyz.col(0) = moves.front().from;
    feeds[0] = 0;
    for (std::size_t m = 0; m < moves.size(); ++m) {
        cloud.xyz.col(static_cast<Eigen::Index>(m) + 1) = moves[m].to;
        feeds[static_cast<Eigen::Index>(m) + 1] = moves[m].feed;
    }
    set_field(cloud, "feed", feeds);
    return cloud;
}

} // namespace fettle
