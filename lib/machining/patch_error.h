#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fettle {

/// What is known of a patch, or why nothing is.
enum class PatchState : std::uint8_t {
    defined,
    not_hit,     ///< the design is not under or over all of its corners
    vertical,    ///< the design has a wall there
    turned_away, ///< the machined triangle does not face up
};

/// The machined triangles beside the design, which is re-sampled at their corners (Guan & Xiong). NaN is undefined.
struct PatchErrors {
    Mesh design;             ///< as re-sampled: the machined triangles on the highest z of the design; z NaN: not hit
    Eigen::VectorXd z_error; ///< of each vertex: machined − design, mm
    Eigen::Matrix3Xd centre; ///< of the machined triangles, mm
    Eigen::Matrix3Xd normal; ///< N/|N| of the design's triangles, up (eq. 5)
    Eigen::VectorXd d;       ///< mean of the three Z errors, mm (eq. 4)
    Eigen::VectorXd mu;      ///< (N·Z)/|N| d, mm (eq. 6): + material left
    Eigen::VectorXd area;    ///< of the design's triangles, mm²: mu · area is a volume
    std::vector<PatchState> state;
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); ///< what is Z above
};

PatchErrors patch_errors(const Mesh& machined, const Mesh& design);

/// All places and directions turned: out of a tilted frame (tilt.h).
PatchErrors turned(PatchErrors errors, const Eigen::Matrix3d& rotation);

/// Classes of errors, by two tolerances; in a neutral band about 0 a patch counts as right.
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
    double inner = 0;   ///< how far over-cut may go, mm
    double outer = 0;   ///< how much material may be left, mm
    double neutral = 0; ///< share of both that is neither
};
ErrorClass classify(double error, const PatchTolerances& tolerances);

/// Bright red, dark red, neutral grey, violet, dark blue (Guan & Xiong, figure 6).
std::array<std::uint8_t, 3> colour(ErrorClass error_class);

} // namespace fettle
