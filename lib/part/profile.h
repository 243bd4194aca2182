#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <vector>

namespace fettle {

/// A number over each point of the x-y plane, mm.
using OverPlane = std::function<double(const Eigen::Vector2d& xy)>;

/// What is too much on a casting: a height, added along z to the desired surface over a footprint.
struct Anomaly {
    OverPlane height;               ///< mm, at least 0; 0 outside the footprint
    std::vector<OverPlane> creases; ///< sharp edges of the profile are the zero lines of these, about distances, mm
    Eigen::AlignedBox2d footprint;
};

/// Section of a ridge, across its spine.
struct RidgeSection {
    double width = 0;  ///< at the foot, mm
    double height = 0; ///< mm
    bool round = true; ///< a circular arc (height at most width / 2), else a flat crest between two straight flanks
    double draft = 0;  ///< of the flanks against the vertical, rad; positive
};

/// A bead or a burr along a polyline. @param path  2xN, N at least 2, mm
Anomaly ridge_along(const Eigen::Matrix2Xd& path, const RidgeSection& section);

/// A closed ridge over a circle. @param radius  of its spine, mm
Anomaly ring(const Eigen::Vector2d& centre, double radius, const RidgeSection& section);

/// A spherical cap. @param radius  of its foot, mm, at least `height`
Anomaly dot(const Eigen::Vector2d& centre, double radius, double height);

/// A plane top: `low` at the corner of the outline that is least along `direction`, `high` at the farthest.
struct SlopedTop {
    double low = 0, high = 0; ///< mm
    double direction = 0;     ///< rad, counter-clockwise from X_m
};

/// A riser stub, a letter: walls that lean inwards by `draft` from the outline (the foot) up to a plane top.
/// @param outline  2xN, counter-clockwise, mm   @param draft  rad against the vertical, positive
Anomaly stub(const Eigen::Matrix2Xd& outline, const SlopedTop& top, double draft);

/// A lump that rises smoothly from its outline over the distance `falloff` to `height`.
Anomaly blob(const Eigen::Matrix2Xd& outline, double height, double falloff);

/// H (1 - ρ²)², ρ the radius as a fraction of the ellipse: flat at the top and at the foot. Its volume is π a b H / 3.
Anomaly hill(const Eigen::Vector2d& centre, const Eigen::Vector2d& semi_axes, double angle, double height);

/// Rough: the height is multiplied by 1 + size · noise, noise smooth within ±1.
struct Roughness {
    double size = 0;  ///< below 1
    double grain = 1; ///< distance over which the noise changes, mm
    std::uint64_t seed = 1;
};
Anomaly roughened(const Anomaly& anomaly, const Roughness& roughness);

/// The highest of all anomalies over a point, mm.
double height(const std::vector<Anomaly>& anomalies, const Eigen::Vector2d& xy);

} // namespace fettle
