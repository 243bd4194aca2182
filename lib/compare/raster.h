#pragma once

#include "compare/view.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

namespace fettle {

/// One value a pixel, rows x columns.
struct Raster {
    Eigen::ArrayXXd value;
    Eigen::ArrayXXd depth;                                      ///< z of V where the part is seen, mm; NaN: unknown
    Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> covered; ///< false: nothing lies there
};

/// The typical distance of a point to its fourth neighbour, mm: the cell of a gridded cloud. 0 for fewer than two
/// places. Where no point has a z, it is that in the plane.
/// @param points  3xN; columns with a NaN x or y do not count
double point_spacing(const Eigen::Matrix3Xd& points);

/// Each pixel has the value of the point nearest to it in the plane, if that is within `reach` mm and not hidden behind
/// others: a gridded cloud becomes its cells, turned as they lie, a sparse one discs. Depths are smooth: the mean of
/// the points within reach, the near ones counting more.
/// @param points  3xN, V
Raster rasterise(const View& view, const Eigen::Matrix3Xd& points, const Eigen::VectorXd& values, double reach);

/// Each pixel has the value of the mesh where it is nearest to the eye over the pixel's centre.
/// @param mesh  V   @param values  of its vertices; linear between them
Raster rasterise(const View& view, const Mesh& mesh, const Eigen::VectorXd& values);

/// Brightness of what is seen under light from the upper left, about 1 where it faces the eye; 1 where nothing lies.
/// @param smoothing  standard deviation of the filter that takes away the steps between cells, pixels
Eigen::ArrayXXd hill_shading(const Raster& raster, double pixel, double smoothing);

} // namespace fettle
