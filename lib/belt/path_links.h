#pragma once

#include "cloud/cloud.h"

#include <Eigen/Core>

namespace fettle::belt {

struct LinkOptions {
    double clearance = 10;    ///< of the tool from the part on its travel from stroke to stroke, mm
    double approach = 5;      ///< height over the part, along the tool's axis, where the approach begins, mm
    double spacing = 2.5;     ///< maximum distance of points, mm: on so short a way even motions of joints are straight
    double uncertainty = 0.1; ///< by which the part may stand beyond its points and the tip leave its way, mm
};

/// Joins the strokes of a path by motions off the part: along the tool's axis away from it, from stroke to stroke, and
/// along the axis back to it; also before the first stroke and after the last.
///
/// The part lies in the half space below the plane across the tool's axis z at the height of its support function,
/// h(z) = max p · z over its points p (Schneider 2014, Convex bodies, 1.7). A tool no part of which lies below its own
/// tip, as a ball, a wheel or a spindle, is therefore at least a clearance c away wherever it is, as long as its tip x
/// obeys x · z >= h(z) + c. On the travel x and z are interpolated as by interpolate_path(), and where they do not obey
/// it the tip is lifted along z: on the convex hull of the part, grown by c, it takes the way along its surface.
///
/// Added fields: `stroke` (from 0; -1 between strokes) and `motion` (cloud::Motion); `pass` is -1 between strokes.
/// Other fields are those of the stroke that a point belongs to.
/// @param path  with poses; a change of `pass`, or of `stroke`, or a NaN pose ends a stroke   @param part  3xN, mm, in
/// the path's frame
/// @throws InputError if the path has no pose, or is linked already, or the part has no point
cloud::Cloud link_strokes(const cloud::Cloud& path, const Eigen::Matrix3Xd& part, const LinkOptions& options);

} // namespace fettle::belt
