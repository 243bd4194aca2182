#pragma once

#include "belt/belt_path.h"
#include "belt/press.h"
#include "cli/tool.h"

#include <optional>

namespace fettle::belt {

/// The options of the contact: --gridding, --cells, --tolerance, --solver, --elements. The references are those of the
/// tool.
struct ContactOptions {
    ContactOptions(cli::Tool& tool, int default_cells, double default_tolerance);
    /// @throws InputError for more cells than the solver can have
    void check() const;
    WheelContactOptions values() const;

    const Gridding& gridding;
    const int& cells;        ///< along each side of the grid
    const double& tolerance; ///< of the contact
    const LayerSolver& solver;
    const int& elements; ///< of LayerSolver::fem, from the surface to the hub
};

/// The options of grinding along a path: --force, --depth, --feed, --dwell, --worn. The references are those of the
/// tool; lengths are in the unit of its files.
struct GrindingOptions {
    explicit GrindingOptions(cli::Tool& tool);
    /// @throws InputError if both a force and a depth are given
    void check() const;
    /// @param mm  per length unit
    BeltSettings settings(double mm) const;
    double prior_work() const; ///< N mm

    const std::optional<double>& force; ///< N
    const std::optional<double>& depth;
    const std::optional<double>& feed;
    const double& dwell; ///< s
    const double& worn;  ///< work, J
};

} // namespace fettle::belt
