#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fettle::machining {

/// Whether a patch has an error, or the reason why not.
enum class PatchState : std::uint8_t {
    defined,
    not_hit,     ///< the design is neither below nor above one of its corners
    vertical,    ///< the design has a wall there
    turned_away, ///< the machined triangle does not face up
};

/// Errors of the machined triangles against the design, which is resampled at their corners (Guan & Xiong). NaN means
/// undefined.
struct PatchErrors {
    mesh::Mesh design;       ///< resampled: the machined triangles, projected along Z onto the design's highest surface
    Eigen::VectorXd z_error; ///< machined − design at each vertex, mm
    Eigen::Matrix3Xd centre; ///< centroids of the machined triangles, mm
    Eigen::Matrix3Xd normal; ///< N/|N| of the resampled design's triangles, upwards (eq. 5)
    Eigen::VectorXd d;       ///< mean of the Z errors of the three corners, mm (eq. 4)
    Eigen::VectorXd mu;      ///< (N·Z)/|N| d, mm (eq. 6); positive: material left
    Eigen::VectorXd area;    ///< area of the resampled design's triangles, mm²: mu · area is a volume
    Eigen::VectorXd machined_area; ///< area of the machined triangles, mm²
    std::vector<PatchState> state;
    std::vector<std::uint8_t> beyond_border; ///< 1: the design has no surface at a corner, nor a wall in the patch
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); ///< direction Z, in the frame of the other members
};

/// @param machined  triangles of a height field: their frame has Z along the tool's axis; mm
PatchErrors patch_errors(const mesh::Mesh& machined, const mesh::Mesh& design);

/// Signed distance of each patch's centroid from the closest point of the design, mm. Beyond the border
/// of an open design the closest point is some place of its flank, and says nothing: NaN.
/// @param design_is_closed  then all patches have a distance
Eigen::VectorXd closest_errors(const PatchErrors& errors, const mesh::Mesh& design, bool design_is_closed);

/// Rotates all points and directions, as from the tilted frame to M (tilt.h).
PatchErrors rotated(PatchErrors errors, const Eigen::Matrix3d& rotation);

/// Classes of errors by two tolerances; a patch in the neutral band about 0 has no error.
enum class ErrorClass : std::int8_t {
    serious_over_cut = -2, ///< below −inner
    slight_over_cut = -1,
    neutral = 0,
    slight_under_cut = 1,
    serious_under_cut = 2, ///< above outer
};
inline constexpr std::array<ErrorClass, 5> kErrorClasses = {ErrorClass::serious_over_cut, ErrorClass::slight_over_cut,
                                                            ErrorClass::neutral, ErrorClass::slight_under_cut,
                                                            ErrorClass::serious_under_cut};
std::string to_string(ErrorClass error_class);
std::string to_string(PatchState state);

struct PatchTolerances {
    double inner = 0;   ///< largest over-cut, mm
    double outer = 0;   ///< largest under-cut: material left, mm
    double neutral = 0; ///< half-width of the neutral band, as a fraction of both tolerances
};
ErrorClass classify(double error, const PatchTolerances& tolerances);

/// Bright red, dark red, neutral grey, violet, dark blue (Guan & Xiong, figure 6).
std::array<std::uint8_t, 3> colour(ErrorClass error_class);

} // namespace fettle::machining
