#pragma once

#include "belt/contact_wheel.h"
#include "belt/gridding.h"
#include "belt/layer_contact.h"
#include "belt/surfel_index.h"

#include <limits>
#include <optional>

namespace fettle::belt {

/// Model of the layer's compliance: a flat bonded layer (layer_compliance.h), beside the wheel's free sides with what
/// they add (edge_compliance.h), or finite elements of the round layer with its sides (fem_layer.h).
enum class LayerSolver { layer, fem };

struct WheelContactOptions {
    Gridding gridding = Gridding::kriging;
    Eigen::Index cells_per_side = 64; ///< along each side of the grid
    double tolerance = 1e-6;          ///< of the contact (layer_contact.h)
    LayerSolver solver = LayerSolver::layer;
    Eigen::Index elements = 8; ///< of LayerSolver::fem from the surface to the hub
};

/// Cells along each side up to which LayerSolver::layer sees the wheel's sides: memory grows with the cube, to 40 MB
/// here.
inline constexpr Eigen::Index kMaxEdgeCells = 128;

/// Load on the wheel: a force, or a depth of its lowest point below the contact point.
struct ContactLoad {
    bool by_force = true;
    double value = 0; ///< N or mm, > 0
};

/// Contact of the wheel at one pose, on a grid.
struct WheelContact {
    ContactGrid grid;
    /// Radius of the wheel's arc along which rows lie and from which heights are measured inwards, mm. Infinite: rows
    /// lie in the tangent plane through the contact point.
    double arc_radius = std::numeric_limits<double>::infinity();
    Eigen::MatrixXd height;   ///< of the workpiece, mm; NaN: no surfels
    Eigen::MatrixXd coverage; ///< share of each cell's area over the workpiece
    Contact contact;
    /// The contact is nearer than 1.5 thicknesses to the layer's free edge, where it is softer than elsewhere.
    bool is_near_edge = false;
    double area() const; ///< of the workpiece in contact, mm²
    /// Pressure on the workpiece, MPa: Contact::pressure is the mean over the cell, also where it sticks out.
    Eigen::MatrixXd workpiece_pressure() const;
};

/// State from which the next contact starts.
struct WheelContactState {
    ContactGrid grid;                   ///< no rows: the grid is not known yet
    Eigen::MatrixXd pressure, previous; ///< of the last contact and the one before it; empty: none
};

/// Presses a wheel on surfels at successive poses: +z out of the part, the wheel's axis along y. The grid is slightly
/// larger than the contact and grows when a contact reaches its border. Each contact starts from the linear
/// extrapolation of the last two.
class WheelContactSolver {
  public:
    /// Keeps references to the surfels, the wheel, and what the surfels lost so far, mm; null: unknown.
    WheelContactSolver(const Surfels& surfels, const ContactWheel& wheel, const WheelContactOptions& options,
                       const Eigen::VectorXd* removed = nullptr);

    /// Solves the contact at a pose.
    /// @param removal  by the belt during the contact
    /// @throws InputError if there is nothing under the wheel, or the contact does not converge
    const WheelContact& solve(const Eigen::Isometry3d& T_part_tool, const ContactLoad& load,
                              const RemovalStep& removal = {});
    /// Indices of the surfels from which the last grid was made.
    const std::vector<Eigen::Index>& surfels_in_grid() const { return surfels_in_grid_; }
    /// Their coordinates, 3xN, mm: as the cells, and the height.
    const Eigen::Matrix3Xd& surfel_coordinates() const { return surfel_coordinates_; }
    /// Largest distances of cells in contact from the contact point along x and y, to their far edges, mm.
    Eigen::Vector2d contact_extent() const;
    /// Gap between wheel and surfels after deformation, mm.
    Eigen::MatrixXd residual_gap();
    const ContactGrid& contact_grid() const { return contact_.grid; }
    /// Forgets the last contacts; the next one starts without them.
    void reset();
    WheelContactState state() const;
    /// Continues from a state: the next contact is bit for bit what it would have been then.
    void restore(const WheelContactState& state);

  private:
    void set_grid(const ContactGrid& grid, LayerSolver solver, bool sees_edges);
    void find_grid(const Eigen::Isometry3d& T_part_tool, const ContactLoad& load, const RemovalStep& removal);
    void solve_on_grid(const Eigen::Isometry3d& T_part_tool, const ContactLoad& load, Gridding gridding,
                       double tolerance, const RemovalStep& removal);
    bool is_at_border() const;
    Eigen::MatrixXd partial_coverage() const; ///< empty: there are no partly covered cells
    double implicit_share(const RemovalStep& removal) const;

    const Surfels& surfels_;
    const ContactWheel& wheel_;
    const Eigen::VectorXd* removed_;
    WheelContactOptions options_;
    SurfelIndex index_;
    double max_displacement_;             ///< absolute, of the surfels, mm
    std::optional<EdgeCompliance> edges_; ///< of LayerSolver::layer; none: no contact was near them yet
    std::optional<LayerContact> layer_;   ///< none: the grid is not known yet
    std::vector<Eigen::Index> surfels_in_grid_;
    Eigen::Matrix3Xd surfel_coordinates_;
    Eigen::MatrixXd gap_, previous_pressure_;
    WheelContact contact_;
};

/// Points of the workpiece at the cells with surfels, in the part frame, with fields pressure (MPa) and gap (mm).
cloud::Cloud to_cloud(const WheelContact& press, const Eigen::MatrixXd& gap_left, const Eigen::Isometry3d& T_part_tool);

} // namespace fettle::belt
