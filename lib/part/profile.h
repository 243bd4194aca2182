#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <vector>

namespace fettle::part {

/// A function of a point of the x-y plane; both are in mm.
using ScalarField2d = std::function<double(const Eigen::Vector2d& xy)>;

/// Surplus material on a casting: a height that is added along z to the desired surface.
struct Anomaly {
    ScalarField2d height;               ///< mm, not negative; 0 outside the footprint
    std::vector<ScalarField2d> creases; ///< zero level sets: the sharp edges; values are approximately distances, mm
    Eigen::AlignedBox2d footprint;      ///< mm
};

/// Section of a ridge across its centre line.
struct RidgeSection {
    double width = 0;  ///< at the foot, mm
    double height = 0; ///< mm
    bool round = true; ///< a circular arc (height at most width / 2), else a flat crest between two straight flanks
    double draft = 0;  ///< angle of the flanks from the vertical, rad; positive
};

/// A bead or a burr along a polyline. @param path  2xN, N at least 2, mm
Anomaly ridge_along(const Eigen::Matrix2Xd& path, const RidgeSection& section);

/// A closed ridge along a circle. @param radius  of its centre line, mm
Anomaly ring(const Eigen::Vector2d& centre, double radius, const RidgeSection& section);

/// A spherical cap. @param radius  of its foot, mm, at least `height`
Anomaly dot(const Eigen::Vector2d& centre, double radius, double height);

/// A plane top: its height is `low` at the first corner of the outline along `direction`, and `high` at the last one.
struct SlopedTop {
    double low = 0, high = 0; ///< mm
    double direction = 0;     ///< rad, counter-clockwise from X_m
};

/// A riser stub or a letter: walls that lean inwards from the outline of the foot up to a plane top.
/// @param outline  2xN, counter-clockwise, mm   @param draft  angle of the walls from the vertical, rad, positive
Anomaly stub(const Eigen::Matrix2Xd& outline, const SlopedTop& top, double draft);

/// A lump that rises smoothly from its outline to `height` over the distance `falloff`, mm.
Anomaly blob(const Eigen::Matrix2Xd& outline, double height, double falloff);

/// A hill with the height H (1 - ρ²)², where ρ is 1 on the ellipse with the given semi-axes. Its slope is 0 at the top
/// and at the foot, its volume π a b H / 3. @param angle  of the first semi-axis from X_m, rad
Anomaly hill(const Eigen::Vector2d& centre, const Eigen::Vector2d& semi_axes, double angle, double height);

/// Smooth noise that multiplies the height by 1 + size · noise, |noise| ≤ 1.
struct Roughness {
    double size = 0;  ///< below 1
    double grain = 1; ///< correlation length of the noise, mm
    std::uint64_t seed = 1;
};
Anomaly roughened(const Anomaly& anomaly, const Roughness& roughness);

/// Largest height of all anomalies at a point, mm; 0 outside their footprints.
double height(const std::vector<Anomaly>& anomalies, const Eigen::Vector2d& xy);

} // namespace fettle::part
