#include "belt/fem_layer.h"

#include "belt/fem_element.h"
#include "core/error.h"

#include <boost/math/quadrature/gauss.hpp>
#include <Eigen/Cholesky>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kGrowth = 1.3; // from element to element, where nothing is pressed on

/// What an element adds at one phase, in the directions radius, arc, axis of each node: even + cosine · cos + sine ·
/// sin. The displacement along the arc is a quarter of a wave behind the others, which keeps all of it real.
struct WaveElement {
    using Matrix = Eigen::Matrix<double, 12, 12>;
    Matrix even, cosine, sine;
    Matrix at(double phase) const { return even + std::cos(phase) * cosine + std::sin(phase) * sine; }
};

WaveElement wave_element(const LayerMesh& mesh, Index column, Index level)
{
    const double turn = mesh.cell.x() / mesh.radius;
    Hexahedron corners;
    HexahedronStiffness axes = HexahedronStiffness::Zero(); // of each corner: radius, arc, axis
    for (int corner = 0; corner < 8; ++corner) {
        const double angle = corner % 2 * turn, s = std::sin(angle), c = std::cos(angle);
        const double below = mesh.depth[level + corner / 4], r = mesh.radius - below;
        // From the surface's lowest point: no digits go where the radius is long.
        corners.col(corner) << r * s, mesh.across[column + corner / 2 % 2],
            below * c + 2 * mesh.radius * std::pow(std::sin(angle / 2), 2);
        axes.block<3, 3>(3 * corner, 3 * corner) << s, c, 0, 0, 0, 1, -c, s, 0;
    }
    const HexahedronStiffness local = axes.transpose() * stiffness(corners, mesh.layer) * axes;
    WaveElement::Matrix here, next, coupling;
    for (int b = 0; b < 12; ++b)
        for (int a = 0; a < 12; ++a) {
            const int i = a / 3 * 6 + a % 3, j = b / 3 * 6 + b % 3; // corners 0, 2, 4, 6; 3 more: their neighbours
            here(a, b) = local(i, j);
            next(a, b) = local(i + 3, j + 3);
            coupling(a, b) = local(i, j + 3);
        }
    WaveElement element{here + next, coupling + coupling.transpose(), coupling.transpose() - coupling};
    // Mirrored, the element is itself: even and cosine do not couple the arc with radius and axis, sine nothing else.
    for (int b = 0; b < 12; ++b)
        for (int a = 0; a < 12; ++a) {
            const bool is_arc = a % 3 == 1;
            if (is_arc == (b % 3 == 1)) {
                element.sine(a, b) = 0;
            } else {
                element.even(a, b) = element.cosine(a, b) = 0;
                if (is_arc) element.sine(a, b) = -element.sine(a, b);
            }
        }
    return element;
}

/// Stiffness of a ring at one phase, by columns of nodes, each from the surface to the hub, whose own nodes stay.
struct RingStiffness {
    struct Part {
        MatrixXd even, cosine, sine;
        explicit Part(Index size)
            : even(MatrixXd::Zero(size, size)), cosine(MatrixXd::Zero(size, size)), sine(MatrixXd::Zero(size, size))
        {
        }
        MatrixXd at(double phase) const { return even + std::cos(phase) * cosine + std::sin(phase) * sine; }
    };
    std::vector<Part> diagonal, coupling; ///< of a column with itself, with the one before
    Index first, count;                   ///< columns that are loaded, at the surface along the radius
};

RingStiffness assembled(const LayerMesh& mesh)
{
    const Index levels = mesh.depth.size() - 1, columns = mesh.across.size();
    const std::vector<RingStiffness::Part> none(static_cast<std::size_t>(columns), RingStiffness::Part(3 * levels));
    RingStiffness ring{none, none, mesh.first, mesh.count};
    for (Index column = 0; column + 1 < columns; ++column)
        for (Index level = 0; level < levels; ++level) {
            const WaveElement element = wave_element(mesh, column, level);
            const Index held = level + 1 < levels ? 4 : 2; // nodes that can move
            for (Index b = 0; b < held; ++b)
                for (Index a = 0; a < held; ++a) {
                    if (a % 2 < b % 2) continue; // by symmetry
                    const auto at = static_cast<std::size_t>(column + a % 2);
                    RingStiffness::Part& part = (a % 2 == b % 2 ? ring.diagonal : ring.coupling)[at];
                    const Index row = 3 * (level + a / 2), other = 3 * (level + b / 2);
                    part.even.block<3, 3>(row, other) += element.even.block<3, 3>(3 * a, 3 * b);
                    part.cosine.block<3, 3>(row, other) += element.cosine.block<3, 3>(3 * a, 3 * b);
                    part.sine.block<3, 3>(row, other) += element.sine.block<3, 3>(3 * a, 3 * b);
                }
        }
    return ring;
}

