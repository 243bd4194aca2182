#pragma once

#include <Eigen/Core>

namespace fettle::draw {

/// Rotation into the view frame V: x to the right, y upwards on the sheet, z towards the eye; same origin. Z of the
/// machine points up on the sheet, or Y for a view along Z. Seen from above, V is the machine frame.
/// @param towards_eye  unit, M   @return  rotation_view_machine
Eigen::Matrix3d view_rotation(const Eigen::Vector3d& towards_eye);

/// Points in the view frame. In a view along Z, x and y do not depend on z, which may be NaN.
Eigen::Matrix3Xd in_view(const Eigen::Matrix3d& rotation_view_machine, const Eigen::Matrix3Xd& points);

/// Raster over a part of the view plane: columns along x, rows against y.
struct View {
    Eigen::Vector2d min_corner; ///< lower left corner, mm
    double pixel = 1;           ///< side of a pixel, mm
    int columns = 0, rows = 0;

    /// Position in pixels from the upper left corner.
    Eigen::Vector2d to_pixel(const Eigen::Vector2d& xy) const
    {
        return {(xy.x() - min_corner.x()) / pixel, rows - (xy.y() - min_corner.y()) / pixel};
    }
    /// Centre of a pixel, mm.
    Eigen::Vector2d centre(Eigen::Index row, Eigen::Index column) const
    {
        return min_corner + pixel * Eigen::Vector2d(double(column) + 0.5, double(rows - row) - 0.5);
    }
};

} // namespace fettle::draw
