#include "belt/layer_displacement.h"

#include <algorithm>

namespace fettle::belt {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// Larger windows are convolved by Fourier transforms, of which the time grows with less than the cube of the side.
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
    waves_.emplace(rows, columns, spectrum);
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
    if (waves_) return waves_->displacement(pressure);
    const Size size(pressure.rows(), pressure.cols());
    const auto influence = influence_.topLeftCorner(size.first, size.second);
    if (std::max(size.first, size.second) > kMaxWaveCells) {
        MatrixXd displacement;
        convolutions_.try_emplace(size, influence).first->second(pressure, displacement);
        return displacement;
    }
    const auto found = flat_waves_.find(size);
    if (found != flat_waves_.end()) return found->second.displacement(pressure);
    return flat_waves_.try_emplace(size, size.first, size.second, flat_spectrum(influence))
        .first->second.displacement(pressure);
}

MatrixXd LayerDisplacement::radial(const MatrixXd& pressure)
{
    return fem_ ? fem_->displacement(pressure) : of_window(pressure);
}

} // namespace fettle::belt
