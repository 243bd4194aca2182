// Refined surfaces: heights in closed form, no gaps, and walls that are as sharp as the finer places allow.

#include "machining/milling.h"
#include "machining/refinement.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace fettle;

namespace refinement_test {

std::vector<machining::CutterMove> moves_through(const std::vector<Eigen::Vector3d>& tips)
{
    std::vector<machining::CutterMove> moves;
    for (std::size_t i = 0; i + 1 < tips.size(); ++i) {
        machining::CutterMove move;
        move.from = tips[i];
        move.to = tips[i + 1];
        move.feed = 10;
        moves.push_back(move);
    }
    return moves;
}

struct Machined {
    machining::Workpiece piece;
    removal::HeightField left;
};
Machined machined(const std::string& box, double cell, const machining::Cutter& cutter,
                  const std::vector<machining::CutterMove>& moves)
{
    Machined result{machining::box_workpiece(box, cell), {}};
    result.left = result.piece.stock;
    machining::MillingOptions options;
    options.floor = result.piece.floor;
    machining::mill(result.left, cutter, moves, options);
    return result;
}

/// Edges without a neighbour of opposite direction, but for those of the border.
std::size_t gaps(const mesh::Mesh& mesh, const removal::HeightField& field)
{
    using Key = std::array<double, 6>;
    std::map<Key, int> edges;
    for (const auto& t : mesh.triangles.colwise())
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d a = mesh.vertices.col(t[k]), b = mesh.vertices.col(t[(k + 1) % 3]);
            ++edges[{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
        }
    const Eigen::Vector2d low = field.centre(0, 0), high = field.centre(field.columns() - 1, field.rows() - 1);
    std::size_t count = 0;
    for (const auto& [e, n] : edges) {
        const bool on_border = (e[0] == e[3] && (e[0] == low.x() || e[0] == high.x())) ||
                               (e[1] == e[4] && (e[1] == low.y() || e[1] == high.y()));
        const auto back = edges.find({e[3], e[4], e[5], e[0], e[1], e[2]});
        count += n != 1 || (!on_border && back == edges.end());
    }
    return count;
}

/// ∫ (top − z) over the mesh.
double volume_under(const mesh::Mesh& mesh, double top)
{
    double volume = 0;
    for (const auto& t : mesh.triangles.colwise()) {
        const Eigen::Vector3d a = mesh.vertices.col(t[0]), b = mesh.vertices.col(t[1]), c = mesh.vertices.col(t[2]);
        const double area = ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
        EXPECT_GT(area, 0);
        volume += area * (top - (a.z() + b.z() + c.z()) / 3);
    }
    return volume;
}

TEST(Refinement, SharpensWalls)
{
    // A slot of 6 mm, 3 deep, askew through a block: straight walls, at one end a half circle.
    const machining::Cutter cutter = machining::parse_cutter("flat:6");
    const Eigen::Vector3d from(-10, 3.3, -3), to(25.3, 21.7, -3);
    const auto moves = moves_through({from, to});
    const Machined part = machined("0,0,-10,40,30,0", 0.5, cutter, moves);
    // of the half circle all lies in the block; the path in it begins at its side x = 0.25, the first cells' centres
    for (const int factor : {1, 2, 8}) {
        const machining::Refinement map(part.piece, part.left, cutter, moves, factor);
        const machining::Refinement* used = factor > 1 ? &map : nullptr;
        const mesh::Mesh mesh = machining::triangulate_rows(part.left, 0, part.left.rows() - 1, used);
        EXPECT_EQ(gaps(mesh, part.left), 0u) << factor;
        // no triangle leads from the bottom to the top over more than one place and its diagonal
        double widest = 0;
        for (const auto& t : mesh.triangles.colwise()) {
            const Eigen::Matrix3d c = mesh.vertices(Eigen::all, t);
            if (c.row(2).maxCoeff() - c.row(2).minCoeff() < 1) continue;
            for (int k = 0; k < 3; ++k) widest = std::max(widest, (c.col(k) - c.col((k + 1) % 3)).head<2>().norm());
        }
        EXPECT_NEAR(widest, std::sqrt(2) * 0.5 / factor, 1e-12);
        for (const auto& p : mesh.vertices.colwise()) {
            if (std::isnan(p.z())) continue;
            const Eigen::Vector2d step = (to - from).head<2>(), off = p.head<2>() - from.head<2>();
            const double share = std::clamp(off.dot(step) / step.squaredNorm(), 0.0, 1.0);
            const double beside = (off - share * step).norm();
            if (std::abs(beside - 3) > 1e-6) {
                EXPECT_EQ(p.z(), beside < 3 ? -3 : 0);
            }
        }
        const double exact =
            3 * (6 * ((to - from).head<2>().norm() - 10.25 / ((to - from).x()) * (to - from).head<2>().norm()) +
                 4.5 * 3.14159265358979);
        const double error = std::abs(volume_under(mesh, 0) - exact) / exact;
        EXPECT_LT(error, 4e-3 / factor);
        EXPECT_GT(map.count(), 100u);
    }
}

TEST(Refinement, LeavesNoGapsAndAgreesWithFinerMaps)
{
    const machining::Cutter cutter = machining::parse_cutter("ball:5");
    std::vector<Eigen::Vector3d> tips;
    for (int k = 0; k < 60; ++k)
        tips.emplace_back(10 + 6 * std::cos(0.4 * k) + 0.05 * k, 10 + 5 * std::sin(0.55 * k),
                          -4 + 2.5 * std::sin(0.7 * k));
    const auto moves = moves_through(tips);
    const Machined part = machined("0,0,-5,20,20,0", 0.4, cutter, moves); // here and there cut through
    const machining::Refinement map(part.piece, part.left, cutter, moves, 4);
    EXPECT_GT(map.count(), 100u);
    EXPECT_GT(part.left.z.isNaN().count(), 10);
    const mesh::Mesh mesh = machining::triangulate_rows(part.left, 0, part.left.rows() - 1, &map);
    const mesh::Mesh coarse = machining::triangulate_rows(part.left, 0, part.left.rows() - 1);
    // along the rims of holes there are no neighbours, refined or not
    EXPECT_LE(gaps(mesh, part.left), 6 * gaps(coarse, part.left));
    // Every place is that of a map which has a cell there.
    removal::HeightField fine = part.piece.stock;
    fine.cell = 0.1;
    fine.origin = part.left.centre(0, 0).array() - 0.05;
    fine.z = Eigen::ArrayXXd::Constant(4 * 49 + 1, 4 * 49 + 1, 0);
    machining::MillingOptions options;
    options.floor = -5;
    machining::mill(fine, cutter, moves, options);
    for (Eigen::Index j = 0; j < 49; ++j)
        for (Eigen::Index i = 0; i < 49; ++i) {
            if (!map.is_refined(i, j)) continue;
            for (int b = 0; b <= 4; ++b)
                for (int a = 0; a <= 4; ++a) {
                    const Eigen::Vector3d place = map.point(i, j, a, b);
                    const double z = fine.z(4 * i + a, 4 * j + b);
                    ASSERT_EQ(std::isnan(place.z()), std::isnan(z));
                    if (!std::isnan(z)) {
                        EXPECT_NEAR(place.z(), z, 1e-9);
                    }
                }
        }
    // The STL is that mesh.
    std::ostringstream out;
    EXPECT_EQ(machining::write_stl(out, part.left, &map), static_cast<std::size_t>(mesh.triangles.cols()));
    EXPECT_EQ(out.str().size(), 84 + 50 * static_cast<std::size_t>(mesh.triangles.cols()));
}

} // namespace refinement_test
