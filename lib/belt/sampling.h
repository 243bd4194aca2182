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

namespace fettle {

struct SurfelSampling {
    double spacing = 0.5; ///< of neighbouring surfels at most, mm
    /// How far a disc may lie from the surface beneath it, mm: on a curvature κ, neighbours are then no more than
    /// 2 √(precision / κ) apart, since a disc of half that radius over √2 bends off by κ r² / 2. Nothing: any.
    std::optional<double> precision;
    std::optional<double> edge_spacing;  ///< e of resample_boundaries(), mm; nothing: half the spacing
    double sharp = std::numbers::pi / 6; ///< between two normals, more is an edge, rad
};

/// A design as surfels without stock.
struct SampledDesign {
    Surfels surfels;
    int patches = 0;
    EdgeCounts edges;
    double least_spacing = 0; ///< of a patch, mm: what the precision asked for
};

/// A mesh: its patches are charts (charts.h) between sharp edges, u and v lengths in their planes, mm. In each cell of
/// a square lattice in that plane the surfel is the point of the chart closest to the cell's middle. Normals are those
/// of the smooth surface between the edges.
/// @throws InputError if it would be more surfels than fit into memory
SampledDesign sample_surfels(Mesh design, const SurfelSampling& options);

/// B-spline patches: the middles of a u-v lattice, whose lines are so spaced that arcs between them are nowhere longer
/// than the spacing; inside the trimming curves. A boundary with another one beside it and no edge between them is not
/// re-sampled. Normals are those of P_u × P_v.
SampledDesign sample_surfels(const std::vector<Patch>& design, const SurfelSampling& options);

/// A scan with normals: points of it, taken in their order if none before lies closer than the spacing. Its patches are
/// charts over neighbours; it has no boundary curves.
/// @throws InputError without normals
SampledDesign sample_surfels(const Cloud& design, const std::string& source, const SurfelSampling& options);

/// The spacing of a patch. @param curvature  of it, 1/mm
double spacing_for(const SurfelSampling& options, double curvature);

/// @throws InputError for more surfels than fit into memory
void check_surfel_count(double count);

} // namespace fettle
