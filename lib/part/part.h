#pragma once

#include "mesh/shape_file.h"
#include "part/profile.h"
#include "sampling/noise.h"
#include "units/units.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fettle {

/// A surface made from a formula over a rectangle of the x-y plane.
struct MadeSurface {
    OverPlane z;                ///< mm
    Eigen::AlignedBox2d region; ///< mm
};

/// A surface that was scanned: a mesh, or a cloud.
struct ScannedSurface {
    std::string file; ///< seen from the working folder
    Units::Length unit = Units::Length::mm;
    std::optional<Eigen::AlignedBox2d> region; ///< what is kept of it, mm; nothing: all
};

/// What a casting to be made looks like (docs/formats.md, kind "part").
struct PartSpec {
    std::string source = "part"; ///< its name in messages
    Units units;
    std::variant<MadeSurface, ScannedSurface> surface;
    double step = 1; ///< longest side of a triangle in x or y, mm
    std::vector<Anomaly> anomalies;
    TouchNoise noise; ///< of the scan, along z
};

/// @throws InputError with the key's path
PartSpec read_part(const std::string& path);

/// The part, seen from above: a mesh; a cloud if the scan is one. Without anomalies and noise it is the truth that a
/// ground part is compared with: beside the anomalies both are the same surface. On a scan that has an underside only
/// what is seen from above is lifted. On a cloud the anomaly gets points of its own, `step` apart.
/// @throws InputError if the surface is not defined somewhere in its region, an anomaly lies beside the part, or the
///         step is too fine
MeshOrCloud make_part(const PartSpec& spec, std::uint64_t seed);

} // namespace fettle
