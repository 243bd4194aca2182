#include "cad/refinement.h"

#include "cad/face_triangle.h"
#include "cad/foot.h"
#include "cad/point.h"

#include <BRep_Tool.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <Poly_Triangulation.hxx>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace fettle::cad {
namespace {

// Each round halves edges of the facets beyond the tolerance. Two rounds leave a quarter of the deviation or less:
// twenty reduce a metre to a micron.
constexpr int kMaxRefinements = 20;
constexpr double kOnSurfaceShare = 0.25; // of the tolerance: edges closer to the surface count as on it
constexpr double kMinSplitShare = 0.75;  // of the largest distance: edges nearly as far are split in the same round

constexpr double kNodeTolerance = 1e-7; // mm, as OpenCASCADE's tolerance of points

using EdgeKey = std::pair<int, int>; ///< its nodes, the lower first

/// Barycentric coordinates of the midpoint of edge k, from corner k to the next.
Eigen::Vector3d middle_of_edge(int k)
{
    Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.5);
    middle[(k + 2) % 3] = 0;
    return middle;
}

/// The triangles of a face with the parameters of their nodes.
struct Net {
    std::vector<Eigen::Vector3d> nodes; ///< in the frame of the placed face, mm
    std::vector<Eigen::Vector2d> uv;
    struct Facet {
        std::array<int, 3> nodes;
        bool is_within = false;
    };
    std::vector<Facet> facets;

    EdgeKey edge(const Facet& f, int k) const
    {
        return std::minmax(f.nodes[static_cast<std::size_t>(k)], f.nodes[static_cast<std::size_t>((k + 1) % 3)]);
    }
    double squared_length(const EdgeKey& e) const
    {
        return (nodes[static_cast<std::size_t>(e.first)] - nodes[static_cast<std::size_t>(e.second)]).squaredNorm();
    }
    FaceTriangle triangle(const Adaptor3d_Surface& surface, const Facet& f) const
    {
        mesh::Triangle corners;
        Eigen::Matrix<double, 2, 3> parameters;
        for (int k = 0; k < 3; ++k) {
            const auto node = static_cast<std::size_t>(f.nodes[static_cast<std::size_t>(k)]);
            corners.col(k) = nodes[node];
            parameters.col(k) = uv[node];
        }
        return face_triangle(surface, corners, parameters);
    }
};

Net net_of(const Poly_Triangulation& triangulation, const gp_Trsf& placing)
{
    Net net;
    for (int i = 1; i <= triangulation.NbNodes(); ++i) {
        net.nodes.push_back(vector_of(triangulation.Node(i).Transformed(placing)));
        net.uv.emplace_back(triangulation.UVNode(i).X(), triangulation.UVNode(i).Y());
    }
    for (int i = 1; i <= triangulation.NbTriangles(); ++i) {
        std::array<int, 3> n{};
        triangulation.Triangle(i).Get(n[0], n[1], n[2]);
        net.facets.push_back({{n[0] - 1, n[1] - 1, n[2] - 1}});
    }
    return net;
}

/// The edges that are to be split, with the node at their midpoint; -1: not yet created.
class Splits {
  public:
    explicit Splits(const Net& net, const Adaptor3d_Surface& surface, double tolerance) : net_(net)
    {
        for (const Net::Facet& f : net.facets)
            for (int k = 0; k < 3; ++k) ++facets_at_[net.edge(f, k)];
        for (const Net::Facet& f : net.facets)
            if (!f.is_within) add(f, surface, tolerance);
        while (any() && add_at_poles()) {
        }
    }
    bool any() const { return !middle_.empty(); }
    /// Node at the midpoint of an edge, if the edge is to be split.
    int* middle(const EdgeKey& e)
    {
        const auto found = middle_.find(e);
        return found == middle_.end() ? nullptr : &found->second;
    }

  private:
    /// Splits the edge of a facet that is farthest from the surface, and edges nearly as far. If all edges are on the
    /// surface, the longest is split. So a cone is divided across its generatrices alone.
    void add(const Net::Facet& f, const Adaptor3d_Surface& surface, double tolerance)
    {
        const FaceTriangle triangle = net_.triangle(surface, f);
        std::array<double, 3> distance{}, length{};
        for (int k = 0; k < 3; ++k) {
            if (facets_at_.at(net_.edge(f, k)) != 2) continue; // an edge on the border of the face is not split
            const Eigen::Vector3d middle = middle_of_edge(k);
            const Eigen::Vector3d flat = triangle.corners * middle;
            distance[k] = (foot_on_surface(surface, triangle.parameters(middle), flat).point - flat).norm();
            length[k] = net_.squared_length(net_.edge(f, k));
        }
        if (*std::ranges::max_element(distance) < kOnSurfaceShare * tolerance) distance = length;
        const double largest = *std::ranges::max_element(distance);
        for (int k = 0; k < 3; ++k)
            if (distance[k] > 0 && distance[k] > kMinSplitShare * largest) middle_.emplace(net_.edge(f, k), -1);
    }

