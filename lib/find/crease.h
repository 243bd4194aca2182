#pragma once

#include "find/ring_basis.h"

#include <optional>

namespace fettle::find {

/// The ridge of a roof that runs through the region within a ring: of the lines through it the one on whose two sides
/// quadratics that meet in the line fit the ring best. A search over directions and offsets, then halved steps.
/// @param near  the search begins there
/// @return  nothing if the ring does not enclose its centroid, or the best line is no ridge
std::optional<Crease> find_crease(const Ring& ring, const std::optional<Crease>& near);

/// Tukey's weights of the ring's points about the quadratics on both sides of a crease.
Eigen::VectorXd crease_weights(const Ring& ring, const Crease& crease);

} // namespace fettle::find
