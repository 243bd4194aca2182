#pragma once

#include "core/constants.h"
#include "find/image.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::find {

/// The top of a region about the plane that the nearer half of its cells fits best. Walls, holes and a second level may
/// take the other half.
struct Top {
    double departure = core::kInfinity; ///< median distance of its cells from the plane, mm; infinite for a few cells
    double slope = 0;                   ///< of the plane against the surface beneath it, mm per cell
};

/// @param height  over the surface beneath, mm   @param z  of what is seen, mm
Top measure_top(const Mask& region, const Image& height, const Image& z);

/// The values of an image at cells.
Eigen::VectorXd values_at(const Image& image, const std::vector<cv::Point>& cells);

/// Residuals of heights at cells about their weighted least squares plane.
/// @param z  a height per cell, mm   @param weights  not negative; those above 0 belong to cells not all in a line
Eigen::VectorXd plane_residuals(const std::vector<cv::Point>& cells, const Eigen::VectorXd& z,
                                const Eigen::VectorXd& weights);

} // namespace fettle::find
