#pragma once

#include <Eigen/Core>

namespace fettle {

/// To the view frame V: x to the right, y upwards on the sheet, z towards the eye; same origin. Z of the machine is up
/// on the sheet, or Y where one looks along Z: from above, V is the machine frame.
/// @param from  unit, M: towards the eye   @return rotation_view_machine
Eigen::Matrix3d view_rotation(const Eigen::Vector3d& from);

/// Points in the view frame. Where one looks along Z, a point whose z is missing still has its place on the sheet.
Eigen::Matrix3Xd in_view(const Eigen::Matrix3d& rotation_view_machine, const Eigen::Matrix3Xd& points);

/// A part of the view's plane as a raster: column to the right along x, row downwards against y.
struct View {
    Eigen::Vector2d least; ///< lower left corner, mm
    double pixel = 1;      ///< side of a pixel, mm
    int columns = 0, rows = 0;

    /// In pixels from the upper left corner.
    Eigen::Vector2d to_pixel(const Eigen::Vector2d& xy) const
    {
        return {(xy.x() - least.x()) / pixel, rows - (xy.y() - least.y()) / pixel};
    }
    /// Of a pixel, mm.
    Eigen::Vector2d centre(Eigen::Index row, Eigen::Index column) const
    {
        return least + pixel * Eigen::Vector2d(double(column) + 0.5, double(rows - row) - 0.5);
    }
};

} // namespace fettle
