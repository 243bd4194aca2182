#pragma once

#include "cloud/cloud.h"
#include "job/job.h"
#include "sampling/scan.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>

namespace fettle::removal {

/// Stock as a height map: a height at the centre of each square cell of a regular grid, which is aligned with the
/// working frame W.
struct HeightField {
    double theta = 0;       ///< angle of W, rad (job.h)
    Eigen::Vector2d origin; ///< outer corner of cell (0, 0), W, mm
    double cell = 0;        ///< side of a cell, mm
    Eigen::ArrayXXd z;      ///< z(i, j): cell i along X_w (contiguous), j along Y_w, mm; NaN: no material

    Eigen::Index columns() const { return z.rows(); } ///< cells along X_w
    Eigen::Index rows() const { return z.cols(); }    ///< cells along Y_w
    /// Centre of a cell, W, mm.
    Eigen::Vector2d centre(Eigen::Index i, Eigen::Index j) const
    {
        return origin + cell * Eigen::Vector2d(i + 0.5, j + 0.5);
    }
};

/// A grid without material over `box` and a `margin` around it. A corner of the box is a corner of a cell, so the grid
/// moves with its job.
/// @param box  W, mm
/// @throws InputError for a cell that is not positive, or so small that the cells would not fit the memory
HeightField empty_height_field(const Eigen::AlignedBox2d& box, const Eigen::Vector2d& margin, double theta,
                               double cell);

/// Rasterizes the scan's surface into the cells that it covers: the highest z of a mesh at the cell's centre, or for a
/// cloud the height that Scan::height finds there. The other cells keep their values.
void rasterize(HeightField& field, const sampling::Scan& scan);

/// The region that a stock has to cover: B, which is ground, or all of S, which is probed.
enum class Extent { anomaly, sampling };

/// The stock over the anomaly B, or over S if the job has it, and around it as far as the wheel reaches: its radius
/// along Y_w, half its width along X_w.
/// @param source  the scan's name for messages
/// @throws InputError as empty_height_field does, or if the scan has a hole inside B
HeightField stock_from_scan(const sampling::Scan& scan, const job::Job& job, double cell,
                            const std::string& source = "stock", Extent extent = Extent::anomaly);

/// The stock over all of the scan, on the job's grid: for a job whose boundaries are not known yet.
HeightField stock_over_scan(const sampling::Scan& scan, double theta, double cell);

/// Lowest point of a ball that is lowered onto the stock, z in mm. A ball of radius 0 meets the surface that is
/// bilinear between the cells' centres.
/// @param xy  centre of the ball, W   @return  NaN if there is no material
double height_under_ball(const HeightField& stock, const Eigen::Vector2d& xy, double radius);

/// ∫ (before − after), mm³. Both must have the same grid.
double volume_between(const HeightField& before, const HeightField& after);

/// One point for each cell that has material, frame M, row by row; field `removed`: before − after.
cloud::Cloud to_cloud(const HeightField& before, const HeightField& after);

} // namespace fettle::removal
