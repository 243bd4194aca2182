#pragma once

#include "belt/layer_compliance.h"

#include <Eigen/Core>

namespace fettle {

/// Hexahedra of a layer bonded to a hub: rings of equal elements about the wheel's axis, side by side along the axis
/// and on top of each other. Its sides are free. The arc is a straight chord in each element; the ring goes on without
/// end, as a wound tape that does not touch itself does, so that nothing comes back from around the wheel.
struct LayerMesh {
    ElasticLayer layer;
    double radius = 0;      ///< of the layer's surface, mm
    Eigen::Vector2d cell;   ///< sides of the cells about the loaded nodes, mm: the arc of an element; along the axis
    Eigen::VectorXd depth;  ///< of the nodes below the surface, mm: 0 … the layer's thickness, rising
    Eigen::VectorXd across; ///< of the nodes along the axis from the middle of the width, mm: rising, from side to side
    Eigen::Index first = 0, count = 0; ///< the nodes across that are loaded
};

/// A mesh with nodes under the middles of a contact's cells, elements that grow beside them and towards the hub.
/// @param cell  sides along the surface's arc and the axis, mm
/// @param columns  of cells, the middle ones of the width
/// @param elements  from the surface to the hub
/// @throws InputError for cells beyond the width or a layer as thick as the radius
LayerMesh mesh_of(const ElasticLayer& layer, double radius, double width, const Eigen::Vector2d& cell,
                  Eigen::Index columns, Eigen::Index elements);

/// How far the surface goes in at the nodes across (rows), mm, under 1 N in at each node (columns) of one, times the
/// cosine of a wave that goes on by `phase` from element to element along the arc. The finite elements' answer without
/// further approximation: what is the same from element to element is solved for wave by wave (Bloch), across and
/// through the depth by elimination.
Eigen::MatrixXd wave_compliance(const LayerMesh& mesh, double phase);

/// How the finite elements' surface gives way, on a window of cells whose middles are nodes.
class FemLayer {
  public:
    FemLayer(const LayerMesh& mesh, Eigen::Index rows);

    /// @param pressure  along the radius, on the cells of the surface, MPa  @return  along the radius, mm
    Eigen::MatrixXd displacement(const Eigen::MatrixXd& pressure) const;
    /// Cosine of the angle between each row's radius and the middle's.
    const Eigen::ArrayXd& upright() const { return upright_; }

  private:
    Eigen::ArrayXd upright_;
    Eigen::MatrixXd waves_;    ///< cosine and sine of each wave along the window (rows in turn)
    Eigen::MatrixXd spectrum_; ///< mm/MPa, a column for each wave
};

} // namespace fettle
