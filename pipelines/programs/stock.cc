// A rough part: a design's surface with an allowance that varies over it.

#include "cli/tool.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "mesh/mesh.h"
#include "mesh/mesh_file.h"
#include "robot/solve_path.h"
#include "surface/patches.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace fettle;

namespace {

// Grid steps over each side of a patch: chords bend off a blade's nose by micrometres.
constexpr int kSteps = 400;
// Beyond a patch's border the sheet goes on straight, so that a ray from the border meets it, mm.
constexpr double kRim = 0.05;

struct Allowance {
    double min, max;
    Eigen::AlignedBox3d box; ///< of the design

    /// Waves, two to the design's size.
    double at(const Eigen::Vector3d& point) const
    {
        const Eigen::Vector3d place = (point - box.center()) / box.diagonal().norm() * 4 * std::numbers::pi;
        const double wave = std::sin(place.x() + 0.5 * place.y()) * std::cos(place.z() - 0.5 * place.y());
        return min + (max - min) * (1 + wave) / 2;
    }
};

/// A sheet of points, mm: with a rim on all sides.
struct Sheet {
    std::vector<Eigen::Vector3d> points, normals; ///< (kSteps + 3)², v within u
    static constexpr int side = kSteps + 3;
};

Sheet sheet_over(const surface::Patch& patch)
{
    const Eigen::Matrix2d limits = surface::parameter_domain(patch);
    Sheet sheet;
    for (int i = -1; i <= kSteps + 1; ++i)
        for (int j = -1; j <= kSteps + 1; ++j) {
            const auto share = [](int k) { return std::min(std::max(k, 0), kSteps) / double(kSteps); };
            const Eigen::Vector2d uv =
                limits.col(0) + (limits.col(1) - limits.col(0)).cwiseProduct(Eigen::Vector2d(share(i), share(j)));
            const Eigen::Matrix3d here = surface::point_and_tangents(patch, uv);
            const auto beyond = [](int k) { return k < 0 ? -kRim : k > kSteps ? kRim : 0; };
            sheet.points.push_back(here.col(0) + beyond(i) * here.col(1).normalized() +
                                   beyond(j) * here.col(2).normalized());
            sheet.normals.push_back(here.col(1).cross(here.col(2)).normalized());
        }
    return sheet;
}

/// The patches' sheets, raised; their normals point away from the design's middle.
mesh::Mesh stock_of(const std::vector<surface::Patch>& design, Allowance allowance)
{
    std::vector<Sheet> sheets;
    for (const surface::Patch& patch : design) sheets.push_back(sheet_over(patch));
    for (const Sheet& sheet : sheets)
        for (const Eigen::Vector3d& point : sheet.points) allowance.box.extend(point);
    constexpr int side = Sheet::side;
    mesh::Mesh mesh{Eigen::Matrix3Xd(3, sheets.size() * side * side),
                    Eigen::Matrix3Xi(3, sheets.size() * 2 * (side - 1) * (side - 1))};
    Eigen::Index vertex = 0, triangle = 0;
    for (const Sheet& sheet : sheets) {
        double outward = 0;
        for (std::size_t k = 0; k < sheet.points.size(); ++k)
            outward += sheet.normals[k].dot(sheet.points[k] - allowance.box.center());
        const auto first = static_cast<int>(vertex);
        for (std::size_t k = 0; k < sheet.points.size(); ++k)
            mesh.vertices.col(vertex++) =
                sheet.points[k] + std::copysign(allowance.at(sheet.points[k]), outward) * sheet.normals[k];
        for (int i = 0; i + 1 < side; ++i)
            for (int j = 0; j + 1 < side; ++j) {
                const int a = first + i * side + j, b = a + side, c = b + 1, d = a + 1;
                mesh.triangles.col(triangle++) << a, (outward > 0 ? b : c), (outward > 0 ? c : b);
                mesh.triangles.col(triangle++) << a, (outward > 0 ? c : d), (outward > 0 ? d : c);
            }
    }
    return mesh;
}

/// Triangles whose edges are no longer than `longest`, on the same surface: an edge that is too long is halved in both
/// its triangles.
mesh::Mesh refined(mesh::Mesh mesh, double longest)
{
    using Edge = std::pair<int, int>;
    const auto edge = [](int a, int b) { return Edge(std::min(a, b), std::max(a, b)); };
    for (bool any = true; any;) {
        std::map<Edge, int> middles;
        std::vector<Eigen::Vector3d> vertices(mesh.vertices.colwise().begin(), mesh.vertices.colwise().end());
        const auto length = [&](const Edge& e) {
            return (mesh.vertices.col(e.first) - mesh.vertices.col(e.second)).norm();
        };
        std::vector<Eigen::Vector3i> triangles;
        for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
            for (int k = 0; k < 3; ++k) {
                const Edge e = edge(mesh.triangles(k, t), mesh.triangles((k + 1) % 3, t));
                if (length(e) <= longest || !middles.try_emplace(e, static_cast<int>(vertices.size())).second) continue;
                vertices.push_back((mesh.vertices.col(e.first) + mesh.vertices.col(e.second)) / 2);
            }
        const std::function<void(Eigen::Vector3i)> divide = [&](Eigen::Vector3i c) {
            int cut = -1;
            for (int k = 0; k < 3; ++k) {
                const Edge e = edge(c[k], c[(k + 1) % 3]);
                if (middles.count(e) > 0 && (cut < 0 || length(e) > length(edge(c[cut], c[(cut + 1) % 3])))) cut = k;
            }
            if (cut < 0) {
                triangles.push_back(c);
                return;
            }
            const int a = c[cut], b = c[(cut + 1) % 3], other = c[(cut + 2) % 3], middle = middles.at(edge(a, b));
            divide({a, middle, other});
            divide({middle, b, other});
        };
        for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) divide(mesh.triangles.col(t));
        any = !middles.empty();
        mesh.vertices = Eigen::Matrix3Xd::Map(vertices[0].data(), 3, static_cast<Eigen::Index>(vertices.size()));
        mesh.triangles = Eigen::Matrix3Xi::Map(triangles[0].data(), 3, static_cast<Eigen::Index>(triangles.size()));
    }
    return mesh;
}

