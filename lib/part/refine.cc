#include "part/refine.h"

#include "core/error.h"

#include <cmath>
#include <functional>
#include <optional>
#include <unordered_map>

namespace fettle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Where an edge is to be cut: the fraction of the way from its lower to its higher vertex; nothing: not at all.
using Cut = std::function<std::optional<double>(int low, int high)>;

class EdgeSplitter {
  public:
    explicit EdgeSplitter(const Mesh& mesh) : mesh_(mesh)
    {
        for (Index v = 0; v < mesh.vertices.cols(); ++v) vertices_.push_back(mesh.vertices.col(v));
    }

    /// Cuts each edge at most once. @return whether any was cut
    bool split(const Cut& cut, Mesh& result)
    {
        for (Index t = 0; t < mesh_.triangles.cols(); ++t) {
            divide(mesh_.triangles.col(t), cut);
            check_size(static_cast<double>(triangles_.size()));
        }
        const bool any = vertices_.size() > static_cast<std::size_t>(mesh_.vertices.cols());
        if (any) {
            result.vertices =
                Eigen::Map<Eigen::Matrix3Xd>(vertices_[0].data(), 3, static_cast<Index>(vertices_.size()));
            result.triangles =
                Eigen::Map<Eigen::Matrix3Xi>(triangles_[0].data(), 3, static_cast<Index>(triangles_.size()));
        }
        return any;
    }

  private:
    /// The new vertex on an edge, -1 if the edge stays whole.
    int on_edge(int a, int b, const Cut& cut)
    {
        const auto [low, high] = std::minmax(a, b);
        const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
        const auto [place, fresh] = known_.try_emplace(key, -1);
        if (!fresh) return place->second;
        const std::optional<double> t = cut(low, high);
        if (!t) return -1;
        place->second = static_cast<int>(vertices_.size());
        vertices_.push_back(mesh_.vertices.col(low) + *t * (mesh_.vertices.col(high) - mesh_.vertices.col(low)));
        return place->second;
    }

    void add(int a, int b, int c) { triangles_.emplace_back(a, b, c); }

    void divide(Eigen::Vector3i corner, const Cut& cut)
    {
        Eigen::Vector3i middle; // [k]: on the edge from corner k to the next
        for (int k = 0; k < 3; ++k) middle[k] = on_edge(corner[k], corner[(k + 1) % 3], cut);
        const int cuts = static_cast<int>((middle.array() >= 0).count());
        // Turn the triangle so that one cut is on its first edge, two on its first and last, about corner 0.
        const auto in_place = [&] { return cuts == 1 ? middle[0] >= 0 : middle[1] < 0; };
        if (cuts == 1 || cuts == 2)
            while (!in_place()) {
                corner = Eigen::Vector3i(corner[1], corner[2], corner[0]);
                middle = Eigen::Vector3i(middle[1], middle[2], middle[0]);
            }
        const auto [a, b, c] = std::array{corner[0], corner[1], corner[2]};
        const auto [ab, bc, ca] = std::array{middle[0], middle[1], middle[2]};
        if (cuts == 0) {
            add(a, b, c);
        } else if (cuts == 1) {
            add(a, ab, c);
            add(ab, b, c);
        } else if (cuts == 2) {
            add(a, ab, ca);
            const bool from_b = squared(b, ca) < squared(ab, c); // the quadrangle's shorter diagonal
            add(ab, b, from_b ? ca : c);
            add(from_b ? b : ab, c, ca);
        } else {
            add(a, ab, ca);
            add(ab, b, bc);
            add(ca, bc, c);
            add(ab, bc, ca);
        }
    }

    double squared(int a, int b) const
    {
        return (vertices_[static_cast<std::size_t>(a)] - vertices_[static_cast<std::size_t>(b)]).squaredNorm();
    }

    const Mesh& mesh_;
    std::vector<Vector3d> vertices_;
    std::vector<Eigen::Vector3i> triangles_;
    std::unordered_map<std::uint64_t, int> known_;
};

bool split(Mesh& mesh, const Cut& cut)
{
    Mesh result;
    const bool any = EdgeSplitter(mesh).split(cut, result);
    if (any) mesh = std::move(result);
    return any;
}

Vector2d flat(const Mesh& mesh, int vertex) { return mesh.vertices.col(vertex).head<2>(); }

