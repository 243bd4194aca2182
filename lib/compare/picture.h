#pragma once

#include "compare/sheet.h"
#include "job/job.h"
#include "mesh/shape_file.h"
#include "units/units.h"

#include <functional>
#include <optional>
#include <string>

namespace fettle {

struct PictureOptions {
    std::string title;
    std::string field = "z";     ///< what is shown: z or a field of the cloud
    std::optional<double> scale; ///< colours run from -scale to +scale (error), else from the least value over `scale`
    int bands = 0;               ///< colours in so many equal steps; 0: continuous
    Units units;                 ///< of the numbers in the picture
    std::optional<Job> within;   ///< draw its B and S; the statistics and the colours are those of B
    int width = 900;             ///< of the map at most, pixels; the sheet is 394 wider
    int fineness = 1;            ///< points of the map a pixel of the sheet, each way: for sheets that are printed
    Eigen::Vector3d from = Eigen::Vector3d::UnitZ(); ///< unit, M: towards the eye, which is far away
};

/// A part seen from above, x to the right and y upwards, or from any other direction (view_rotation()): values as
/// colours, with legend, histogram, scale and statistics. `error` has the diverging colours of ColourScale, every other
/// field a sequential map; z is shaded as hills are, and from the side all fields are, more lightly. What has no value
/// is grey; what is behind something else is hidden.
/// @return the bytes of a PNG, the same for the same input
/// @throws InputError if there is no such field, or no point with finite x and y
std::string picture(const MeshOrCloud& part, const PictureOptions& options);

/// The same on a sheet that `make` gives for a width and a height.
void draw_picture(const MeshOrCloud& part, const PictureOptions& options,
                  const std::function<Sheet&(int width, int height)>& make);

} // namespace fettle
