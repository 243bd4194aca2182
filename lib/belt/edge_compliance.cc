#include "belt/edge_compliance.h"

#include <boost/math/quadrature/gauss.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::belt {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// All lengths in thicknesses. The elements grow from an edge to the middle, and from the surface to the hub.
constexpr double kFirstElement = 1.0 / 12, kGrowth = 1.4, kMaxElement = 0.4;
constexpr double kArcElement = 1.0 / 8;
/// Beyond it a layer does not feel that it ends.
constexpr double kFarThicknesses = 4;
/// Times the thickness: the difference varies slowly with the wave number, and of short waves only the corner is left.
constexpr double kWaveNumbers[] = {0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2,  2.25, 2.5, 2.75,
                                   3, 3.5,  4,   4.5,  5, 6,    7,   8,    10, 12,   16};

/// Sizes that grow from kFirstElement to kMaxElement and fill a length, in thicknesses.
std::vector<double> graded_sizes(double length)
{
    std::vector<double> sizes;
    double sum = 0;
    for (double size = kFirstElement; sum < length; size = std::min(size * kGrowth, kMaxElement)) {
        sizes.push_back(size);
        sum += size;
    }
    for (double& size : sizes) size *= length / sum;
    return sizes;
}

VectorXd cumulative(const std::vector<double>& sizes, double from)
{
    VectorXd result(std::ssize(sizes) + 1);
    result[0] = from;
    for (Index k = 0; k + 1 < result.size(); ++k) result[k + 1] = result[k] + sizes[k];
    return result;
}

/// The layer over the wheel's width, loaded at all its nodes. @param margin  of layer beyond each side, mm
LayerMesh edge_mesh(const ElasticLayer& layer, double radius, double width, double margin)
{
    constexpr double kMaxPoisson = 0.5 - 1e-7; // as layer_mesh
    const double h = layer.thickness;
    LayerMesh mesh{layer, radius, {kArcElement * h, kFirstElement * h}, h * cumulative(graded_sizes(1), 0), {}, 0, 0};
    mesh.layer.poisson = std::min(layer.poisson, kMaxPoisson);
    const std::vector<double> half = graded_sizes(width / 2 / h);
    std::vector<double> sizes(half.begin(), half.end());
    sizes.insert(sizes.end(), half.rbegin(), half.rend());
    mesh.loaded_count = std::ssize(sizes) + 1;
    if (margin > 0) {
        const std::vector<double> beyond = graded_sizes(margin / h);
        mesh.first_loaded = std::ssize(beyond);
        sizes.insert(sizes.begin(), beyond.rbegin(), beyond.rend());
        sizes.insert(sizes.end(), beyond.begin(), beyond.end());
    }
    mesh.node_positions = h * cumulative(sizes, -(width / 2 + margin) / h);
    return mesh;
}

/// Linear interpolation from nodes to places.
MatrixXd interpolation(const VectorXd& nodes, const VectorXd& places)
{
    MatrixXd result = MatrixXd::Zero(places.size(), nodes.size());
    for (Index i = 0; i < places.size(); ++i) {
        const Index above = std::upper_bound(nodes.begin(), nodes.end() - 1, places[i]) - nodes.begin();
        const Index k = std::max<Index>(above - 1, 0);
        const double share = (places[i] - nodes[k]) / (nodes[k + 1] - nodes[k]);
        result(i, k) = 1 - share;
        result(i, k + 1) = share;
    }
    return result;
}

} // namespace

EdgeCompliance::EdgeCompliance(const ElasticLayer& layer, double radius, double width)
    : element_(kArcElement * layer.thickness)
{
    const LayerMesh free = edge_mesh(layer, radius, width, 0);
    const LayerMesh wide = edge_mesh(layer, radius, width, kFarThicknesses * layer.thickness);
    positions_ = free.node_positions;
    for (const double number : kWaveNumbers) wave_numbers_.push_back(number / layer.thickness);
    compliances_.resize(wave_numbers_.size());
    tbb::parallel_for(std::size_t{0}, compliances_.size(), [&](std::size_t k) {
        const double phase = wave_numbers_[k] * element_;
        compliances_[k] = wave_compliance(free, phase) - wave_compliance(wide, phase);
    });
}

void EdgeCompliance::add_to(MatrixXd& spectrum, const Eigen::Vector2d& cell, Index rows, Index columns) const
{
    // Between two wave numbers the compliance is interpolated linearly; Gauss quadrature over each interval, in panels
    // of at most so many radians of the fastest cosine.
    using Gauss = boost::math::quadrature::gauss<double, 10>;
    constexpr double kRadPerPanel = 12;
    MatrixXd weights = MatrixXd::Zero(std::ssize(compliances_), rows + 1);
    for (std::size_t k = 0; k + 1 < wave_numbers_.size(); ++k) {
        const double from = wave_numbers_[k] * cell.x(), length = wave_numbers_[k + 1] * cell.x() - from;
        const int panels = std::max(1, static_cast<int>(std::ceil(length * double(rows) / kRadPerPanel)));
        const double half = length / panels / 2;
        std::vector<std::pair<double, double>> low, high;
        for (int panel = 0; panel < panels; ++panel)
            for (std::size_t n = 0; n < Gauss::abscissa().size(); ++n)
                for (const double sign : {-1.0, 1.0}) {
                    const double phase = from + half * (2 * panel + 1 + sign * Gauss::abscissa()[n]);
                    const double weight = half * Gauss::weights()[n] / std::numbers::pi,
                                 share = (phase - from) / length;
                    low.emplace_back(phase, weight * (1 - share));
                    high.emplace_back(phase, weight * share);
                }
        weights.row(Index(k)) += wave_weights(low, rows).colwise().sum();
        weights.row(Index(k) + 1) += wave_weights(high, rows).colwise().sum();
    }
    VectorXd centers(columns);
    for (Index j = 0; j < columns; ++j) centers[j] = (double(j) - double(columns - 1) / 2) * cell.y();
    const MatrixXd B = interpolation(positions_, centers);
    MatrixXd compliances(columns * columns, std::ssize(compliances_));
    for (Index k = 0; k < compliances.cols(); ++k)
        compliances.col(k) = MatrixXd(B * compliances_[k] * B.transpose()).reshaped();
    spectrum.noalias() += element_ * cell.y() * compliances * weights;
}

} // namespace fettle::belt
