#include "cad/exact_distance.h"

#include "cad/foot.h"
#include "cad/pieces.h"
#include "core/constants.h"
#include "mesh/triangle.h"

#include <Eigen/Geometry>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

namespace fettle::cad {
namespace {

namespace bgi = boost::geometry::index;

constexpr double kPointTolerance = 1e-7; // mm: OpenCASCADE's own tolerance of points
constexpr double kBorderReach = 4;       // of the deviation: farther from its border, a face has triangles or has not
constexpr double kTowardInner = 1e-4; // of the way to the middle of a triangle: there a pole's neighbour has a normal

/// Foot on a border.
struct BorderFoot {
    std::uint32_t border = 0;
    CurveFoot foot;
    double distance = 0;
};

/// The closest point so far.
struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Eigen::Vector3d foot = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    int face = -1;
    bool is_on_border = false;
};

/// Searches of one thread.
class Search {
  public:
    Search(const Design& design, const Pieces& pieces, const std::vector<double>& deviation)
        : pieces_(pieces), deviation_(deviation), max_deviation_(*std::ranges::max_element(deviation)),
          evaluators_(design, pieces)
    {
    }

    Nearest operator()(const Eigen::Vector3d& point)
    {
        Nearest nearest;
        std::vector<BorderFoot> on_borders;
        for (const auto& [distance, number] : pieces_near(point)) {
            if (distance > nearest.distance + max_deviation_) break;
            if (number < pieces_.triangles.size())
                try_triangle(number, point, nearest);
            else
                try_chord(pieces_.chords[number - pieces_.triangles.size()], point, nearest, on_borders);
        }
        if (nearest.is_on_border) join_borders(on_borders, nearest);
        return nearest;
    }

  private:
    double distance_of(std::uint32_t number, const Eigen::Vector3d& point) const
    {
        if (number < pieces_.triangles.size())
            return std::sqrt(mesh::closest_on_triangle(pieces_.triangles[number].corners, point).squared_distance);
        const Chord& chord = pieces_.chords[number - pieces_.triangles.size()];
        const mesh::Triangle line = (mesh::Triangle() << chord.a, chord.b, chord.b).finished();
        return std::sqrt(mesh::closest_on_triangle(line, point).squared_distance);
    }

    /// Triangles and chords that may hold the closest point, with their distances, the nearest first.
    std::vector<std::pair<double, std::uint32_t>> pieces_near(const Eigen::Vector3d& p) const
    {
        double distance = std::numeric_limits<double>::infinity();
        constexpr unsigned kFirst = 8; // boxes: the nearest need not hold the nearest triangle, one of some is near
        for (auto entry = pieces_.index.qbegin(bgi::nearest(Pieces::Point(p.x(), p.y(), p.z()), kFirst));
             entry != pieces_.index.qend(); ++entry)
            distance = std::min(distance, distance_of(entry->second, p));
        const double reach = distance + 2 * max_deviation_;
        std::vector<std::pair<double, std::uint32_t>> near;
        const Pieces::Box box({p.x() - reach, p.y() - reach, p.z() - reach},
                              {p.x() + reach, p.y() + reach, p.z() + reach});
        for (auto entry = pieces_.index.qbegin(bgi::intersects(box)); entry != pieces_.index.qend(); ++entry)
            if (const double there = distance_of(entry->second, p); there <= distance + 2 * max_deviation_) {
                near.emplace_back(there, entry->second);
                distance = std::min(distance, there);
            }
        std::erase_if(near, [&](const auto& piece) { return piece.first > distance + 2 * max_deviation_; });
        std::ranges::sort(near);
        return near;
    }

    double deviation_of(int face) const { return deviation_[static_cast<std::size_t>(face)]; }

    void try_triangle(std::uint32_t number, const Eigen::Vector3d& point, Nearest& nearest)
    {
        const FaceTriangle& triangle = pieces_.triangles[number];
        const int face = pieces_.face_of_triangle[number];
        const mesh::TrianglePoint flat = mesh::closest_on_triangle(triangle.corners, point);
        if (std::sqrt(flat.squared_distance) > nearest.distance + deviation_of(face)) return;
        const SurfaceFoot foot =
            foot_on_surface(evaluators_.surface(face), triangle.parameters(flat.barycentric), point);
        const double distance = (foot.point - point).norm();
        if (foot.is_at_limit || !(distance < nearest.distance) || !is_within_borders(face, foot)) return;
        Eigen::Vector3d normal = evaluators_.normal(face, foot.uv);
        if (normal.isZero())
            normal = evaluators_.normal(face, foot.uv + kTowardInner * (triangle.uv.rowwise().mean() - foot.uv));
        nearest = {distance, foot.point, normal, face, false};
    }

