#include "part/refine.h"

#include "core/error.h"
#include "geometry/bounding_box.h"

#include <cmath>
#include <functional>
#include <optional>
#include <unordered_map>

namespace fettle::part {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Position of the split of an edge, as a fraction of the distance from vertex `low` to `high`; nothing: no split.
using SplitRule = std::function<std::optional<double>(int low, int high)>;

class EdgeSplitter {
  public:
    EdgeSplitter(const mesh::Mesh& mesh, const SplitRule& rule) : mesh_(mesh), rule_(rule)
    {
        for (Index v = 0; v < mesh.vertices.cols(); ++v) vertices_.push_back(mesh.vertices.col(v));
    }

    /// Splits each edge at most once. @return  nothing if no edge was split
    std::optional<mesh::Mesh> split()
    {
        for (const Eigen::Vector3i corners : mesh_.triangles.colwise()) {
            split_triangle(corners);
            check_triangle_count(triangles_.size());
        }
        if (Index(vertices_.size()) == mesh_.vertices.cols()) return std::nullopt;
        mesh::Mesh result;
        result.vertices = Eigen::Map<Eigen::Matrix3Xd>(vertices_[0].data(), 3, vertices_.size());
        result.triangles = Eigen::Map<Eigen::Matrix3Xi>(triangles_[0].data(), 3, triangles_.size());
        return result;
    }

  private:
    /// Index of the new vertex on an edge, -1 if the edge is not split.
    int split_edge(int a, int b)
    {
        const auto [low, high] = std::minmax(a, b);
        const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
        const auto [entry, is_new] = edge_vertices_.try_emplace(key, -1);
        if (!is_new) return entry->second;
        const std::optional<double> t = rule_(low, high);
        if (!t) return -1;
        entry->second = vertices_.size();
        vertices_.push_back(mesh_.vertices.col(low) + *t * (mesh_.vertices.col(high) - mesh_.vertices.col(low)));
        return entry->second;
    }

    void add(int a, int b, int c) { triangles_.emplace_back(a, b, c); }

    void split_triangle(Eigen::Vector3i corner)
    {
        Eigen::Vector3i middle; // [k]: on the edge from corner k to the next
        for (int k = 0; k < 3; ++k) middle[k] = split_edge(corner[k], corner[(k + 1) % 3]);
        const int cuts = (middle.array() >= 0).count();
        // Rotate the corners so that a single cut is on the first edge, two cuts are on the first and the last edge.
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
            const bool from_b = squared_distance(b, ca) < squared_distance(ab, c); // shorter diagonal of the quad
            add(ab, b, from_b ? ca : c);
            add(from_b ? b : ab, c, ca);
        } else {
            add(a, ab, ca);
            add(ab, b, bc);
            add(ca, bc, c);
            add(ab, bc, ca);
        }
    }

    double squared_distance(int a, int b) const { return (vertices_[a] - vertices_[b]).squaredNorm(); }

    const mesh::Mesh& mesh_;
    const SplitRule& rule_;
    std::vector<Vector3d> vertices_;
    std::vector<Eigen::Vector3i> triangles_;
    std::unordered_map<std::uint64_t, int> edge_vertices_;
};

/// Splits the edges once by a rule. @return whether any was split
bool split(mesh::Mesh& mesh, const SplitRule& rule)
{
    std::optional<mesh::Mesh> result = EdgeSplitter(mesh, rule).split();
    if (result) mesh = std::move(*result);
    return result.has_value();
}

Vector2d xy(const mesh::Mesh& mesh, int vertex) { return mesh.vertices.col(vertex).head<2>(); }

/// Halves edges until none in the footprint is longer than `step`.
void halve_long_edges(mesh::Mesh& mesh, const std::vector<Anomaly>& anomalies, double step)
{
    const SplitRule rule = [&](int a, int b) -> std::optional<double> {
        if ((xy(mesh, b) - xy(mesh, a)).norm() <= step) return std::nullopt;
        Eigen::AlignedBox2d edge(xy(mesh, a));
        edge.extend(xy(mesh, b));
        for (const Anomaly& anomaly : anomalies)
            if (anomaly.footprint.intersects(edge)) return 0.5;
        return std::nullopt;
    };
    while (split(mesh, rule)) {
    }
}

