#include "belt/layer_displacement.h"

#include <algorithm>

namespace fettle::belt {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// Larger windows without sides are convolved by Fourier transforms, of which the time grows with less than the cube of
/// the side.
constexpr Index kMaxWaveCells = 80;

/// Compliance of each wave along the rows (column) between each two columns, of a layer without sides.
MatrixXd flat_spectrum(const MatrixXd& influence)
{
    const Index columns = influence.cols();
    const MatrixXd transform = wave_transform(influence);
    MatrixXd spectrum(columns * columns, transform.rows());
    for (Index f = 0; f < transform.rows(); ++f)
        for (Index j = 0; j < columns; ++j)
            for (Index i = 0; i < columns; ++i) spectrum(i + j * columns, f) = transform(f, std::abs(i - j));
    return spectrum;
}

} // namespace

LayerDisplacement::LayerDisplacement(const ElasticLayer& layer, const Eigen::Vector2d& cell, Index rows, Index columns)
    : layer_(layer), cell_area_(cell.prod()), influence_(influence_coefficients(layer, cell, rows, columns)),
      min_influence_(std::min(influence_.minCoeff(), 0.0))
{
}

LayerDisplacement::LayerDisplacement(const ElasticLayer& layer, const EdgeCompliance& edges,
                                     const Eigen::Vector2d& cell, Index rows, Index columns)
    : LayerDisplacement(layer, cell, rows, columns)
{
    MatrixXd spectrum = flat_spectrum(influence_);
    edges.add_to(spectrum, cell, rows, columns);
    side_influence_ = influence_of_waves(spectrum);
}

LayerDisplacement::LayerDisplacement(const LayerMesh& mesh, Index rows)
    : layer_(mesh.layer), cell_area_(mesh.cell_size.prod()), min_influence_(0), fem_(std::in_place, mesh, rows)
{
}

MatrixXd LayerDisplacement::of_window(const MatrixXd& pressure)
{
    if (fem_) {
        const auto cosines = fem_->tilt_cosines();
        const MatrixXd displacement = fem_->displacement((pressure.array().colwise() / cosines).matrix());
        return displacement.array().colwise() / cosines;
    }
    const Size size(pressure.rows(), pressure.cols());
    if (!has_sides() && std::max(size.first, size.second) > kMaxWaveCells) {
        MatrixXd displacement;
        const auto found = convolutions_.try_emplace(size, influence_.topLeftCorner(size.first, size.second)).first;
        found->second(pressure, displacement);
        return displacement;
    }
    auto found = waves_.find(size);
    if (found == waves_.end()) found = waves_.emplace(size, window_waves(size.first, size.second)).first;
    return found->second.displacement(pressure);
}

WaveOperator LayerDisplacement::window_waves(Index rows, Index columns) const
{
    if (!has_sides()) return {rows, columns, flat_spectrum(influence_.topLeftCorner(rows, columns))};
    const Index all = influence_.cols(), first = (all - columns) / 2;
    MatrixXd influence(rows, columns * columns);
    for (Index m = 0; m < rows; ++m) {
        const Eigen::Map<const MatrixXd> between(side_influence_.col(m).data(), all, all);
        influence.row(m) = MatrixXd(between.block(first, first, columns, columns)).reshaped().transpose();
    }
    return {rows, columns, wave_transform(influence).transpose()};
}

MatrixXd LayerDisplacement::radial(const MatrixXd& pressure)
{
    return fem_ ? fem_->displacement(pressure) : of_window(pressure);
}

} // namespace fettle::belt
