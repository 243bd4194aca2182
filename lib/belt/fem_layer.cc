#include "belt/fem_layer.h"

#include "belt/fem_element.h"
#include "core/cholesky.h"
#include "core/error.h"

#include <boost/math/quadrature/gauss.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace fettle::belt {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kElementGrowth = 1.3; // size ratio of neighbouring elements beside the loaded ones

/// A stiffness matrix as a function of the phase from element to element along the arc.
template <typename Matrix>
struct PhaseMatrix {
    Matrix even, cosine, sine;
    Matrix at(double phase) const { return even + std::cos(phase) * cosine + std::sin(phase) * sine; }
};

/// Stiffness of an element, in the directions radius, arc, axis of each node. The displacement along the arc lags the
/// others by a quarter wave, which keeps the matrices real.
using WaveElement = PhaseMatrix<Eigen::Matrix<double, 12, 12>>;

WaveElement wave_element(const LayerMesh& mesh, Index column, Index level)
{
    const double turn = mesh.cell_size.x() / mesh.radius;
    Hexahedron corners;
    HexahedronStiffness axes = HexahedronStiffness::Zero(); // of each corner: radius, arc, axis
    for (int corner = 0; corner < 8; ++corner) {
        const double angle = corner % 2 * turn, s = std::sin(angle), c = std::cos(angle);
        const double below = mesh.node_depths[level + corner / 4], r = mesh.radius - below;
        // Coordinates from the lowest point of the surface: no cancellation for a large radius.
        corners.col(corner) << r * s, mesh.node_positions[column + corner / 2 % 2],
            below * c + 2 * mesh.radius * std::pow(std::sin(angle / 2), 2);
        axes.block<3, 3>(3 * corner, 3 * corner) << s, c, 0, 0, 0, 1, -c, s, 0;
    }
    const HexahedronStiffness local = axes.transpose() * stiffness(corners, mesh.layer) * axes;
    Eigen::Matrix<double, 12, 12> here, next, coupling;
    for (int b = 0; b < 12; ++b)
        for (int a = 0; a < 12; ++a) {
            const int i = a / 3 * 6 + a % 3, j = b / 3 * 6 + b % 3; // corners 0, 2, 4, 6; + 3: corners 1, 3, 5, 7
            here(a, b) = local(i, j);
            next(a, b) = local(i + 3, j + 3);
            coupling(a, b) = local(i, j + 3);
        }
    WaveElement element{here + next, coupling + coupling.transpose(), coupling.transpose() - coupling};
    // By mirror symmetry `even` and `cosine` do not couple the arc with radius and axis, and `sine` couples only these.
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

/// Stiffness of the layer at a phase, in blocks of node columns. A column goes from the surface to the hub, whose nodes
/// are fixed.
struct RingStiffness {
    std::vector<PhaseMatrix<MatrixXd>> diagonal, coupling; ///< of a column with itself, and with the previous one
    Index first, count;                                    ///< loaded columns: radially at the surface
};

RingStiffness assemble(const LayerMesh& mesh)
{
    const Index levels = mesh.node_depths.size() - 1, columns = mesh.node_positions.size();
    const MatrixXd zero = MatrixXd::Zero(3 * levels, 3 * levels);
    const std::vector<PhaseMatrix<MatrixXd>> zeros(columns, {zero, zero, zero});
    RingStiffness ring{zeros, zeros, mesh.first_loaded, mesh.loaded_count};
    for (Index column = 0; column + 1 < columns; ++column)
        for (Index level = 0; level < levels; ++level) {
            const WaveElement element = wave_element(mesh, column, level);
            const Index free_nodes = level + 1 < levels ? 4 : 2; // of the element's four per side
            for (Index b = 0; b < free_nodes; ++b)
                for (Index a = 0; a < free_nodes; ++a) {
                    if (a % 2 < b % 2) continue; // by symmetry
                    PhaseMatrix<MatrixXd>& part = (a % 2 == b % 2 ? ring.diagonal : ring.coupling)[column + a % 2];
                    const Index row = 3 * (level + a / 2), other = 3 * (level + b / 2);
                    part.even.block<3, 3>(row, other) += element.even.block<3, 3>(3 * a, 3 * b);
                    part.cosine.block<3, 3>(row, other) += element.cosine.block<3, 3>(3 * a, 3 * b);
                    part.sine.block<3, 3>(row, other) += element.sine.block<3, 3>(3 * a, 3 * b);
                }
        }
    return ring;
}

/// Block Cholesky factorisation A = L Lᵀ, column by column. The compliance of the loaded nodes is GᵀG with L G = their
/// unit forces.
MatrixXd compliance(const RingStiffness& ring, double phase)
{
    const Index size = ring.diagonal.front().even.rows();
    MatrixXd result = MatrixXd::Zero(ring.count, ring.count), solved = MatrixXd::Zero(size, ring.count);
    std::optional<core::Cholesky> cholesky;
    for (Index column = 0; column < std::ssize(ring.diagonal); ++column) {
        const Index loaded = std::clamp<Index>(column + 1 - ring.first, 0, ring.count);
        MatrixXd diagonal = ring.diagonal[column].at(phase), forces = MatrixXd::Zero(size, loaded);
        if (column > 0) {
            const MatrixXd before = cholesky->solve_lower(ring.coupling[column].at(phase).transpose());
            diagonal.noalias() -= before.transpose() * before;
            forces.noalias() -= before.transpose() * solved.leftCols(loaded);
        }
        if (column >= ring.first && column < ring.first + ring.count) forces(0, loaded - 1) += 1;
        cholesky.emplace(diagonal);
        if (loaded == 0) continue; // Eigen cannot solve with zero columns
        forces = cholesky->solve_lower(forces);
        solved.leftCols(loaded) = forces;
        result.topLeftCorner(loaded, loaded).noalias() += forces.transpose() * forces;
    }
    return result;
}

/// Element sizes that start at about `first` and grow to fill a length.
VectorXd growing_sizes(double first, double length)
{
    std::vector<double> sizes;
    double sum = 0;
    for (double size = first; sum < length; size *= kElementGrowth) {
        sizes.push_back(size);
        sum += size;
    }
    return VectorXd::Map(sizes.data(), std::ssize(sizes)) * (length / sum);
}

/// Depths of the nodes: equal elements, or graded ones if those would be thicker at the surface than a cell is long.
VectorXd node_depths(double thickness, double cell, Index elements)
{
    const auto count = static_cast<double>(elements);
    const double first = std::min(thickness / count, cell);
    double low = 1, high = 1e3; // bounds of the size ratio, bisected to full precision
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

/// Quadrature nodes (phases from 0 to π) and weights for the mean over a half wave.
std::vector<std::pair<double, double>> phase_quadrature(const LayerMesh& mesh, Index rows)
{
    using Gauss = boost::math::quadrature::gauss<double, 10>;
    constexpr double kRadPerPanel = 12; // of the fastest cosine, which ten nodes integrate to 1e-8
    const double max_width = kRadPerPanel / rows;
    std::vector<std::pair<double, double>> result;
    // The effect of the hub varies over wave numbers of about 1/h. Beyond that, panels grow in proportion to the phase.
    double width = std::min(mesh.cell_size.x() / mesh.layer.thickness, max_width);
    for (double from = 0; from < pi; from += width, width = std::min(from, max_width)) {
        const double half = std::min(width, pi - from) / 2;
        for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k)
            for (const double sign : {-1.0, 1.0})
                result.emplace_back(from + half * (1 + sign * Gauss::abscissa()[k]), half * Gauss::weights()[k] / pi);
    }
    return result;
}

} // namespace