/// Where the planes of a vertex's facets meet when all are raised by 1, by least squares with the facets' angles there
/// for weights; no farther than 2, as at edges of 60 degrees.
struct Corner {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();

    void add(const Eigen::Vector3d& normal, double angle)
    {
        squares += angle * normal * normal.transpose();
        sum += angle * normal;
    }
    Eigen::Vector3d raised() const
    {
        constexpr double kFlat = 1e-3; // of the angles: across the facets nothing is known
        const Eigen::Vector3d mean = sum.normalized();
        const double weight = kFlat * squares.trace();
        const Eigen::Vector3d rise = (squares + weight * Eigen::Matrix3d::Identity()).inverse() * (sum + weight * mean);
        return rise.norm() > 2 ? Eigen::Vector3d(2 * rise.normalized()) : rise;
    }
};

/// Each facet is raised along its normal.
mesh::Mesh stock_of(mesh::Mesh mesh, Allowance allowance)
{
    allowance.box = geometry::finite_bounding_box(mesh.vertices);
    constexpr double kFacets = 200; // to the part's size, a fifteenth of the allowance's waves
    mesh = refined(std::move(mesh), allowance.box.diagonal().norm() / kFacets);
    std::vector<Corner> corners(static_cast<std::size_t>(mesh.vertices.cols()));
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Eigen::Vector3i c = mesh.triangles.col(t);
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d at = mesh.vertices.col(c[k]);
            const Eigen::Vector3d a = mesh.vertices.col(c[(k + 1) % 3]) - at,
                                  b = mesh.vertices.col(c[(k + 2) % 3]) - at;
            const Eigen::Vector3d normal = a.cross(b);
            if (normal.norm() > 0)
                corners[static_cast<std::size_t>(c[k])].add(normal.normalized(), std::atan2(normal.norm(), a.dot(b)));
        }
    }
    for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
        const Corner& corner = corners[static_cast<std::size_t>(v)];
        if (corner.sum.norm() > 0) mesh.vertices.col(v) += allowance.at(mesh.vertices.col(v)) * corner.raised();
    }
    return mesh;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "A rough part: a design with an allowance that varies over it, STL.", [](cli::Tool& t) {
            const std::string& path = t.main_input("DESIGN", "B-spline patches (JSON) or a mesh");
            const auto& unit = t.length_unit("--file-units", "Unit of a mesh, if it is not mm");
            const double& min = t.number("--min", 0.2, "MM", "Allowance", core::Range::at_least(0));
            const double& max = t.number("--max", 0.6, "MM", "Allowance", core::Range::at_least(0));
            const std::string& at = t.text("--at", "0,0,0,1,0,0,0", "X,Y,Z,QW,QX,QY,QZ", "Where it stands");
            const bool& turned = t.flag("--turned", "Facets look the other way");
            t.parse();
            const std::string bytes = core::read_file(path);
            const Allowance allowance = {min, max, {}};
            mesh::Mesh stock;
            if (bytes.starts_with('{')) {
                stock = stock_of(surface::parse_patches(bytes, core::display_name(path)), allowance);
            } else {
                stock = mesh::parse_mesh(bytes, core::display_name(path), unit.value_or(units::Units::Length::mm));
                if (turned) stock.triangles.row(0).swap(stock.triangles.row(1));
                stock = stock_of(std::move(stock), allowance);
            }
            const Eigen::VectorXd pose = core::parse_number_list(at);
            if (pose.size() != 7 || !(pose.tail<4>().norm() > 0))
                throw core::InputError("--at", "expected x,y,z,qw,qx,qy,qz");
            const Eigen::Quaterniond turn(pose[3], pose[4], pose[5], pose[6]);
            stock.vertices = (turn.normalized().toRotationMatrix() * stock.vertices).colwise() + pose.head<3>();
            mesh::write_stl(t.output(), stock);
            return cli::Verdict::yes;
        });
}
