#pragma once

#include "belt/layer_compliance.h"
#include "belt/wave_operator.h"

#include <Eigen/Core>

#include <optional>

namespace fettle::belt {

/// Hexahedral mesh of a layer bonded to a hub: equal elements along the arc, graded ones along the axis and through the
/// thickness. The sides are free. The arc is a chord in each element. It continues without end, like a coiled tape that
/// does not touch itself, so that no displacement returns around the wheel.
struct LayerMesh {
    ElasticLayer layer;
    double radius = 0;              ///< of the layer's surface, mm
    Eigen::Vector2d cell_size;      ///< size of an element at the loaded nodes, mm: along the arc, along the axis
    Eigen::VectorXd node_depths;    ///< of the nodes below the surface, mm: ascending from 0 to the thickness
    Eigen::VectorXd node_positions; ///< of the nodes along the axis from the middle of the width, mm: ascending
    Eigen::Index first_loaded = 0, loaded_count = 0; ///< range of the loaded nodes in `across`
};

/// A mesh with nodes at the centres of a contact grid's cells, and elements that grow beside them and towards the hub.
/// @param cell  size along the arc and the axis, mm
/// @param columns  of cells, centred on the width
/// @param elements  number through the thickness
/// @throws InputError for cells beyond the width or a layer as thick as the radius
LayerMesh layer_mesh(const ElasticLayer& layer, double radius, double width, const Eigen::Vector2d& cell,
                     Eigen::Index columns, Eigen::Index elements);

/// Compliance of the surface for loads that vary as a cosine along the arc, mm/N: radial displacement at the loaded
/// nodes (rows) under 1 N at one of them (columns), both times a cosine that advances by `phase` from element to
/// element. It is the exact finite-element solution: a Bloch wave along the periodic arc, elimination along the axis
/// and the depth.
Eigen::MatrixXd wave_compliance(const LayerMesh& mesh, double phase);

/// Surface displacement of the finite elements under pressure on a grid of cells whose centres are nodes.
class FemLayer {
  public:
    FemLayer(const LayerMesh& mesh, Eigen::Index rows);

    /// @param pressure  radial, on the cells, MPa   @return  radial, mm
    Eigen::MatrixXd displacement(const Eigen::MatrixXd& pressure) const { return waves_->displacement(pressure); }
    /// Cosine of the angle between each row's radius and the radius at the middle of the grid.
    const Eigen::ArrayXd& tilt_cosines() const { return tilt_cosines_; }

  private:
    Eigen::ArrayXd tilt_cosines_;
    std::optional<WaveOperator> waves_; ///< always there after construction
};

} // namespace fettle::belt