LayerMesh layer_mesh(const ElasticLayer& layer, double radius, double width, const Eigen::Vector2d& cell, Index columns,
                     Index elements)
{
    if (!(layer.thickness < radius)) throw core::InputError("finite elements", "the layer is as thick as the radius");
    const double last = static_cast<double>(columns - 1) / 2 * cell.y(), margin = width / 2 - last;
    if (!(margin > 0)) throw core::InputError("finite elements", "cells lie outside the width of the layer");
    // Incompressible elements have an infinite bulk modulus. Closer to 0.5 the elimination would lose too many digits.
    constexpr double kMaxPoisson = 0.5 - 1e-7;
    LayerMesh mesh{layer, radius, cell, node_depths(layer.thickness, cell.minCoeff(), elements), {}, 0, columns};
    mesh.layer.poisson = std::min(layer.poisson, kMaxPoisson);
    const VectorXd sizes = growing_sizes(cell.y(), margin);
    mesh.first_loaded = sizes.size();
    mesh.node_positions.resize(columns + 2 * sizes.size());
    for (Index i = 0; i < columns; ++i) mesh.node_positions[mesh.first_loaded + i] = i * cell.y() - last;
    for (Index i = 0; i < sizes.size(); ++i) {
        mesh.node_positions[mesh.first_loaded + columns + i] =
            mesh.node_positions[mesh.first_loaded + columns + i - 1] + sizes[i];
        mesh.node_positions[mesh.first_loaded - 1 - i] = mesh.node_positions[mesh.first_loaded - i] - sizes[i];
    }
    return mesh;
}

MatrixXd wave_compliance(const LayerMesh& mesh, double phase) { return compliance(assemble(mesh), phase); }

FemLayer::FemLayer(const LayerMesh& mesh, Index rows) : tilt_cosines_(rows)
{
    for (Index i = 0; i < rows; ++i)
        tilt_cosines_[i] = std::cos((static_cast<double>(2 * i + 1 - rows) / 2) * mesh.cell_size.x() / mesh.radius);
    const std::vector<std::pair<double, double>> nodes = phase_quadrature(mesh, rows);
    const Index count = std::ssize(nodes);
    const MatrixXd weights = wave_weights(nodes, rows);
    const RingStiffness ring = assemble(mesh);
    constexpr Index kBlockSize = 64; // phases at a time, to limit the memory
    MatrixXd spectrum = MatrixXd::Zero(mesh.loaded_count * mesh.loaded_count, rows + 1);
    for (Index from = 0; from < count; from += kBlockSize) {
        MatrixXd compliances(spectrum.rows(), std::min(kBlockSize, count - from));
        tbb::parallel_for(Index{0}, compliances.cols(), [&](Index k) {
            const double phase = nodes[from + k].first;
            compliances.col(k) = mesh.cell_size.prod() * compliance(ring, phase).reshaped();
        });
        tbb::parallel_for(Index{0}, mesh.loaded_count, [&](Index column) {
            spectrum.middleRows(column * mesh.loaded_count, mesh.loaded_count).noalias() +=
                compliances.middleRows(column * mesh.loaded_count, mesh.loaded_count) *
                weights.middleRows(from, compliances.cols());
        });
    }
    waves_.emplace(rows, mesh.loaded_count, spectrum);
}

} // namespace fettle::belt
