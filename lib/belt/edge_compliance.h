#pragma once

#include "belt/fem_layer.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::belt {

/// How much softer a wheel's layer is for its free sides than a layer without any. Beside a side nothing holds the
/// rubber back, and where it is nearly incompressible it yields sideways there many times as far as in the middle.
///
/// It is the difference of two finite-element layers that are alike under the load: one ends at the wheel's sides, the
/// other goes on beyond them. Each load's own dent cancels in the difference, so that it varies slowly but for a corner
/// of the layer, and a coarse graded mesh and few waves along the arc will do for all grids of the wheel. The larger
/// body is the stiffer one: the difference is a positive semidefinite compliance, and stays one when it is
/// interpolated.
class EdgeCompliance {
  public:
    /// Takes a fraction of a second.
    EdgeCompliance(const ElasticLayer& layer, double radius, double width);

    /// Adds the compliance to that of each wave of a grid (wave_operator.h) in the middle of the width.
    void add_to(Eigen::MatrixXd& spectrum, const Eigen::Vector2d& cell, Eigen::Index rows, Eigen::Index columns) const;

  private:
    double element_;                   ///< length along the arc, mm
    Eigen::VectorXd positions_;        ///< of the nodes along the axis, from the middle of the width, mm
    std::vector<double> wave_numbers_; ///< from 0, ascending, 1/mm
    std::vector<Eigen::MatrixXd>
        compliances_; ///< of each wave number: radial displacement under 1 N for each element, mm
};

} // namespace fettle::belt
