#pragma once

#include "belt/convolution.h"
#include "belt/fem_layer.h"
#include "belt/layer_compliance.h"

#include <Eigen/Core>

#include <map>
#include <optional>
#include <utility>

namespace fettle {

/// How a wheel and a workpiece touch: cells along x (rows) and y (columns).
struct Contact {
    Eigen::MatrixXd pressure; ///< MPa, ≥ 0
    double indentation = 0;   ///< of the hub, mm: 0 where the gap before deformation was given
    double force = 0;         ///< N
    int iterations = 0;
    bool converged = false;
};

/// Unilateral contact without friction (Signorini) of a layer with what lies under it: pressure ≥ 0, gap ≥ 0, pressure
/// · gap = 0, by constrained conjugate gradients (after Polonsky and Keer 1999). A step is one convolution of the
/// pressure with the layer's influence, over no more cells than touch. One thread at a time.
class LayerContact {
  public:
    /// @param cell  sides, mm
    /// @throws InputError as influence() does
    LayerContact(const ElasticLayer& layer, const Eigen::Vector2d& cell, Eigen::Index rows, Eigen::Index columns);
    /// As the layer's finite elements give way. Rows of cells lie along the wheel's arc, their middles its lowest
    /// points; pressure and gap are along its radius, force and indentation along the middle's.
    LayerContact(const LayerMesh& mesh, Eigen::Index rows);

    /// Until pressure · gap is below `tolerance` · peak pressure · approach, and no gap below -tolerance · approach,
    /// the way of the hub since it first touched.
    /// @param gap  before deformation, the hub at indentation 0, mm; infinite where there is nothing to touch
    /// @param start  pressure to begin with, such as that of the contact point before; empty: none is known
    Contact by_depth(const Eigen::MatrixXd& gap, double indentation, double tolerance,
                     const Eigen::MatrixXd& start = {});
    /// @param force  N, > 0
    /// @throws InputError if no gap is finite
    Contact by_force(const Eigen::MatrixXd& gap, double force, double tolerance, const Eigen::MatrixXd& start = {});

    /// What is left of a gap, mm, ≥ 0; 0 where they touch.
    Eigen::MatrixXd gap_left(const Eigen::MatrixXd& gap, const Contact& contact);

  private:
    struct Window;
    Contact solve(const Eigen::MatrixXd& gap, const Contact& wanted, double tolerance, const Eigen::MatrixXd& start,
                  bool is_force_known);
    bool iterate(const Eigen::MatrixXd& gap, const Window& window, double tolerance, bool is_force_known,
                 int most_iterations, Contact& contact);
    Eigen::MatrixXd guess(const Eigen::MatrixXd& gap, const Contact& wanted, bool is_force_known) const;
    /// Negative where they cross.
    Eigen::MatrixXd left(const Eigen::MatrixXd& gap, const Contact& contact);
    Convolution& convolution(Eigen::Index rows, Eigen::Index columns);
    void give(const Eigen::MatrixXd& pressure, Eigen::MatrixXd& displacement);

    ElasticLayer layer_;
    double cell_area_; ///< mm²
    Eigen::MatrixXd influence_;
    double least_influence_; ///< < 0 where rubber bulges beside the contact
    std::map<std::pair<Eigen::Index, Eigen::Index>, Convolution> convolutions_; ///< by size
    std::optional<FemLayer> fem_;                                               ///< in place of the influence
};

} // namespace fettle
