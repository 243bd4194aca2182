#pragma once

#include "removal/height_field.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::removal {

/// Directions of the forces on the wheel's rim. By Preston's law the removed volume is c · F · dt, where F is the force
/// normal to the rim; the spring is vertical and carries its vertical part. On a slope φ that is F cos φ, and F sin φ
/// pushes the wheel away along Y_w; a rim that runs towards -Y_w is dragged towards +Y_w by the tangential force (Wang
/// 2007, fig. 6-3). Without `along_normal`, F is the vertical force whatever the slope, and nothing pushes.
struct RimForce {
    bool along_normal = false;
    double tangential = 0; ///< ratio to the normal force
};

/// A grinding wheel in a stock: a disc whose axis is parallel to X_w. Its lowest line is at z_tip; at the distance y
/// from it (along Y_w) its rim is at z_tip + R − √(R² − y²), the same for all |x| ≤ width / 2. The wheel acts on the
/// cells whose centres lie under the disc; all stock above the rim overlaps it, however high.
class WheelInStock {
  public:
    /// One row of cells under the wheel.
    struct Row {
        double* z;      ///< first cell under the wheel
        double* top;    ///< highest of the cells
        double profile; ///< height of the rim above z_tip, mm
        double lift;    ///< vertical force on the wheel per normal force
        double push;    ///< force along Y_w per normal force
    };

    /// The stock must outlive the wheel, and must not be raised meanwhile.
    WheelInStock(HeightField& stock, double width, const RimForce& rim = {});

    /// Positions the wheel over `xy` (W, its lowest line at mid-width).
    /// @param lowest  lower bound of every z_tip that is asked for at this position
    void place(const Eigen::Vector2d& xy, double radius, double lowest);

    /// z_tip at which the wheel, lowered here, first meets stock; −∞ if there is none above `lowest`.
    double touch() const { return touch_; }

    /// The stock above the rim.
    struct Overlap {
        double volume = 0; ///< mm³
        double lift = 0;   ///< volume weighted with Row::lift, mm³
        double area = 0;   ///< cell area in plan view weighted with Row::lift, mm²: −dlift/dz_tip
        double push = 0;   ///< volume weighted with Row::push, mm³
    };
    /// `lift` is piecewise linear and convex in z_tip.
    Overlap overlap(double z_tip) const;

    /// Removes the overlap.
    void cut(double z_tip);

  private:
    /// Extends the valid part of row_tops_ to the rows from `first` up to `end`.
    void update_row_tops(Eigen::Index first, Eigen::Index end);

    HeightField& stock_;
    double width_;
    RimForce rim_;
    double max_height_;             ///< of the whole stock at the beginning, mm
    Eigen::Index first_column_ = 0; ///< columns under the wheel
    Eigen::Index columns_ = 0;
    std::vector<double> row_tops_; ///< highest cell of each row between these columns; valid from tops_first_ on
    Eigen::Index tops_first_ = 0, tops_end_ = 0;
    std::vector<Eigen::Index> candidate_rows_; ///< buffer: rows that the rim may meet
    std::vector<Row> rows_;                    ///< rows under the wheel at its current position
    double touch_ = 0;
};

} // namespace fettle::removal