    /// Splits both sides of degenerate facets if one is to be split. At a pole such facets, without an area, join the
    /// nodes of neighbouring facets, and their two long sides are one line.
    /// @return  whether a side was added
    bool add_at_poles()
    {
        bool has_grown = false;
        for (const Net::Facet& f : net_.facets)
            for (int k = 0; k < 3; ++k) {
                const EdgeKey base = net_.edge(f, k), a = net_.edge(f, (k + 1) % 3), b = net_.edge(f, (k + 2) % 3);
                if (net_.squared_length(base) > kNodeTolerance * kNodeTolerance ||
                    middle_.contains(a) == middle_.contains(b))
                    continue;
                middle_.emplace(middle_.contains(a) ? b : a, -1);
                has_grown = true;
            }
        return has_grown;
    }

    const Net& net_;
    std::map<EdgeKey, int> facets_at_, middle_;
};

/// Adds a node on the surface at the midpoint of an edge of a facet. @return  its index
int add_middle(Net& net, const Adaptor3d_Surface& surface, const Net::Facet& f, int k)
{
    const Eigen::Vector2d uv = net.triangle(surface, f).parameters(middle_of_edge(k));
    net.uv.push_back(uv);
    net.nodes.push_back(vector_of(surface.Value(uv.x(), uv.y())));
    return static_cast<int>(net.nodes.size()) - 1;
}

/// Bisects a facet at the longest of its edges that are to be split, and its halves recursively.
void split(Net& net, Splits& splits, const Net::Facet& f, std::vector<Net::Facet>& into)
{
    int longest = -1;
    for (int k = 0; k < 3; ++k)
        if (splits.middle(net.edge(f, k)) != nullptr &&
            (longest < 0 || net.squared_length(net.edge(f, k)) > net.squared_length(net.edge(f, longest))))
            longest = k;
    if (longest < 0) {
        into.push_back(f);
        return;
    }
    const auto at = [&](int k) { return f.nodes[static_cast<std::size_t>((longest + k) % 3)]; };
    const int middle = *splits.middle(net.edge(f, longest));
    split(net, splits, {{at(0), middle, at(2)}}, into);
    split(net, splits, {{middle, at(1), at(2)}}, into);
}

void write_back(const Net& net, const gp_Trsf& placing, Poly_Triangulation& triangulation)
{
    const gp_Trsf back = placing.Inverted();
    const int old = triangulation.NbNodes();
    triangulation.ResizeNodes(static_cast<int>(net.nodes.size()), true);
    triangulation.ResizeTriangles(static_cast<int>(net.facets.size()), false);
    for (std::size_t i = static_cast<std::size_t>(old); i < net.nodes.size(); ++i) {
        const Eigen::Vector3d& p = net.nodes[i];
        triangulation.SetNode(static_cast<int>(i) + 1, gp_Pnt(p.x(), p.y(), p.z()).Transformed(back));
        triangulation.SetUVNode(static_cast<int>(i) + 1, gp_Pnt2d(net.uv[i].x(), net.uv[i].y()));
    }
    for (std::size_t i = 0; i < net.facets.size(); ++i) {
        const std::array<int, 3>& n = net.facets[i].nodes;
        triangulation.SetTriangle(static_cast<int>(i) + 1, Poly_Triangle(n[0] + 1, n[1] + 1, n[2] + 1));
    }
}

} // namespace

void refine_triangles(const TopoDS_Face& face, double tolerance)
{
    const BRepAdaptor_Surface surface(face, false);
    if (surface.GetType() == GeomAbs_Plane) return;
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
    const gp_Trsf& placing = location.Transformation();
    Net net = net_of(*triangulation, placing);
    const std::size_t before = net.facets.size();
    for (int round = 0; round < kMaxRefinements; ++round) {
        for (Net::Facet& f : net.facets)
            f.is_within = f.is_within || triangle_bound(surface, net.triangle(surface, f), tolerance,
                                                        Correspondence::by_parameters) <= tolerance;
        Splits splits(net, surface, tolerance);
        if (!splits.any()) break;
        for (std::size_t i = 0; i < net.facets.size(); ++i)
            for (int k = 0; k < 3; ++k)
                if (int* middle = splits.middle(net.edge(net.facets[i], k)); middle != nullptr && *middle < 0)
                    *middle = add_middle(net, surface, net.facets[i], k);
        std::vector<Net::Facet> facets;
        facets.reserve(2 * net.facets.size());
        for (const Net::Facet& f : net.facets) split(net, splits, f, facets);
        net.facets = std::move(facets);
    }
    if (net.facets.size() > before) write_back(net, placing, *triangulation);
}

} // namespace fettle::cad