    std::optional<BorderFoot> foot_on(const Chord& chord, const Eigen::Vector3d& point, double reach)
    {
        const Eigen::Vector3d along = chord.b - chord.a;
        const double share =
            along.isZero() ? 0 : std::clamp((point - chord.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
        if ((chord.a + share * along - point).norm() > reach) return std::nullopt;
        const CurveFoot foot =
            pieces_.borders[chord.border].is_pole
                ? CurveFoot{0, chord.a, true}
                : foot_on_curve(evaluators_.curve(chord.border), chord.t0 + share * (chord.t1 - chord.t0), point);
        return BorderFoot{chord.border, foot, (foot.point - point).norm()};
    }

    void try_chord(const Chord& chord, const Eigen::Vector3d& point, Nearest& nearest,
                   std::vector<BorderFoot>& on_borders)
    {
        const int face = pieces_.borders[chord.border].face;
        const auto found = foot_on(chord, point, nearest.distance + deviation_of(face));
        if (!found) return;
        on_borders.push_back(*found);
        if (found->distance < nearest.distance)
            nearest = {found->distance, found->foot.point, Eigen::Vector3d::Zero(), face, true};
    }

    /// Keeps the feet that are one with the closest of them.
    void keep_closest(std::vector<BorderFoot>& feet) const
    {
        const BorderFoot closest = *std::ranges::min_element(feet, {}, &BorderFoot::distance);
        std::erase_if(feet, [&](const BorderFoot& foot) {
            const double same = 2 * std::max({kPointTolerance, pieces_.borders[foot.border].tolerance,
                                              pieces_.borders[closest.border].tolerance});
            return foot.border != closest.border && (foot.foot.point - closest.foot.point).norm() > same;
        });
        std::ranges::stable_sort(feet, {}, [](const BorderFoot& f) { return std::pair(f.border, f.distance); });
        const auto repeated = std::ranges::unique(feet, {}, &BorderFoot::border); // found from several chords
        feet.erase(repeated.begin(), repeated.end());
    }

    Eigen::Vector2d parameters_of(const BorderFoot& foot) const
    {
        const gp_Pnt2d uv = pieces_.borders[foot.border].parameters->Value(foot.foot.t);
        return {uv.X(), uv.Y()};
    }

    /// Unit vector along a border, such that its face lies to the left, seen against du x dv.
    Eigen::Vector3d direction_of(const BorderFoot& foot)
    {
        return (pieces_.borders[foot.border].is_reversed ? -1 : 1) * evaluators_.tangent(foot.border, foot.foot.t);
    }

    /// Normal of the surface at a border's foot, on the side of du x dv.
    Eigen::Vector3d natural_normal(const BorderFoot& foot)
    {
        gp_Pnt p;
        gp_Vec du, dv;
        const Eigen::Vector2d uv = parameters_of(foot);
        evaluators_.surface(pieces_.borders[foot.border].face).D1(uv.x(), uv.y(), p, du, dv);
        const gp_Vec normal = du.Crossed(dv);
        return Eigen::Vector3d(normal.X(), normal.Y(), normal.Z()).normalized();
    }

    /// Whether a foot on the surface of a face lies within the face's borders: on the inner side of the closest of
    /// them; in a corner of the borders, of the sum of both (Baerentzen & Aanaes 2005, in the tangent plane).
    bool is_within_borders(int face, const SurfaceFoot& foot)
    {
        const double deviation = deviation_of(face), reach = kBorderReach * deviation + kPointTolerance;
        const Eigen::Vector3d& p = foot.point;
        const Pieces::Box box({p.x() - reach, p.y() - reach, p.z() - reach},
                              {p.x() + reach, p.y() + reach, p.z() + reach});
        double to_triangles = std::numeric_limits<double>::infinity();
        std::vector<BorderFoot> feet;
        for (auto entry = pieces_.index.qbegin(bgi::intersects(box)); entry != pieces_.index.qend(); ++entry) {
            if (entry->second < pieces_.triangles.size()) {
                if (pieces_.face_of_triangle[entry->second] == face)
                    to_triangles = std::min(
                        to_triangles,
                        std::sqrt(
                            mesh::closest_on_triangle(pieces_.triangles[entry->second].corners, p).squared_distance));
                continue;
            }
            const Chord& chord = pieces_.chords[entry->second - pieces_.triangles.size()];
            const Border& border = pieces_.borders[chord.border];
            if (border.face != face || border.is_seam || border.is_pole) continue;
            if (const auto found = foot_on(chord, p, reach)) feet.push_back(*found);
        }
        if (feet.empty()) return to_triangles <= deviation + kPointTolerance;
        keep_closest(feet);
        Eigen::Vector3d inward = Eigen::Vector3d::Zero();
        for (const BorderFoot& f : feet) inward += natural_normal(f).cross(direction_of(f)).normalized();
        const Eigen::Vector3d offset = p - std::ranges::min_element(feet, {}, &BorderFoot::distance)->foot.point;
        return offset.norm() <= kPointTolerance || inward.dot(offset) >= 0;
    }

    /// Angle of a face at a foot: a straight one along a border, in a corner that from the border that leaves it to the
    /// one that arrives.
    double angle_of(const std::vector<BorderFoot>& of_face, const Eigen::Vector3d& natural)
    {
        std::optional<Eigen::Vector3d> leaving, arriving;
        for (const BorderFoot& f : of_face) {
            if (!f.foot.is_at_end) return std::numbers::pi;
            const BRepAdaptor_Curve& curve = evaluators_.curve(f.border);
            const bool is_at_first = f.foot.t - curve.FirstParameter() < curve.LastParameter() - f.foot.t;
            const bool is_leaving = is_at_first != pieces_.borders[f.border].is_reversed;
            (is_leaving ? leaving : arriving) = (is_leaving ? 1 : -1) * direction_of(f);
        }
        if (!leaving || !arriving) return std::numbers::pi;
        const double angle = std::atan2(natural.dot(leaving->cross(*arriving)), leaving->dot(*arriving));
        return angle > 0 ? angle : angle + 2 * std::numbers::pi;
    }

    /// The normal of a closest point on borders: that of its faces, weighted by their angles.
    void join_borders(std::vector<BorderFoot>& feet, Nearest& nearest)
    {
        keep_closest(feet);
        std::map<int, std::vector<BorderFoot>> by_face;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const BorderFoot& f : feet)
            if (const Border& border = pieces_.borders[f.border]; border.is_pole)
                sum += border.pole_normal;
            else
                by_face[border.face].push_back(f);
        for (const auto& [face, of_face] : by_face) {
            const Eigen::Vector3d normal = evaluators_.normal(face, parameters_of(of_face.front()));
            if (!normal.isZero()) sum += angle_of(of_face, natural_normal(of_face.front())) * normal;
        }
        nearest.normal = sum.normalized();
        nearest.face = pieces_.borders[feet.front().border].face;
        for (const BorderFoot& f : feet) nearest.face = std::min(nearest.face, pieces_.borders[f.border].face);
    }

    const Pieces& pieces_;
    const std::vector<double>& deviation_;
    double max_deviation_;
    Evaluators evaluators_;
};

} // namespace

struct ExactDistance::State {
    const Design& design;
    std::vector<double> deviation;
    Pieces pieces;
};

ExactDistance::ExactDistance(const Design& design, const Triangulation& triangulation)
    : state_(new State{design, triangulation.deviation, pieces_of(design)})
{
}
ExactDistance::~ExactDistance() = default;

ExactDistances ExactDistance::operator()(const Eigen::Matrix3Xd& points, const core::Progress& progress) const
{
    ExactDistances result{
        Eigen::VectorXd::Constant(points.cols(), core::kNaN), Eigen::Matrix3Xd::Constant(3, points.cols(), core::kNaN),
        Eigen::Matrix3Xd::Constant(3, points.cols(), core::kNaN), Eigen::VectorXi::Constant(points.cols(), -1)};
    tbb::enumerable_thread_specific<Search> searches(
        [&] { return Search(state_->design, state_->pieces, state_->deviation); });
    const auto measure = [&](Eigen::Index i) {
        const Eigen::Vector3d point = points.col(i);
        if (!point.allFinite()) return;
        const Nearest nearest = searches.local()(point);
        const double side = nearest.normal.dot(point - nearest.foot);
        result.error[i] = side < 0 ? -nearest.distance : nearest.distance;
        result.foot.col(i) = nearest.foot;
        result.normal.col(i) = nearest.normal;
        result.face[i] = nearest.face;
    };
    constexpr Eigen::Index kBlock = 4096; // points between two reports of progress
    for (Eigen::Index first = 0; first < points.cols(); first += kBlock) {
        const Eigen::Index last = std::min(first + kBlock, points.cols());
        tbb::parallel_for(first, last, measure);
        core::report_progress(progress, double(last) / double(points.cols()));
    }
    return result;
}

} // namespace fettle::cad
