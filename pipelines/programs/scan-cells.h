#pragma once
// Cells cut from a scan where it is smooth, each at its own place and turn and of its own size (scans.cc).
#include "core/decompositions.h"
#include "core/direction.h"
#include "mesh/shape_file.h"
#include "sampling/scan.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

namespace scan_cells {

using namespace fettle;

// A cell lies on one face of the part, as an operator would choose it: nowhere within S does it lean more than 30° from
// its mean normal, or turn by more than 17° from one step of the grid to the next.
constexpr int kFaceSteps = 24;
constexpr double kMaxSlope = 0.58;
constexpr double kMaxSlopeChange = 0.3;
constexpr int kInside = 31; // places along each side of B at which fit and scan are compared
// Steps between such places by which the smooth surface goes on beyond B, a sixth of its sides. At the border of what a
// polynomial is fitted to it follows the scanner's noise: there 0.8 of a place's weight is its own, inside 0.2 at most.
constexpr int kAround = 5;

struct Cell {
    double a, b;                              ///< sides of B, mm
    double d;                                 ///< from B to S, mm
    std::shared_ptr<const sampling::Scan> on; ///< the piece, its middle at the origin, its mean normal upwards
};

inline double uniform(std::mt19937_64& random, double low, double high)
{
    return low + (high - low) * (static_cast<double>(random() >> 11) / 9007199254740992.0);
}

/// The triangles with a corner within `radius` of a point.
inline mesh::Mesh crop(const mesh::Mesh& mesh, const Eigen::Vector3d& middle, double radius)
{
    const Eigen::Array<bool, 1, Eigen::Dynamic> near =
        (mesh.vertices.colwise() - middle).colwise().squaredNorm().array() <= radius * radius;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
        if (near[mesh.triangles(0, t)] || near[mesh.triangles(1, t)] || near[mesh.triangles(2, t)]) kept.push_back(t);
    std::vector<int> number(mesh.vertices.cols(), -1), used;
    mesh::Mesh piece;
    piece.triangles = mesh.triangles(Eigen::all, kept);
    for (int& corner : piece.triangles.reshaped()) {
        int& now = number[corner];
        if (now < 0) {
            now = static_cast<int>(used.size());
            used.push_back(corner);
        }
        corner = now;
    }
    piece.vertices = mesh.vertices(Eigen::all, used);
    return piece;
}

inline cloud::Cloud crop(const cloud::Cloud& cloud, const Eigen::Vector3d& middle, double radius)
{
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < cloud.size(); ++i)
        if ((cloud.xyz.col(i) - middle).squaredNorm() <= radius * radius) kept.push_back(i);
    cloud::Cloud piece;
    piece.xyz = cloud.xyz(Eigen::all, kept);
    return piece;
}

inline Eigen::Vector3d mean_normal(const mesh::Mesh& mesh)
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const mesh::Triangle corner = mesh::triangle_of(mesh, t);
        const Eigen::Vector3d first = corner.col(1) - corner.col(0), second = corner.col(2) - corner.col(0);
        sum += first.cross(second);
    }
    return sum.normalized();
}

/// Normal of the least-squares plane, upwards: a cloud is seen from above.
inline Eigen::Vector3d mean_normal(const cloud::Cloud& cloud)
{
    const Eigen::Matrix3Xd about = cloud.xyz.colwise() - cloud.xyz.rowwise().mean().eval();
    const Eigen::Vector3d n = core::symmetric_eigen<3>(about * about.transpose()).vectors.col(0);
    return n.z() < 0 ? Eigen::Vector3d(-n) : n;
}

template <typename Shape>
Eigen::Matrix3Xd& coordinates(Shape& shape)
{
    if constexpr (std::is_same_v<Shape, mesh::Mesh>)
        return shape.vertices;
    else
        return shape.xyz;
}

