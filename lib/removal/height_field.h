#pragma once

#include "cloud/cloud.h"
#include "job/job.h"
#include "sampling/scan.h"

#include <Eigen/Core>

#include <string>

namespace fettle {

/// Stock that faces up: a height at the centre of each square cell of a regular grid that lies along the working frame
/// W.
struct HeightField {
    double theta = 0;       ///< of W, rad (job.h)
    Eigen::Vector2d origin; ///< outer corner of cell (0, 0), W, mm
    double cell = 0;        ///< side, mm
    Eigen::ArrayXXd z;      ///< z(i, j): cell i along X_w (contiguous), j along Y_w, mm; NaN: no material

    Eigen::Index columns() const { return z.rows(); } ///< cells along X_w
    Eigen::Index rows() const { return z.cols(); }    ///< cells along Y_w
    /// Centre of a cell, W.
    Eigen::Vector2d centre(Eigen::Index i, Eigen::Index j) const
    {
        return origin + cell * Eigen::Vector2d(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
    }
};

/// A grid over `box` (W; column 0 the least corner, column 1 the greatest) and `margin` around it, without material. A
/// corner of the box is a corner of a cell, so that a grid moves with its job.
/// @throws InputError for a cell that is not positive, or so small that the cells would not fit the memory
HeightField empty_height_field(const Eigen::Matrix2d& box, const Eigen::Vector2d& margin, double theta, double cell);

/// Puts the scan's surface into the cells that it lies over: the highest z of a mesh over their centres, or what a
/// touch of a cloud finds there. Other cells stay.
void lay(HeightField& field, const Scan& scan);

/// What a stock lies under: B, which is ground, or all of S, which is touched.
enum class Extent { anomaly, sampling };

/// The stock over the anomaly B, or over S if the job has it, and as far around as the wheel reaches: its radius along
/// Y_w, half its width along X_w.
/// @param source  the scan's name for messages
/// @throws InputError as above, or if the scan has a hole inside B
HeightField height_field(const Scan& scan, const Job& job, double cell, const std::string& source = "stock",
                         Extent extent = Extent::anomaly);

/// z of the lowest point of a ball that came down on the stock; a ball of radius 0 meets the surface that is bilinear
/// between the cells' centres.
/// @param xy  of its centre, W   @return  NaN if there is no material
double height_under_ball(const HeightField& stock, const Eigen::Vector2d& xy, double radius);

/// ∫ (before − after), mm³. The grids must be the same.
double volume_between(const HeightField& before, const HeightField& after);

/// One point for each cell that has material, frame M, row by row; field `removed`: before − after.
Cloud to_cloud(const HeightField& before, const HeightField& after);

} // namespace fettle
