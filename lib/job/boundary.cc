#include "job/boundary.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "job/boost_polygons.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fettle::job {

namespace {

// Relative to the largest coordinate. Rotation into W moves a corner by a few units in the last place (2e-16 of its
// distance from the origin); this bound is a hundred times larger, and far below the resolution of a probe.
constexpr double kEdgeTolerance = 1e-13;

// A polygon with less area than this share of its squared diameter counts as a line: a strip of aspect ratio 1e6.
constexpr double kMinRelativeArea = 1e-6;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double max_coordinate(const Polygon& polygon) { return polygon.cwiseAbs().maxCoeff(); }

BoostPolygons difference(const Polygon& a, const Polygon& b)
{
    BoostPolygons result;
    bg::difference(to_boost(a), to_boost(b), result);
    return result;
}

double signed_area(const Polygon& polygon)
{
    if (polygon.cols() < 3) return 0;
    double twice = 0;
    const Eigen::Vector2d origin = polygon.col(0); // avoids cancellation when the part is far from the machine zero
    for (Eigen::Index i = 1; i + 1 < polygon.cols(); ++i)
        twice += cross(polygon.col(i) - origin, polygon.col(i + 1) - origin);
    return twice / 2;
}

// Intersection of the edges p→q and r→s; nothing if they have no common point.
std::optional<Eigen::Vector2d> intersection(const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                                            const Eigen::Vector2d& r, const Eigen::Vector2d& s)
{
    const double along = cross(q - p, s - r);
    if (along == 0) {
        for (const Eigen::Vector2d& end : {r, s}) // parallel edges intersect where they overlap
            if (cross(q - p, end - p) == 0 && (end - p).dot(end - q) <= 0) return end;
        if (cross(s - r, p - r) == 0 && (p - r).dot(p - s) <= 0) return p;
        return std::nullopt;
    }
    const double t = cross(r - p, s - r) / along;
    const double u = cross(r - p, q - p) / along;
    if (t < 0 || t > 1 || u < 0 || u > 1) return std::nullopt;
    return p + t * (q - p);
}

// The first self-intersection: non-adjacent edges intersect, or adjacent edges fold back onto each other.
Eigen::Vector2d self_intersection(const Polygon& polygon)
{
    const Eigen::Index n = polygon.cols();
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Vector2d before = polygon.col(i), here = polygon.col((i + 1) % n);
        const Eigen::Vector2d after = polygon.col((i + 2) % n);
        if (cross(here - before, after - here) == 0 && (here - before).dot(after - here) < 0) return here;
        for (Eigen::Index j = i + 2; j < n; ++j)
            if ((j + 1) % n != i)
                if (const auto point = intersection(before, here, polygon.col(j), polygon.col((j + 1) % n)))
                    return *point;
    }
    return polygon.col(0);
}

// The polygon in the frame M, checked and counter-clockwise.
Polygon checked_polygon(const Job& job, const Eigen::Matrix3Xd& points, const std::string& name)
{
    if (points.cols() < 3)
        throw core::InputError(job.source,
                               name + ": " + std::to_string(points.cols()) + " boundary points, at least 3 are needed");
    if (!points.topRows<2>().allFinite())
        throw core::InputError(job.source, name + ": a boundary point without x and y");
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (points.col(i).head<2>() != points.col((i + 1) % points.cols()).head<2>()) kept.push_back(i);
    Polygon polygon = points.topRows<2>()(Eigen::all, kept);
    if (polygon.cols() < 3)
        throw core::InputError(job.source, name + ": only " + std::to_string(polygon.cols()) +
                                               " different boundary points, at least 3 are needed");
    const double diameter = geometry::bounding_box(polygon).sizes().norm();
    if (signed_area(polygon) < 0) polygon = Polygon(polygon.rowwise().reverse());
    const double min_area = kMinRelativeArea * diameter * diameter;
    if (area(convex_hull(polygon)) >= min_area && !bg::is_valid(to_boost(polygon)))
        throw core::InputError(job.source, name + ": the boundary crosses itself at " +
                                               point_text(self_intersection(polygon), job.units));
    if (area(polygon) < min_area)
        throw core::InputError(job.source,
                               name + ": the boundary encloses no area, near " + point_text(polygon.col(0), job.units));
    return polygon;
}

// The corner of the polygons that is farthest from the edge of `polygon`.
Eigen::Vector2d farthest_point(const BoostPolygons& polygons, const Polygon& polygon)
{
    Eigen::Vector2d farthest = polygon.col(0);
    double distance = -1;
    for (const BoostPolygon& part : polygons)
        for (const Point& corner : part.outer()) {
            const Eigen::Vector2d xy(corner.x(), corner.y());
            const double d = distance_to_edge(polygon, xy);
            if (d > distance) farthest = xy, distance = d;
        }
    return farthest;
}

} // namespace

std::string point_text(const Eigen::Vector2d& xy, const units::Units& units)
{
    return "(" + core::to_short_text(xy.x() / units.mm()) + ", " + core::to_short_text(xy.y() / units.mm()) + ") " +
           units::to_string(units.length);
}

