#include "robot/simplex.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

using Eigen::Vector3d;

// Heights of a tetrahedron below this share of its size are roundings.
constexpr double kFlat = 1e-13;

template <typename Part>
Vector3d weighted(const Simplex& s, const Part& part)
{
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.count); ++i) sum += s.weight[i] * part(s.point[i]);
    return sum;
}

Simplex corner(const DifferencePoint& p)
{
    Simplex s;
    s.add(p);
    s.weight[0] = 1;
    return s;
}

Simplex of_segment(const DifferencePoint& p, const DifferencePoint& q)
{
    const Vector3d d = q.w - p.w;
    const double squared = d.squaredNorm(), along = -p.w.dot(d);
    if (!(along > 0)) return corner(p);
    if (along >= squared) return corner(q);
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

// Its edges, or, if the origin's foot is on the inner side of all three, the foot. That of a needle is noise: the
// nearest of all is taken.
Simplex of_triangle(const DifferencePoint& p, const DifferencePoint& q, const DifferencePoint& r)
{
    const Simplex edges = nearer(nearer(of_segment(p, q), of_segment(q, r)), of_segment(r, p));
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

Vector3d Simplex::nearest() const
{
    return weighted(*this, [](const DifferencePoint& p) { return p.w; });
}
Vector3d Simplex::on_a() const
{
    return weighted(*this, [](const DifferencePoint& p) { return p.on_a; });
}
Vector3d Simplex::on_b() const
{
    return weighted(*this, [](const DifferencePoint& p) { return p.on_b; });
}

bool reduce(Simplex& s, bool outside)
{
    const auto& p = s.point;
    if (s.count == 1) s = corner(p[0]);
    if (s.count == 2) s = of_segment(p[0], p[1]);
    if (s.count == 3) s = of_triangle(p[0], p[1], p[2]);
    if (s.count < 4) return false;
    const int faces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    const Simplex all = s;
    bool inside = true;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& f : faces) {
        const Vector3d &a = all.point[f[0]].w, &b = all.point[f[1]].w, &c = all.point[f[2]].w, &d = all.point[f[3]].w;
        const Vector3d n = (b - a).cross(c - a);
        const double origin = -n.dot(a), opposite = n.dot(d - a);
        // On the same side as the fourth corner: this face does not look at the origin. In a flat tetrahedron all do.
        const double noise = kFlat * n.norm() * std::max({a.norm(), b.norm(), c.norm(), d.norm()});
        if (!outside && origin * opposite > 0 && std::abs(opposite) > noise) continue;
        inside = false;
        const Simplex on_face = of_triangle(all.point[f[0]], all.point[f[1]], all.point[f[2]]);
        const double squared = on_face.nearest().squaredNorm();
        if (squared < least) {
            least = squared;
            s = on_face;
        }
    }
    return inside;
}

} // namespace fettle
