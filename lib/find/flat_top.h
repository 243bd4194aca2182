#pragma once

#include "find/image.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::find {

/// How far the top of a region departs from a plane: the median distance of its cells from the plane that the nearer
/// half of them fits best, mm; infinite for a few cells. Walls, holes and a second level may take the other half.
/// @param height  over the surface beneath   @param z  of what is seen
double departure_from_plane(const Mask& region, const Image& height, const Image& z);

/// The values of an image at cells.
Eigen::VectorXd values_at(const Image& image, const std::vector<cv::Point>& cells);

/// Residuals of heights at cells about their weighted least squares plane.
/// @param z  a height per cell, mm   @param weights  not negative; those above 0 belong to cells not all in a line
Eigen::VectorXd plane_residuals(const std::vector<cv::Point>& cells, const Eigen::VectorXd& z,
                                const Eigen::VectorXd& weights);

} // namespace fettle::find