/// Is the piece one face all over the rectangle of S?
inline bool is_one_face(const sampling::Scan& scan, double width, double length)
{
    Eigen::MatrixXd z(kFaceSteps + 1, kFaceSteps + 1);
    const double u = width / kFaceSteps, v = length / kFaceSteps;
    for (int j = 0; j <= kFaceSteps; ++j)
        for (int i = 0; i <= kFaceSteps; ++i) {
            const std::optional<double> height = scan.height({i * u - width / 2, j * v - length / 2});
            if (!height) return false;
            z(i, j) = *height;
        }
    const Eigen::MatrixXd along = (z.bottomRows(kFaceSteps) - z.topRows(kFaceSteps)) / u;
    const Eigen::MatrixXd across = (z.rightCols(kFaceSteps) - z.leftCols(kFaceSteps)) / v;
    if (std::max(along.cwiseAbs().maxCoeff(), across.cwiseAbs().maxCoeff()) > kMaxSlope) return false;
    const double change =
        std::max((along.bottomRows(kFaceSteps - 1) - along.topRows(kFaceSteps - 1)).cwiseAbs().maxCoeff(),
                 (across.rightCols(kFaceSteps - 1) - across.leftCols(kFaceSteps - 1)).cwiseAbs().maxCoeff());
    return change <= kMaxSlopeChange;
}

// The shortest waves that the margin believes in (lib/margin/waves.cc), over the shorter side of B: a quarter of the
// touches' radius, which is about B. A scan that is coarser says nothing about them.
constexpr double kShortestWaves = 0.25;

/// Does the mesh know the part all over S, where it is touched and judged, down to waves of this length? What lies
/// between the lines of a scan is a guess: so the longest side of a triangle, the mean by area, is no longer.
inline bool is_resolved(const mesh::Mesh& piece, double waves, const Eigen::Array2d& S)
{
    constexpr double kMinCover = 0.9; // of S from above; less is cheaper to find here than by heights
    double sum = 0, area = 0, from_above = 0;
    for (Eigen::Index t = 0; t < piece.triangles.cols(); ++t) {
        const mesh::Triangle corner = mesh::triangle_of(piece, t);
        if ((corner.topRows<2>().rowwise().mean().array().abs() > S / 2).any()) continue;
        const Eigen::Vector3d u = corner.col(1) - corner.col(0), v = corner.col(2) - corner.col(1);
        const Eigen::Vector3d normal = u.cross(v) / 2;
        sum += normal.norm() * std::max({u.norm(), v.norm(), (u + v).norm()});
        area += normal.norm();
        from_above += std::max(0.0, normal.z());
    }
    return from_above >= kMinCover * S.prod() && sum <= waves * area;
}

/// Does the cloud: has each square of this size a point?
inline bool is_resolved(const cloud::Cloud& piece, double waves, const Eigen::Array2d& S)
{
    const Eigen::Array2d squares = (S / waves).ceil();
    Eigen::ArrayXXi points = Eigen::ArrayXXi::Zero(int(squares.x()), int(squares.y()));
    for (const auto& point : piece.xyz.colwise()) {
        const Eigen::Array2d at = (point.head<2>().array() / S + 0.5) * squares;
        if ((at >= 0).all() && (at < squares).all()) ++points(int(at.x()), int(at.y()));
    }
    return (points > 0).all();
}

template <typename Shape>
std::optional<Cell> try_cell(const Shape& all, double min, double max, std::mt19937_64& random)
{
    const double a = min * std::pow(max / min, uniform(random, 0, 1));
    const double b = std::clamp(a * std::exp(uniform(random, -0.7, 0.7)), min, max);
    const double d = std::max(a, b) * uniform(random, 0.2, 0.6);
    const Eigen::Vector2d S(a + 2 * d, b + 2 * d);
    const Eigen::Matrix3Xd& points = coordinates(const_cast<Shape&>(all));
    const Eigen::Vector3d middle =
        points.col(static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(points.cols())));
    const double turn = uniform(random, 0, 2 * std::numbers::pi);
    Shape piece = crop(all, middle, 0.6 * S.norm());
    if (coordinates(piece).cols() < 50) return std::nullopt;
    const Eigen::Vector3d normal = mean_normal(piece);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * core::rotation_between(normal, Eigen::Vector3d::UnitZ());
    coordinates(piece) = R * (coordinates(piece).colwise() - middle);
    if (!is_resolved(piece, kShortestWaves * std::min(a, b), S)) return std::nullopt;
    Cell cell{a, b, d, std::make_shared<sampling::Scan>(std::move(piece))};
    if (!is_one_face(*cell.on, S.x(), S.y())) return std::nullopt;
    return cell;
}

/// A place inside B, or beyond it for a number below 0 or above kInside - 1.
inline Eigen::Vector2d place(const Cell& cell, int i, int j)
{
    constexpr double kWithin = 1 - 1e-9; // of rounding at the edge of B
    return kWithin * Eigen::Vector2d((i / (kInside - 1.0) - 0.5) * cell.a, (j / (kInside - 1.0) - 0.5) * cell.b);
}

} // namespace scan_cells
