#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

namespace fettle {

/// The x-y plane as seen from above on a raster: column to the right along x, row downwards against y.
struct View {
    Eigen::Vector2d least; ///< lower left corner, mm
    double pixel = 1;      ///< side of a pixel, mm
    int columns = 0, rows = 0;

    /// In pixels from the upper left corner.
    Eigen::Vector2d to_pixel(const Eigen::Vector2d& xy) const
    {
        return {(xy.x() - least.x()) / pixel, rows - (xy.y() - least.y()) / pixel};
    }
};

/// One value a pixel, rows x columns.
struct Raster {
    Eigen::ArrayXXd value;
    Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> covered; ///< false: nothing lies there
};

/// The typical distance of neighbouring points, mm: the cell of a gridded cloud. 0 for fewer than two places.
/// @param xy  2xN; NaN columns do not count
double point_spacing(const Eigen::Matrix2Xd& xy);

/// Each pixel has the value of the nearest point, if that is within `reach` mm: a gridded cloud becomes its cells,
/// turned as they lie, a sparse one discs.
Raster rasterise(const View& view, const Eigen::Matrix2Xd& xy, const Eigen::VectorXd& values, double reach);

/// Each pixel has the height of the mesh's highest point over its centre, mm.
Raster rasterise(const View& view, const Mesh& mesh);

/// Brightness of a height map under light from the upper left, about 1 where it is level; 1 where nothing lies.
/// @param smoothing  standard deviation of the filter that takes away the steps between cells, pixels
Eigen::ArrayXXd hill_shading(const Raster& heights, double pixel, double smoothing);

} // namespace fettle
