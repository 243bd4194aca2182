#pragma once

#include "removal/height_field.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// How the wheel's rim meets the stock. By Preston's law the volume removed is c · F · dt. F is the force normal to the
/// rim; the spring is vertical and carries its vertical part. On a slope φ that is F cos φ, and F sin φ pushes the
/// wheel away along Y_w; a rim that runs towards -Y_w is dragged towards +Y_w by the tangential force (Wang 2007, fig.
/// 6-3). Left out, F is the vertical force whatever the slope, and nothing pushes.
struct RimForce {
    bool by_slope = false;
    double tangential = 0; ///< ratio to the normal force
};

/// A grinding wheel in a stock: a disc whose axis lies along X_w. Its lowest line is at z_tip; over the distance y from
/// it (along Y_w) its rim is at z_tip + R − √(R² − y²), the same for all |x| ≤ width / 2. The cells whose centres lie
/// under the disc belong to it, what stands above the rim is in its way, however high.
class WheelInStock {
  public:
    /// One row of cells under the wheel.
    struct Row {
        double* z;      ///< first cell under the wheel
        double* top;    ///< highest of the cells
        double profile; ///< rim over z_tip
        double lift;    ///< vertical force on the wheel per normal force
        double push;    ///< the same along Y_w
    };

    /// The stock must outlive the wheel, and nobody else may raise it.
    WheelInStock(HeightField& stock, double width, const RimForce& rim = {});

    /// Stands the wheel over `xy` (W, its lowest line at mid-width).
    /// @param lowest  no later z_tip of this place is below it
    void place(const Eigen::Vector2d& xy, double radius, double lowest);

    /// z_tip at which the wheel, lowered here, first meets stock; −∞ if there is none above `lowest`.
    double touch() const { return touch_; }

    /// What is in the way of the wheel.
    struct Overlap {
        double volume = 0; ///< of the stock above the rim, mm³
        double lift = 0;   ///< the volume, each part by the vertical force it takes (RimForce), mm³
        double area = 0;   ///< of the cells it stands on, seen from above, by their lift, mm²: −dlift/dz_tip
        double push = 0;   ///< as lift, for the force along Y_w, mm³
    };
    /// `lift` is piecewise linear and convex in z_tip.
    Overlap overlap(double z_tip) const;

    /// Removes it.
    void cut(double z_tip);

  private:
    /// Makes tops_ hold from row `first` up to `end`.
    void know_tops(Eigen::Index first, Eigen::Index end);

    HeightField& stock_;
    double width_;
    RimForce rim_;
    double highest_;                ///< of the whole stock, at the beginning
    Eigen::Index first_column_ = 0; ///< under the wheel
    Eigen::Index columns_ = 0;
    std::vector<double> tops_; ///< highest of each row between these columns, from known_first_ up to known_end_
    Eigen::Index known_first_ = 0, known_end_ = 0;
    std::vector<Eigen::Index> near_; ///< rows that may be met
    std::vector<Row> rows_;          ///< of this place
    double touch_ = 0;
};

} // namespace fettle
