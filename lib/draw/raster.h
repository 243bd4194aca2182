#pragma once

#include "draw/view.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

namespace fettle::draw {

/// Values of the pixels of a View, rows x columns.
struct Raster {
    Eigen::ArrayXXd value;
    Eigen::ArrayXXd depth;                                      ///< z of the visible surface in V, mm; NaN: undefined
    Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> covered; ///< false: background
};

/// Median distance of a point to its fourth neighbour, mm: the cell size of a gridded cloud. 0 for fewer than two
/// distinct points. Undefined z counts as 0.
/// @param points  3xN; columns with a NaN x or y are ignored
double point_spacing(const Eigen::Matrix3Xd& points);

/// Rasterises points: a pixel gets the value of the point nearest to it in the view plane, among those within `radius`
/// mm that are not hidden. A gridded cloud becomes its cells, rotated as they are, a sparse one discs. The depth of a
/// pixel is a weighted mean of these points, so it is smooth.
/// @param points  3xN, V
Raster rasterise(const View& view, const Eigen::Matrix3Xd& points, const Eigen::VectorXd& values, double radius);

/// Rasterises a mesh: a pixel gets the value of the facet nearest to the eye at the pixel's centre.
/// @param mesh  V   @param values  at its vertices; interpolated linearly
Raster rasterise(const View& view, const mesh::Mesh& mesh, const Eigen::VectorXd& values);

/// Brightness under light from the upper left: 1 where the surface faces the eye and on the background.
/// @param smoothing  standard deviation of the depth filter that removes the steps between cells, pixels
Eigen::ArrayXXd hill_shading(const Raster& raster, double pixel, double smoothing);

} // namespace fettle::draw
