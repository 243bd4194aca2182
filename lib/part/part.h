#pragma once

#include "mesh/mesh.h"
#include "part/profile.h"
#include "units/units.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
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

/// Scatter of a scan along z. Normal: 99 % of it within ± size; uniform: all.
struct ScanNoise {
    enum class Kind { normal, uniform } kind = Kind::normal;
    double size = 0; ///< mm; 0: none
};

/// What a casting to be made looks like (docs/formats.md, kind "part").
struct PartSpec {
    Units units;
    std::variant<MadeSurface, ScannedSurface> surface;
    double step = 1; ///< longest side of a triangle in x or y, mm
    std::vector<Anomaly> anomalies;
    ScanNoise noise;
};

/// @throws InputError with the key's path
PartSpec read_part(const std::string& path);

/// The part as an open sheet, seen from above. Without anomalies and noise it is the truth that a ground part is
/// compared with: away from the anomalies both are the same to the last bit.
/// @throws InputError if the surface is not defined somewhere in its region, or an anomaly lies beside the part
Mesh make_part(const PartSpec& spec, std::uint64_t seed);

} // namespace fettle
