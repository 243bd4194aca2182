#pragma once

#include "mesh/shape_file.h"
#include "part/profile.h"
#include "sampling/noise.h"
#include "units/units.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fettle::part {

/// A surface defined by a function over a rectangle of the x-y plane.
struct AnalyticSurface {
    ScalarField2d z;            ///< mm
    Eigen::AlignedBox2d region; ///< mm
};

/// A scanned surface: a mesh or a cloud.
struct ScannedSurface {
    std::string file; ///< path relative to the working folder
    units::Units::Length unit = units::Units::Length::mm;
    std::optional<Eigen::AlignedBox2d> region; ///< the part of the scan that is used, mm; nothing: all of it
};

/// Specification of a synthetic casting (docs/formats.md, kind "part").
struct PartSpec {
    std::string source = "part"; ///< name of the file for messages
    units::Units units;
    std::variant<AnalyticSurface, ScannedSurface> surface;
    double step = 1; ///< longest side of a triangle in x or y, mm
    std::vector<Anomaly> anomalies;
    sampling::TouchNoise noise; ///< noise of the vertices or points, along z
};

/// Reads a specification from a file. @throws InputError with the key's path
PartSpec read_part(const std::string& path);

/// The upper surface of the part with its anomalies: a mesh, or a cloud if the scan is one. Without anomalies and noise
/// the result is the reference for a part that was ground; outside the anomalies both are the same surface. On a scan
/// with an underside only the upper side is lifted. On a cloud the anomaly gets additional points with a spacing of
/// `step`.
/// @throws InputError if the surface is not defined everywhere in its region, an anomaly is outside the part, or the
///         step is too fine
/// @param warnings  receives what was left out of a scanned surface, and doubts about its unit, unless null
mesh::MeshOrCloud make_part(const PartSpec& spec, std::uint64_t seed, std::vector<std::string>* warnings = nullptr);

} // namespace fettle::part