Boundaries working_boundaries(const Job& job)
{
    const Eigen::Matrix2d rotation = rotation_working_machine(job.theta);
    const Polygon anomaly = checked_polygon(job, job.anomaly, "anomaly");
    if (job.sampling.cols() == 0 && job.surface == SurfaceType::plane) return {rotation * anomaly, {}};
    const Polygon sampling = checked_polygon(job, job.sampling, "sampling");

    const bool freeform = job.surface == SurfaceType::freeform;
    const Polygon around = freeform ? convex_hull(sampling) : sampling;
    const BoostPolygons outside = difference(anomaly, around);
    const double small = kMinRelativeArea * area(anomaly);
    if (bg::area(outside) > small)
        throw core::InputError(job.source, "anomaly: not inside the sampling boundary" +
                                               std::string(freeform ? "'s convex hull" : "") + ", at " +
                                               point_text(farthest_point(outside, around), job.units));
    if (bg::area(difference(sampling, anomaly)) <= small)
        throw core::InputError(job.source, "sampling: no room between anomaly and sampling boundary, near " +
                                               point_text(sampling.col(0), job.units));
    return {rotation * anomaly, rotation * sampling};
}

bool contains(const Polygon& polygon, const Eigen::Vector2d& point)
{
    bool inside = false;
    const Eigen::Index n = polygon.cols();
    for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
        const Eigen::Vector2d a = polygon.col(j), b = polygon.col(i);
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        if (point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
    return inside || (n > 0 && distance_to_edge(polygon, point) <= kEdgeTolerance * max_coordinate(polygon));
}

double area(const Polygon& polygon) { return std::abs(signed_area(polygon)); }

Polygon convex_hull(const Polygon& points)
{
    BoostPolygon hull;
    bg::convex_hull(to_boost(points), hull);
    Polygon result(2, hull.outer().size());
    for (Eigen::Index i = 0; i < result.cols(); ++i) result.col(i) << hull.outer()[i].x(), hull.outer()[i].y();
    return result;
}

// Two lines at an infinitesimal distance below and above the given one have no special cases: each edge crosses them or
// not. Edges with ends at h >= 0 and h < 0 cross the line below, those with h > 0 and h <= 0 the line above. An
// interval is inside the polygon if it is inside on either line, which includes edges along the given line.
std::vector<Interval> intervals_inside(const Polygon& polygon, const Eigen::Vector2d& origin,
                                       const Eigen::Vector2d& direction)
{
    struct Crossing {
        double t;
        bool below, above;
    };
    std::vector<Crossing> crossings;
    const Eigen::Index n = polygon.cols();
    const double on_line = kEdgeTolerance * std::max(max_coordinate(polygon), origin.cwiseAbs().maxCoeff());
    Eigen::VectorXd t(n), h(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Vector2d corner = polygon.col(i) - origin;
        t[i] = direction.dot(corner);
        h[i] = cross(direction, corner);
        if (std::abs(h[i]) <= on_line) h[i] = 0;
    }
    for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
        const bool below = (h[j] >= 0) != (h[i] >= 0);
        const bool above = (h[j] > 0) != (h[i] > 0);
        if (!below && !above) continue;
        const double at = h[i] == 0 ? t[i] : h[j] == 0 ? t[j] : t[j] + h[j] / (h[j] - h[i]) * (t[i] - t[j]);
        crossings.push_back({at, below, above});
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });

    std::vector<Interval> intervals;
    bool below = false, above = false;
    for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
        below ^= crossings[k].below;
        above ^= crossings[k].above;
        const Interval piece(crossings[k].t, crossings[k + 1].t);
        if (!(below || above) || piece.second <= piece.first) continue;
        if (!intervals.empty() && intervals.back().second == piece.first)
            intervals.back().second = piece.second;
        else
            intervals.push_back(piece);
    }
    return intervals;
}

std::vector<Interval> subtract(const std::vector<Interval>& a, const std::vector<Interval>& b, double min_length)
{
    std::vector<Interval> result;
    const auto keep = [&result, min_length](double from, double to) {
        if (to > from && to - from >= min_length) result.emplace_back(from, to);
    };
    for (const Interval& whole : a) {
        double from = whole.first;
        for (const Interval& hole : b) {
            if (hole.second <= from) continue;
            if (hole.first >= whole.second) break;
            keep(from, hole.first);
            from = hole.second;
        }
        keep(from, whole.second);
    }
    return result;
}

std::vector<Interval> intersect(const std::vector<Interval>& a, const std::vector<Interval>& b, double min_length)
{
    std::vector<Interval> result;
    for (const Interval& p : a)
        for (const Interval& q : b) {
            const double from = std::max(p.first, q.first), to = std::min(p.second, q.second);
            if (to > from && to - from >= min_length) result.emplace_back(from, to);
        }
    return result;
}

double distance_to_edge(const Polygon& polygon, const Eigen::Vector2d& point)
{
    double min_distance = core::kInfinity;
    const Eigen::Index n = polygon.cols();
    for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
        const Eigen::Vector2d edge = polygon.col(i) - polygon.col(j);
        const Eigen::Vector2d from = point - polygon.col(j);
        const double length2 = edge.squaredNorm();
        const double t = length2 > 0 ? std::clamp(from.dot(edge) / length2, 0.0, 1.0) : 0;
        min_distance = std::min(min_distance, (from - t * edge).norm());
    }
    return min_distance;
}

void add_report(json::Value& report, const Job& job)
{
    const auto [B, S] = working_boundaries(job);
    const double mm = job.units.mm();
    Eigen::Matrix3Xd points(3, job.anomaly.cols() + job.sampling.cols());
    points << job.anomaly, job.sampling;
    report.set("anomaly_points", job.anomaly.cols())
        .set("sampling_points", job.sampling.cols())
        .set("anomaly_area", area(B) / (mm * mm))
        .set("sampling_area", area(S) / (mm * mm))
        .set("lowest", points.row(2).minCoeff<Eigen::PropagateNumbers>() / mm)
        .set("highest", points.row(2).maxCoeff<Eigen::PropagateNumbers>() / mm);
}

} // namespace fettle::job
