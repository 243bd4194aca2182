#pragma once

#include "draw/field_scale.h"
#include "draw/sheet.h"
#include "job/job.h"
#include "mesh/cloud_mesh.h"
#include "mesh/shape_file.h"
#include "units/units.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <functional>
#include <optional>
#include <string>

namespace fettle::draw {

struct PictureOptions : ScaleOptions {
    std::string title;
    std::string field = "z";     ///< shown as colours: z, a field of the cloud, its `class`es, or its colours `rgb`
    units::Units units;          ///< of the numbers in the picture
    std::optional<job::Job> job; ///< its B and S are drawn; statistics and colours are those of B
    Eigen::AlignedBox3d extent;  ///< M, mm: is shown even where the part is not, as beside another picture
    int width = 900;             ///< largest width of the map, pixels; the sheet is 394 wider
    int supersampling = 1;       ///< map pixels per pixel of the sheet, each way: for print
    Eigen::Vector3d towards_eye = Eigen::Vector3d::UnitZ(); ///< unit, M: towards the eye, which is at infinity
};

/// Renders a part in parallel projection from above, x to the right and y upwards, or from any other direction
/// (view_rotation()): values as colours, with legend, histogram, scale and statistics (see scale_for()). Classes have a
/// legend that names and counts them. Hill shading is applied to z and, more lightly, to all
/// fields seen from the side. Undefined values are grey.
/// @return the bytes of a PNG, the same for the same input
/// @throws InputError if there is no such field, or no point with finite x and y
std::string picture(const mesh::MeshOrCloud& part, const PictureOptions& options);

/// As above, of a mesh with the fields of its vertices: between them values are interpolated, classes are those of the
/// nearest corner.
std::string picture(const mesh::CloudMesh& part, const PictureOptions& options);

/// The map of picture() alone, without legend, frame and boundaries, as wide as options.width. @return  as picture()
std::string map_picture(const mesh::MeshOrCloud& part, const PictureOptions& options);

/// The scale that picture() has for a part.
PictureScale picture_scale(const mesh::MeshOrCloud& part, const PictureOptions& options);

/// Draws the picture on a sheet that `make` creates for a width and a height in pixels.
void draw_picture(const mesh::MeshOrCloud& part, const PictureOptions& options,
                  const std::function<Sheet&(int width, int height)>& make);

} // namespace fettle::draw
