#pragma once

#include "belt/edges.h"
#include "belt/surfel.h"
#include "cloud/cloud.h"
#include "mesh/mesh.h"
#include "surface/patches.h"

#include <Eigen/Core>

#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace fettle::belt {

struct SurfelSampling {
    double spacing = 0.5; ///< max. distance of neighbouring surfels, mm
    /// Max. distance of a disc from the surface, mm. On a surface of curvature κ the spacing is then at most
    /// 2 √(precision / κ), since the surface departs from a disc of radius r = spacing / √2 by κ r² / 2. Empty: no
    /// limit.
    std::optional<double> precision;
    std::optional<double> edge_spacing;        ///< e of resample_boundaries(), mm; empty: half the spacing
    double sharp_angle = std::numbers::pi / 6; ///< min. angle between the normals at an edge, rad
};

/// A design as surfels, with displacement 0.
struct SampledDesign {
    Surfels surfels;
    int patches = 0;
    EdgeCounts edges;
    double min_spacing = 0;            ///< the smallest of the patches' spacings, mm
    std::vector<std::string> warnings; ///< of a file: what was left out of it, a size that is hardly meant
};

/// Samples a mesh. Its patches are charts (charts.h) between sharp edges; u and v are lengths in their planes, mm. Each
/// cell of a square lattice in that plane gets a surfel at the point of the chart closest to its centre. Normals are
/// those of the smooth surface between the edges.
/// @throws InputError for more surfels than fit into memory
SampledDesign sample_surfels(mesh::Mesh design, const SurfelSampling& options);

/// Samples B-spline patches at the cell centres of a u-v lattice inside the trimming curves. No arc between two lines
/// of the lattice is longer than the spacing. A boundary that continues smoothly in another patch is not re-sampled.
/// Normals have the direction of P_u × P_v.
/// @throws InputError for more surfels than fit into memory
SampledDesign sample_surfels(const std::vector<surface::Patch>& design, const SurfelSampling& options);

/// Thins a scan with normals: a point is taken if no earlier one taken is closer than the spacing. The patches are
/// charts over neighbouring points; there are no boundary curves.
/// @throws InputError without normals
SampledDesign sample_surfels(const cloud::Cloud& design, const std::string& source, const SurfelSampling& options);

/// Spacing of a patch.
/// @param curvature  of the patch, 1/mm   @return  mm
double spacing_for_curvature(const SurfelSampling& options, double curvature);

/// Surfels of a design: 1.5 GB with what their sampling needs beside them; at 0.5 mm a part of a square metre.
inline constexpr double kMaxSurfels = 5e6;

/// @param count  of the surfels so far   @param patch  that the last ones belong to
/// @throws InputError for more than kMaxSurfels
void check_surfel_count(double count, int patch);

} // namespace fettle::belt
