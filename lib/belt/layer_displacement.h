#pragma once

#include "belt/convolution.h"
#include "belt/edge_compliance.h"
#include "belt/fem_layer.h"
#include "belt/layer_compliance.h"

#include <Eigen/Core>

#include <map>
#include <optional>
#include <utility>

namespace fettle::belt {

/// Displacement of a layer's surface under a pressure on a grid of cells along x (rows) and y (columns): of a flat
/// layer by its influence coefficients, of one with the free sides of a wheel wave by wave, or of finite elements. Not
/// thread-safe.
class LayerDisplacement {
  public:
    /// @throws InputError as influence_coefficients() does
    LayerDisplacement(const ElasticLayer& layer, const Eigen::Vector2d& cell, Eigen::Index rows, Eigen::Index columns);
    /// The grid is in the middle of the wheel's width.
    LayerDisplacement(const ElasticLayer& layer, const EdgeCompliance& edges, const Eigen::Vector2d& cell,
                      Eigen::Index rows, Eigen::Index columns);
    LayerDisplacement(const LayerMesh& mesh, Eigen::Index rows);

    /// Along the radius at the middle, onto which the finite elements' pressure and displacement are projected from
    /// each row's own.
    /// @param pressure  on the whole grid, or on a window of it outside which the pressure is 0: of finite elements
    /// there is none, and beside free sides it is as wide on either side of the middle
    Eigen::MatrixXd of_window(const Eigen::MatrixXd& pressure);
    /// Along each row's radius, under a pressure along it.
    Eigen::MatrixXd radial(const Eigen::MatrixXd& pressure);

    const ElasticLayer& layer() const { return layer_; }
    double cell_area() const { return cell_area_; } ///< mm²
    /// Influence of a cell's pressure at the cell that it lifts most, mm/MPa: < 0 where rubber bulges.
    double min_influence() const { return min_influence_; }
    /// Of the flat layer, without free sides: of a cell on others so many rows and columns away, mm/MPa; none of finite
    /// elements.
    const Eigen::MatrixXd& influence() const { return influence_; }
    bool has_sides() const { return side_influence_.size() > 0; }
    /// Finite elements of a round layer; null: the layer is flat.
    const FemLayer* fem() const { return fem_ ? &*fem_ : nullptr; }

  private:
    WaveOperator window_waves(Eigen::Index rows, Eigen::Index columns) const;

    ElasticLayer layer_;
    double cell_area_;
    Eigen::MatrixXd influence_;
    double min_influence_;
    Eigen::MatrixXd side_influence_; ///< with the wheel's sides, of each column on each (row), rows away (column)
    using Size = std::pair<Eigen::Index, Eigen::Index>;
    std::map<Size, WaveOperator> waves_;       ///< by the size of the window
    std::map<Size, Convolution> convolutions_; ///< the same, of large ones without sides
    std::optional<FemLayer> fem_;              ///< replaces the influence coefficients
};

} // namespace fettle::belt