/// A = L Lᵀ, column by column; the compliance of the loaded nodes is GᵀG with L G = their unit forces.
MatrixXd compliance(const RingStiffness& ring, double phase)
{
    const Index size = ring.diagonal.front().even.rows();
    MatrixXd result = MatrixXd::Zero(ring.count, ring.count), solved = MatrixXd::Zero(size, ring.count);
    Eigen::LLT<MatrixXd> cholesky;
    for (std::size_t at = 0; at < ring.diagonal.size(); ++at) {
        const auto column = static_cast<Index>(at);
        const Index loaded = std::clamp<Index>(column + 1 - ring.first, 0, ring.count);
        MatrixXd diagonal = ring.diagonal[at].at(phase), forces = MatrixXd::Zero(size, loaded);
        if (column > 0) {
            const MatrixXd before = cholesky.matrixL().solve(ring.coupling[at].at(phase).transpose());
            diagonal.noalias() -= before.transpose() * before;
            forces.noalias() -= before.transpose() * solved.leftCols(loaded);
        }
        if (column >= ring.first && column < ring.first + ring.count) forces(0, loaded - 1) += 1;
        cholesky.compute(diagonal);
        if (loaded == 0) continue; // Eigen does not solve for nothing
        cholesky.matrixL().solveInPlace(forces);
        solved.leftCols(loaded) = forces;
        result.topLeftCorner(loaded, loaded).noalias() += forces.transpose() * forces;
    }
    return result;
}

/// Sizes from `first` on that grow to fill a length.
VectorXd growing(double first, double length)
{
    std::vector<double> sizes;
    double sum = 0;
    for (double size = first; sum < length; size *= kGrowth) {
        sizes.push_back(size);
        sum += size;
    }
    return VectorXd::Map(sizes.data(), static_cast<Index>(sizes.size())) * (length / sum);
}

/// Depths of nodes: even ones, or as thin as the cells at the surface.
VectorXd depths(double thickness, double cell, Index elements)
{
    const auto count = static_cast<double>(elements);
    const double first = std::min(thickness / count, cell);
    double low = 1, high = 1e3; // the ratio from element to element
    for (int i = 0; i < 60; ++i) {
        const double ratio = (low + high) / 2;
        const double sum = first * (ratio > 1 ? (std::pow(ratio, count) - 1) / (ratio - 1) : count);
        (sum < thickness ? low : high) = ratio;
    }
    VectorXd result = VectorXd::Zero(elements + 1);
    double size = first;
    for (Index i = 1; i <= elements; ++i, size *= low) result[i] = result[i - 1] + size;
    return result * (thickness / result[elements]);
}

/// Phases from 0 to π with weights: the mean over them is that over a half wave.
std::vector<std::pair<double, double>> phases(const LayerMesh& mesh, Index rows)
{
    using Gauss = boost::math::quadrature::gauss<double, 10>;
    constexpr double kPerPanel = 12; // rad of the fastest cosine: ten nodes integrate it to 1e-8
    const double widest = kPerPanel / static_cast<double>(rows);
    std::vector<std::pair<double, double>> result;
    // What the hub holds back changes over wave numbers of 1/h: from there on, panels as wide as they are far.
    double width = std::min(mesh.cell.x() / mesh.layer.thickness, widest);
    for (double from = 0; from < pi; from += width, width = std::min(from, widest)) {
        const double half = std::min(width, pi - from) / 2;
        for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k)
            for (const double sign : {-1.0, 1.0})
                result.emplace_back(from + half * (1 + sign * Gauss::abscissa()[k]), half * Gauss::weights()[k] / pi);
    }
    return result;
}

