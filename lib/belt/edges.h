#pragma once

#include "belt/surfel.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// One surfel while a design is being sampled.
struct Surfel {
    Eigen::Vector3d position, normal; ///< mm; unit
    Eigen::Vector2d uv;
    double radius = 0; ///< mm
    int patch = 0;
    double area = 0; ///< of the piece of the design that it stands for, mm²
};

Surfels to_surfels(const std::vector<Surfel>& list);

/// A piece of a patch's boundary where the surface ends or has an edge: a polyline from corner to corner.
struct EdgeCurve {
    Eigen::Matrix3Xd points;
    Eigen::Matrix3Xd normals; ///< of the patch, unit
    Eigen::Matrix2Xd uv;
    int patch = 0;
    double spacing = 0;  ///< of the patch's surfels along its boundary, at most, mm
    bool smooth = false; ///< the surface goes on beyond it without an edge: nothing shrinks, nothing is inserted
};

/// What boundary re-sampling did.
struct EdgeCounts {
    Eigen::Index on_edges = 0; ///< surfels that lie on the curves
    Eigen::Index shrunk = 0;   ///< whose radius exceeded their distance to the nearest curve
};

/// Boundary re-sampling (Ren et al. 2006, "Neighborhood and normals"). Surfels are laid on each curve in equal
/// distances L, at most its spacing, from its beginning on; between one at C0 and the next come n = floor(L / e) of
/// radius e at C0 + i e, i = 1 … n, along the curve; the one that lands on the next is left out. Surfels of the
/// patches' inside whose discs would reach over a curve shrink; what is closer to one than e / 2 gives way to those on
/// it, and its area goes to the nearest of them.
/// @param inside  of all patches; the surfels on the curves are appended
/// @param e       splitting interval, mm
EdgeCounts resample_boundaries(std::vector<Surfel>& inside, const std::vector<EdgeCurve>& curves, double e);

} // namespace fettle
