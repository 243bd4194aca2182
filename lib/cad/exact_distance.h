#pragma once

#include "cad/design.h"
#include "cad/triangulation.h"
#include "core/progress.h"

#include <Eigen/Core>

#include <memory>

namespace fettle::cad {

/// Signed distances of points from the surfaces of a design. Where a point is not finite, all are NaN and the face -1.
struct ExactDistances {
    Eigen::VectorXd error;   ///< + outside the material, - inside, mm
    Eigen::Matrix3Xd foot;   ///< closest point of the design, mm
    Eigen::Matrix3Xd normal; ///< outward unit normal there; on an edge or vertex the angle-weighted sum of its faces'
    Eigen::VectorXi face;    ///< index of Design::faces(); on an edge the first of its faces
};

/// Distances from the surfaces and edges themselves, not from the triangles; those bound the search. A triangle within
/// the deviation of its face, and no farther from a point than the closest point so far and that deviation, may hold a
/// closer one: from each such triangle and chord Newton's method finds the foot on the surface or curve (foot.h). A
/// foot outside the borders of its face does not count: the closest point is then on an edge, or in another face.
/// OpenCASCADE evaluates surfaces and curves; of its own searches none is used. Thread-safe.
class ExactDistance {
  public:
    /// @param design  triangulated; must outlive this
    ExactDistance(const Design& design, const Triangulation& triangulation);
    ~ExactDistance();

    /// @param points  3xN, mm
    ExactDistances operator()(const Eigen::Matrix3Xd& points, const core::Progress& progress = {}) const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

} // namespace fettle::cad