/// How much of the compliance at each phase (rows) goes to each wave (columns) of the window, repeated at twice its
/// length with what its cells do to each other unchanged: as many waves as cells, and one.
MatrixXd shares(const std::vector<std::pair<double, double>>& nodes, Index rows)
{
    MatrixXd result(static_cast<Index>(nodes.size()), rows + 1);
    for (Index f = 0; f <= rows; ++f)
        for (Index k = 0; k < result.rows(); ++k) {
            const auto [phase, weight] = nodes[static_cast<std::size_t>(k)];
            const double wave = pi * static_cast<double>(f) / static_cast<double>(rows);
            double sum = 1;
            for (Index m = 1; m < rows; ++m)
                sum += 2 * std::cos(static_cast<double>(m) * phase) * std::cos(static_cast<double>(m) * wave);
            result(k, f) = weight * sum * (f == 0 || f == rows ? 1 : 2) / static_cast<double>(2 * rows);
        }
    return result;
}

} // namespace

LayerMesh mesh_of(const ElasticLayer& layer, double radius, double width, const Eigen::Vector2d& cell, Index columns,
                  Index elements)
{
    if (!(layer.thickness < radius)) throw InputError("finite elements", "the layer leaves no hub");
    const double last = static_cast<double>(columns - 1) / 2 * cell.y(), beside = width / 2 - last;
    if (!(beside > 0)) throw InputError("finite elements", "cells lie beyond the layer's width");
    // Elements that cannot change their volume at all have no stiffness to eliminate by; from here on digits would go.
    constexpr double kMostPoisson = 0.5 - 1e-7;
    LayerMesh mesh{layer, radius, cell, depths(layer.thickness, cell.minCoeff(), elements), {}, 0, columns};
    mesh.layer.poisson = std::min(layer.poisson, kMostPoisson);
    const VectorXd sizes = growing(cell.y(), beside);
    mesh.first = sizes.size();
    mesh.across.resize(columns + 2 * sizes.size());
    for (Index i = 0; i < columns; ++i) mesh.across[mesh.first + i] = static_cast<double>(i) * cell.y() - last;
    for (Index i = 0; i < sizes.size(); ++i) {
        mesh.across[mesh.first + columns + i] = mesh.across[mesh.first + columns + i - 1] + sizes[i];
        mesh.across[mesh.first - 1 - i] = mesh.across[mesh.first - i] - sizes[i];
    }
    return mesh;
}

MatrixXd wave_compliance(const LayerMesh& mesh, double phase) { return compliance(assembled(mesh), phase); }

FemLayer::FemLayer(const LayerMesh& mesh, Index rows) : upright_(rows), waves_(2 * (rows + 1), rows)
{
    for (Index i = 0; i < rows; ++i)
        upright_[i] = std::cos((static_cast<double>(2 * i + 1 - rows) / 2) * mesh.cell.x() / mesh.radius);
    for (Index f = 0; f <= rows; ++f)
        for (Index i = 0; i < rows; ++i) {
            waves_(2 * f, i) = std::cos(pi * static_cast<double>(f * i) / static_cast<double>(rows));
            waves_(2 * f + 1, i) = std::sin(pi * static_cast<double>(f * i) / static_cast<double>(rows));
        }
    const std::vector<std::pair<double, double>> nodes = phases(mesh, rows);
    const auto count = static_cast<Index>(nodes.size());
    const MatrixXd share = shares(nodes, rows);
    const RingStiffness ring = assembled(mesh);
    constexpr Index kAtOnce = 64; // of matrices: all of them may be more than fits
    spectrum_ = MatrixXd::Zero(mesh.count * mesh.count, rows + 1);
    for (Index from = 0; from < count; from += kAtOnce) {
        MatrixXd compliances(spectrum_.rows(), std::min(kAtOnce, count - from));
        tbb::parallel_for(Index{0}, compliances.cols(), [&](Index k) {
            const double phase = nodes[static_cast<std::size_t>(from + k)].first;
            compliances.col(k) = mesh.cell.prod() * compliance(ring, phase).reshaped();
        });
        tbb::parallel_for(Index{0}, mesh.count, [&](Index column) { // of the compliances
            spectrum_.middleRows(column * mesh.count, mesh.count).noalias() +=
                compliances.middleRows(column * mesh.count, mesh.count) * share.middleRows(from, compliances.cols());
        });
    }
}

MatrixXd FemLayer::displacement(const MatrixXd& pressure) const
{
    const Index columns = pressure.cols();
    MatrixXd amplitudes = (waves_ * pressure).transpose();
    for (Index f = 0; f < spectrum_.cols(); ++f) {
        const Eigen::Map<const MatrixXd> give(spectrum_.col(f).data(), columns, columns);
        amplitudes.middleCols(2 * f, 2) = (give * amplitudes.middleCols(2 * f, 2)).eval();
    }
    return waves_.transpose() * amplitudes.transpose();
}

} // namespace fettle
