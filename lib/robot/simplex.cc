#include "robot/simplex.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::robot {

namespace {

using Eigen::Vector3d;

// Heights of a tetrahedron below this fraction of its size are rounding errors.
constexpr double kFlatnessTolerance = 1e-13;

Simplex vertex(const DifferencePoint& p)
{
    Simplex s;
    s.add(p);
    s.weight[0] = 1;
    return s;
}

Simplex nearest_on_segment(const DifferencePoint& p, const DifferencePoint& q)
{
    const Vector3d d = q.w - p.w;
    const double squared = d.squaredNorm(), along = -p.w.dot(d);
    if (!(along > 0)) return vertex(p);
    if (along >= squared) return vertex(q);
    Simplex s;
    s.add(p);
    s.add(q);
    s.weight[1] = along / squared;
    s.weight[0] = 1 - s.weight[1];
    return s;
}

Simplex nearer(const Simplex& a, const Simplex& b)
{
    return b.nearest().squaredNorm() < a.nearest().squaredNorm() ? b : a;
}

// The nearest point of the edges or, if the foot of the origin lies inside the triangle, the foot. The foot on a needle
// is inaccurate, so the nearer of both is taken.
Simplex nearest_on_triangle(const DifferencePoint& p, const DifferencePoint& q, const DifferencePoint& r)
{
    const Simplex edges = nearer(nearer(nearest_on_segment(p, q), nearest_on_segment(q, r)), nearest_on_segment(r, p));
    const Vector3d n = (q.w - p.w).cross(r.w - p.w);
    const double u = n.dot(q.w.cross(r.w)), v = n.dot(r.w.cross(p.w)), w = n.dot(p.w.cross(q.w));
    if (!(u > 0 && v > 0 && w > 0)) return edges;
    Simplex foot;
    foot.add(p);
    foot.add(q);
    foot.add(r);
    const double sum = u + v + w;
    foot.weight = {u / sum, v / sum, w / sum, 0};
    return nearer(edges, foot);
}

} // namespace

bool reduce(Simplex& s, bool outside)
{
    const auto& p = s.point;
    if (s.count == 1) s = vertex(p[0]);
    if (s.count == 2) s = nearest_on_segment(p[0], p[1]);
    if (s.count == 3) s = nearest_on_triangle(p[0], p[1], p[2]);
    if (s.count < 4) return false;
    const int faces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    const Simplex all = s;
    bool inside = true;
    double min = std::numeric_limits<double>::infinity();
    for (const auto& f : faces) {
        const Vector3d &a = all.point[f[0]].w, &b = all.point[f[1]].w, &c = all.point[f[2]].w, &d = all.point[f[3]].w;
        const Vector3d n = (b - a).cross(c - a);
        const double origin = -n.dot(a), opposite = n.dot(d - a);
        // A face with the origin on the side of the fourth vertex does not face it. In a flat tetrahedron all faces do.
        const double noise = kFlatnessTolerance * n.norm() * std::max({a.norm(), b.norm(), c.norm(), d.norm()});
        if (!outside && origin * opposite > 0 && std::abs(opposite) > noise) continue;
        inside = false;
        const Simplex on_face = nearest_on_triangle(all.point[f[0]], all.point[f[1]], all.point[f[2]]);
        const double squared = on_face.nearest().squaredNorm();
        if (squared < min) {
            min = squared;
            s = on_face;
        }
    }
    return inside;
}

} // namespace fettle::robot
