#pragma once

#include "belt/belt_law.h"
#include "belt/layer_displacement.h"

#include <Eigen/Core>

namespace fettle::belt {

/// Contact of a wheel and a workpiece on a grid of cells along x (rows) and y (columns).
struct Contact {
    Eigen::MatrixXd pressure; ///< MPa, ≥ 0
    double indentation = 0;   ///< displacement of the hub from its position in the given gap, mm
    double force = 0;         ///< N
    int iterations = 0;
    bool converged = false;
};

/// Frictionless unilateral contact (Signorini) of a layer with a workpiece: pressure ≥ 0, gap ≥ 0, pressure · gap = 0.
/// Solved by constrained conjugate gradients (after Polonsky and Keer 1999), preconditioned (contact_preconditioner.h).
/// A step costs the displacement under one pressure, on a window just larger than the contact. Not thread-safe.
///
/// While a belt grinds, the workpiece recedes by what the pressure removes. Taking the pressure at the end of the step
/// for a depth r(p) of it adds that depth to the gap: g = gap + K p + r(p) - indentation. With r all of the step's
/// removal (the implicit Euler method) a ripple of the workpiece whose pressure the layer resists with the compliance C
/// shrinks by C / (C + r'(p)) in each step, whatever the step's length; with the pressure at the beginning (explicit)
/// it would change by 1 - r'(p) / C, and grow where r' > 2 C: short waves, for which rubber is stiffest. A share of the
/// removal (press.cc, implicit_share()) shrinks it as the exact exponential does.
class LayerContact {
  public:
    /// Uses the compliance of a flat layer without edges.
    /// @param cell  size, mm
    /// @throws InputError as influence() does
    LayerContact(const ElasticLayer& layer, const Eigen::Vector2d& cell, Eigen::Index rows, Eigen::Index columns)
        : surface_(layer, cell, rows, columns)
    {
    }
    /// Takes the free sides of a wheel into account; the grid is in the middle of its width.
    LayerContact(const ElasticLayer& layer, const EdgeCompliance& edges, const Eigen::Vector2d& cell, Eigen::Index rows,
                 Eigen::Index columns)
        : surface_(layer, edges, cell, rows, columns)
    {
    }
    /// Uses finite elements. Rows lie along the wheel's arc with the lowest point in the middle. Pressure and gap are
    /// radial; force and indentation are along the radius at the middle.
    LayerContact(const LayerMesh& mesh, Eigen::Index rows) : surface_(mesh, rows) {}

    /// Solves for a given indentation, until pressure · gap ≤ `tolerance` · peak pressure · approach and all gaps
    /// ≥ -tolerance · approach. The approach is the displacement of the hub since first touch.
    /// @param gap  before deformation with the hub at indentation 0, mm; infinite where there is no workpiece
    /// @param start  initial pressure, such as that of the previous contact point; empty: none
    /// @param removal  by a belt during the contact
    /// @param coverage  share of each cell's area over the workpiece, > 0 where the gap is finite; empty: all of it.
    /// Pressures are means of the whole cells; what lies over the workpiece carries them.
    Contact solve_by_indentation(const Eigen::MatrixXd& gap, double indentation, double tolerance,
                                 const Eigen::MatrixXd& start = {}, const RemovalStep& removal = {},
                                 const Eigen::MatrixXd& coverage = {});
    /// Solves for a given force.
    /// @param force  N, > 0
    /// @throws InputError if no gap is finite
    Contact solve_by_force(const Eigen::MatrixXd& gap, double force, double tolerance,
                           const Eigen::MatrixXd& start = {}, const RemovalStep& removal = {},
                           const Eigen::MatrixXd& coverage = {});

    /// Gap after deformation, without removal, mm, ≥ 0; 0 in contact.
    Eigen::MatrixXd residual_gap(const Eigen::MatrixXd& gap, const Contact& contact,
                                 const Eigen::MatrixXd& coverage = {});

  private:
    struct Window;
    struct Workpiece;
    Contact solve(const Eigen::MatrixXd& gap, const Contact& given, double tolerance, const Eigen::MatrixXd& start,
                  const RemovalStep& removal, const Eigen::MatrixXd& coverage, bool is_force_known);
    bool iterate(const Eigen::MatrixXd& gap, const Window& window, double tolerance, const RemovalStep& removal,
                 const Eigen::MatrixXd& coverage, bool is_force_known, int max_iterations, Contact& contact);
    /// Gap that opens in each cell under its own pressure beside the layer's displacement, along the radius at the
    /// middle: what is removed, and how much deeper a narrow border of the workpiece goes into the layer.
    Eigen::ArrayXXd own_gap(const Workpiece& workpiece, const Eigen::ArrayXXd& pressure) const;
    /// Length of the step to the minimum of the energy along it. @param own  own_gap() of the pressure  @param slope of
    /// the energy, < 0  @param curvature  of its elastic part
    double step_length(const Eigen::ArrayXXd& pressure, const Eigen::ArrayXXd& own, const Eigen::MatrixXd& step,
                       const Workpiece& workpiece, double slope, double curvature) const;
    Eigen::ArrayXXd border_compliance(const Eigen::ArrayXXd& coverage) const;
    Eigen::MatrixXd initial_pressure(const Eigen::MatrixXd& gap, const Contact& given, bool is_force_known) const;
    /// Gap after deformation; negative where the surfaces interpenetrate.
    Eigen::MatrixXd signed_gap(const Eigen::MatrixXd& gap, const Contact& contact, const Eigen::MatrixXd& coverage);

    LayerDisplacement surface_;
};

} // namespace fettle::belt