/// Halves edges until none in the footprint is longer than `step`.
void halve_long_edges(Mesh& mesh, const std::vector<Anomaly>& anomalies, double step)
{
    const Cut cut = [&](int a, int b) -> std::optional<double> {
        if ((flat(mesh, b) - flat(mesh, a)).norm() <= step) return std::nullopt;
        Eigen::AlignedBox2d edge(flat(mesh, a));
        edge.extend(flat(mesh, b));
        for (const Anomaly& anomaly : anomalies)
            if (anomaly.footprint.intersects(edge)) return 0.5;
        return std::nullopt;
    };
    while (split(mesh, cut)) {
    }
}

/// Makes the zero line of a crease a line of mesh edges.
void cut_along(Mesh& mesh, const Anomaly& anomaly, const OverPlane& crease, double step)
{
    // A vertex this near to the crease stands for it: no slivers thinner than that.
    const double near = 1e-3 * step;
    Eigen::VectorXd side(mesh.vertices.cols());
    for (Index v = 0; v < side.size(); ++v) {
        const Vector2d at = mesh.vertices.col(v).head<2>();
        // Farther than one edge beyond the footprint no edge can cross the crease.
        const bool matters = anomaly.footprint.exteriorDistance(at) <= step;
        side[v] = matters ? crease(at) : -1;
        if (std::abs(side[v]) < near) side[v] = 0;
    }
    split(mesh, [&](int a, int b) -> std::optional<double> {
        if (side[a] * side[b] >= 0) return std::nullopt;
        // The crease is about a distance, so the crossing is nearly linear; two secant steps make it exact enough.
        const Vector2d from = flat(mesh, a), to = flat(mesh, b);
        double low = 0, high = 1, at_low = side[a], at_high = side[b];
        double t = 0.5;
        for (int round = 0; round < 3; ++round) {
            t = low + (high - low) * at_low / (at_low - at_high);
            const double value = crease(from + t * (to - from));
            if (value == 0) break;
            (value > 0) == (at_low > 0) ? (low = t, at_low = value) : (high = t, at_high = value);
        }
        return t;
    });
}

/// Halves edges that leave the profile by more than a chord may. @return whether there were any
bool follow_profile(Mesh& mesh, const std::vector<Anomaly>& anomalies, const Refinement& refinement)
{
    Eigen::VectorXd heights(mesh.vertices.cols());
    for (Index v = 0; v < heights.size(); ++v) heights[v] = height(anomalies, mesh.vertices.col(v).head<2>());
    return split(mesh, [&](int a, int b) -> std::optional<double> {
        const Vector2d from = flat(mesh, a), to = flat(mesh, b);
        if ((to - from).norm() < 2 * refinement.least) return std::nullopt;
        const double error = std::abs(height(anomalies, (from + to) / 2) - (heights[a] + heights[b]) / 2);
        return error > refinement.chord ? std::optional(0.5) : std::nullopt;
    });
}

/// Before the work: what edges of one step make of the plane under each anomaly.
void check_footprints(const Mesh& mesh, const std::vector<Anomaly>& anomalies, double step)
{
    const Eigen::Matrix<double, 3, 2> box = bounding_box(mesh.vertices);
    const Eigen::AlignedBox2d part(Vector2d(box.col(0).head<2>()), Vector2d(box.col(1).head<2>()));
    for (const Anomaly& anomaly : anomalies) {
        const Eigen::AlignedBox2d under = part.intersection(anomaly.footprint);
        if (!under.isEmpty()) check_size(2 * (under.sizes() / step).prod());
    }
}

} // namespace

void check_size(double triangles)
{
    constexpr double kMost = 2e7;
    if (triangles > kMost) throw InputError("too fine: it makes more than 20 million triangles");
}

Mesh refine(const Mesh& mesh, const std::vector<Anomaly>& anomalies, const Refinement& refinement)
{
    check_footprints(mesh, anomalies, refinement.step);
    Mesh refined = mesh;
    halve_long_edges(refined, anomalies, refinement.step);
    for (const Anomaly& anomaly : anomalies)
        for (const OverPlane& crease : anomaly.creases) cut_along(refined, anomaly, crease, refinement.step);

    // Halving from step to least takes so many rounds; more would only cut the needles at a crease again and again.
    for (double edge = refinement.step; edge > refinement.least; edge /= 2)
        if (!follow_profile(refined, anomalies, refinement)) break;
    return refined;
}

} // namespace fettle
