// A rough part: a design's surface with an allowance that varies over it.

#include "cli/tool.h"
#include "core/error.h"
#include "core/file.h"
#include "mesh/mesh.h"
#include "mesh/mesh_file.h"
#include "surface/patches.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace fettle;

namespace {

// Grid steps over each side of a patch: chords bend off a blade's nose by micrometres.
constexpr int kSteps = 400;
// Beyond a patch's border the sheet goes on straight, so that a ray from the border meets it, mm.
constexpr double kRim = 0.05;

struct Allowance {
    double least, most;
    Eigen::AlignedBox3d box; ///< of the design

    /// Waves, two to the design's size.
    double at(const Eigen::Vector3d& point) const
    {
        const Eigen::Vector3d place = (point - box.center()) / box.diagonal().norm() * 4 * std::numbers::pi;
        const double wave = std::sin(place.x() + 0.5 * place.y()) * std::cos(place.z() - 0.5 * place.y());
        return least + (most - least) * (1 + wave) / 2;
    }
};

/// A sheet of points, mm: with a rim on all sides.
struct Sheet {
    std::vector<Eigen::Vector3d> points, normals; ///< (kSteps + 3)², v within u
    static constexpr int side = kSteps + 3;
};

Sheet sheet_over(const Patch& patch)
{
    const Eigen::Matrix2d limits = domain(patch);
    Sheet sheet;
    for (int i = -1; i <= kSteps + 1; ++i)
        for (int j = -1; j <= kSteps + 1; ++j) {
            const auto share = [](int k) { return std::min(std::max(k, 0), kSteps) / double(kSteps); };
            const Eigen::Vector2d uv =
                limits.col(0) + (limits.col(1) - limits.col(0)).cwiseProduct(Eigen::Vector2d(share(i), share(j)));
            const Eigen::Matrix3d here = point_and_tangents(patch, uv);
            const auto beyond = [](int k) { return k < 0 ? -kRim : k > kSteps ? kRim : 0; };
            sheet.points.push_back(here.col(0) + beyond(i) * here.col(1).normalized() +
                                   beyond(j) * here.col(2).normalized());
            sheet.normals.push_back(here.col(1).cross(here.col(2)).normalized());
        }
    return sheet;
}

/// The patches' sheets, raised; their normals look away from the design's middle.
Mesh stock_of(const std::vector<Patch>& design, Allowance allowance)
{
    std::vector<Sheet> sheets;
    for (const Patch& patch : design) sheets.push_back(sheet_over(patch));
    for (const Sheet& sheet : sheets)
        for (const Eigen::Vector3d& point : sheet.points) allowance.box.extend(point);
    constexpr int side = Sheet::side;
    Mesh mesh{Eigen::Matrix3Xd(3, sheets.size() * side * side),
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

/// Each vertex is raised along the mean normal of its facets.
Mesh stock_of(Mesh mesh, Allowance allowance)
{
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, mesh.vertices.cols());
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Eigen::Vector3i c = mesh.triangles.col(t);
        const Eigen::Vector3d a = mesh.vertices.col(c[0]);
        const Eigen::Vector3d area = (mesh.vertices.col(c[1]) - a).cross(Eigen::Vector3d(mesh.vertices.col(c[2]) - a));
        for (const int k : c) normals.col(k) += area;
    }
    const Eigen::Matrix<double, 3, 2> box = bounding_box(mesh.vertices);
    allowance.box = Eigen::AlignedBox3d(Eigen::Vector3d(box.col(0)), Eigen::Vector3d(box.col(1)));
    for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
        const Eigen::Vector3d place = mesh.vertices.col(v);
        mesh.vertices.col(v) += allowance.at(place) * normals.col(v).normalized();
    }
    return mesh;
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "A rough part: a design with an allowance that varies over it, STL.", [](Tool& t) {
        const std::string& path = t.input("DESIGN", "B-spline patches (JSON) or a mesh");
        const auto& unit = t.length_unit("--file-units", "Unit of a mesh, if it is not mm");
        const double& least = t.number("--least", 0.2, "MM", "Allowance", Range::at_least(0));
        const double& most = t.number("--most", 0.6, "MM", "Allowance", Range::at_least(0));
        t.parse();
        const std::string bytes = read_whole(path);
        const Allowance allowance = {least, most, {}};
        if (bytes.starts_with('{'))
            write_stl(t.output(), stock_of(parse_patches(bytes, display_name(path)), allowance));
        else
            write_stl(t.output(),
                      stock_of(parse_mesh(bytes, display_name(path), unit.value_or(Units::Length::mm)), allowance));
        return Verdict::yes;
    });
}