/// Makes the zero level set of a crease a polyline of mesh edges.
void insert_crease(mesh::Mesh& mesh, const Anomaly& anomaly, const ScalarField2d& crease, double step)
{
    // A vertex within this distance counts as on the crease, to avoid slivers.
    const double snap_distance = 1e-3 * step;
    Eigen::VectorXd side(mesh.vertices.cols());
    for (Index v = 0; v < side.size(); ++v) {
        // Edges of vertices farther than one edge outside the footprint cannot cross the crease.
        const bool near = anomaly.footprint.exteriorDistance(xy(mesh, v)) <= step;
        side[v] = near ? crease(xy(mesh, v)) : -1;
        if (std::abs(side[v]) < snap_distance) side[v] = 0;
    }
    split(mesh, [&](int a, int b) -> std::optional<double> {
        if (side[a] * side[b] >= 0) return std::nullopt;
        // Regula falsi: the crease is approximately a distance, thus nearly linear, and three steps suffice.
        const Vector2d from = xy(mesh, a), to = xy(mesh, b);
        double low = 0, high = 1, at_low = side[a], at_high = side[b];
        double t = 0.5;
        for (int step_count = 0; step_count < 3; ++step_count) {
            t = low + (high - low) * at_low / (at_low - at_high);
            const double value = crease(from + t * (to - from));
            if (value == 0) break;
            (value > 0) == (at_low > 0) ? (low = t, at_low = value) : (high = t, at_high = value);
        }
        return t;
    });
}

/// Halves the edges that exceed the chord error. @return whether there were any
bool halve_coarse_edges(mesh::Mesh& mesh, const std::vector<Anomaly>& anomalies, const RefineOptions& options)
{
    Eigen::VectorXd heights(mesh.vertices.cols());
    for (Index v = 0; v < heights.size(); ++v) heights[v] = height(anomalies, xy(mesh, v));
    return split(mesh, [&](int a, int b) -> std::optional<double> {
        const Vector2d from = xy(mesh, a), to = xy(mesh, b);
        if ((to - from).norm() < 2 * options.min_edge) return std::nullopt;
        const double error = std::abs(height(anomalies, (from + to) / 2) - (heights[a] + heights[b]) / 2);
        return error > options.chord_error ? std::optional(0.5) : std::nullopt;
    });
}

/// Fails early if triangles with edges of one step under each anomaly are too many.
void check_footprints(const mesh::Mesh& mesh, const std::vector<Anomaly>& anomalies, double step)
{
    const Eigen::AlignedBox3d box = geometry::finite_bounding_box(mesh.vertices);
    const Eigen::AlignedBox2d part(box.min().head<2>(), box.max().head<2>());
    for (const Anomaly& anomaly : anomalies) {
        const Eigen::AlignedBox2d under = part.intersection(anomaly.footprint);
        if (!under.isEmpty()) check_triangle_count(2 * (under.sizes() / step).prod());
    }
}

} // namespace

void check_triangle_count(double triangles)
{
    constexpr double kMaxTriangles = 2e7;
    if (triangles > kMaxTriangles) throw core::InputError("too fine: it makes more than 20 million triangles");
}

mesh::Mesh refine(const mesh::Mesh& mesh, const std::vector<Anomaly>& anomalies, const RefineOptions& options)
{
    check_footprints(mesh, anomalies, options.step);
    mesh::Mesh refined = mesh;
    halve_long_edges(refined, anomalies, options.step);
    for (const Anomaly& anomaly : anomalies)
        for (const ScalarField2d& crease : anomaly.creases) insert_crease(refined, anomaly, crease, options.step);

    // Halving from step to min_edge takes so many rounds; more rounds would only split the slivers at creases.
    for (double edge = options.step; edge > options.min_edge; edge /= 2)
        if (!halve_coarse_edges(refined, anomalies, options)) break;
    return refined;
}

} // namespace fettle::part
