#pragma once

#include "belt/contact_wheel.h"
#include "belt/gridding.h"
#include "belt/layer_contact.h"
#include "belt/surfel_index.h"

#include <limits>
#include <optional>

namespace fettle {

/// How the layer gives way: as a bonded layer that is flat and has no edges (layer_compliance.h), or as finite elements
/// of the round one with its sides (fem_layer.h).
enum class LayerSolver { layer, fem };

/// How the contact is reckoned.
struct PressOptions {
    Gridding gridding = Gridding::kriging;
    Eigen::Index cells = 64; ///< along each side of the grid
    double tolerance = 1e-6; ///< of the contact (layer_contact.h)
    LayerSolver solver = LayerSolver::layer;
    Eigen::Index elements = 8; ///< from the surface to the hub: of finite elements
};

/// How the wheel is pressed on: with a force, or to a depth of its lowest point below the contact point.
struct Pressing {
    bool by_force = true;
    double amount = 0; ///< N or mm, > 0
};

/// A contact situation: what lies under the wheel, and how it is pressed.
struct Press {
    ContactCells cells;
    /// Of the wheel's arc that rows lie along, about its lowest point, and heights are measured from, inwards;
    /// infinite: that is the plane through the contact point.
    double arc_radius = std::numeric_limits<double>::infinity();
    Eigen::MatrixXd height; ///< mm; NaN: nothing is there
    Contact contact;
    /// Nearer than 1.5 thicknesses to the layer's free edge, where it is softer than a layer without edges.
    bool is_near_edge = false;
    double area() const; ///< that touches, mm²
};

/// What the next contact begins with.
struct PressMemory {
    ContactCells cells;             ///< none: the grid is not known
    Eigen::MatrixXd pressure, last; ///< of the last contact and the one before it; empty: not known
};

/// Presses a wheel on surfels at one pose after the other: +z out of the part, the wheel's axis along y. The grid is as
/// large as the contact and a little more; it grows when a contact comes to its border. Each contact begins with what
/// the two before it lead to expect.
class WheelPress {
  public:
    /// All are kept by reference, but for the options.
    WheelPress(const Surfels& surfels, const ContactWheel& wheel, const PressOptions& options);

    /// @throws InputError if there is nothing under the wheel, or the contact is not found to tolerance
    const Press& at(const Eigen::Isometry3d& T_part_tool, const Pressing& pressing);
    /// The surfels that the last grid was made from, and where they are: as the cells and their heights.
    const std::vector<Eigen::Index>& under() const { return under_; }
    const Eigen::Matrix3Xd& places() const { return places_; }
    /// Farthest edges of cells that touch, along x and y, mm.
    Eigen::Vector2d reach() const;
    /// What is left between wheel and surfels, mm.
    Eigen::MatrixXd gap_left();
    /// The next contact has nothing to do with the last.
    void lift();
    PressMemory memory() const;
    /// The next contact comes out as it would have done then, to the last digit.
    void remember(const PressMemory& memory);

  private:
    void set_grid(const ContactCells& cells, LayerSolver solver);
    void find_grid(const Eigen::Isometry3d& T_part_tool, const Pressing& pressing);
    void press_on(const Eigen::Isometry3d& T_part_tool, const Pressing& pressing, Gridding gridding, double tolerance);
    bool is_at_border() const;

    const Surfels& surfels_;
    const ContactWheel& wheel_;
    PressOptions options_;
    SurfelIndex index_;
    double farthest_;                   ///< stock from its surfel, mm
    std::optional<LayerContact> layer_; ///< none: the grid is not known
    std::vector<Eigen::Index> under_;
    Eigen::Matrix3Xd places_;
    Eigen::MatrixXd gap_, last_;
    Press press_;
};

/// A point for each cell that something is under, in the part frame, with fields pressure (MPa) and gap (mm).
Cloud to_cloud(const Press& press, const Eigen::MatrixXd& gap_left, const Eigen::Isometry3d& T_part_tool);

} // namespace fettle
