#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::belt {

/// One surfel while a design is being sampled.
struct Surfel {
    Eigen::Vector3d position, normal; ///< mm; unit
    Eigen::Vector2d uv;
    double radius = 0; ///< mm
    int patch = 0;
    double area = 0; ///< of the piece of the design that it represents, mm²
};

/// Surfels as columns, with displacement 0.
Surfels to_surfels(const std::vector<Surfel>& list);

/// A piece of a patch's boundary between two corners, as a polyline.
struct EdgeCurve {
    Eigen::Matrix3Xd points;
    Eigen::Matrix3Xd normals; ///< of the patch, unit
    Eigen::Matrix2Xd uv;
    int patch = 0;
    double spacing = 0;  ///< max. distance of the patch's surfels along the boundary, mm
    bool smooth = false; ///< the surface continues without an edge: no surfels shrink, none are inserted
};

/// Counts of boundary re-sampling.
struct EdgeCounts {
    Eigen::Index on_edges = 0; ///< surfels that lie on the curves
    Eigen::Index shrunk = 0;   ///< surfels whose radius exceeded their distance to the nearest curve
};

/// Boundary re-sampling (Ren et al. 2006, "Neighborhood and normals"). Each curve gets surfels at equal distances L, at
/// most its spacing, from its beginning. Between one of them, at C0, and the next one n = floor(L / e) surfels of
/// radius e are inserted at arc lengths C0 + i e, i = 1 … n, except one that coincides with the next surfel. Interior
/// surfels whose discs reach over a curve shrink. Those closer to a curve than e / 2 are removed, and their area goes
/// to the nearest surfel on the curves.
/// @param surfels  interior surfels of all patches; those on the curves are appended
/// @param e        splitting interval, mm
EdgeCounts resample_boundaries(std::vector<Surfel>& surfels, const std::vector<EdgeCurve>& curves, double e);

} // namespace fettle::belt
