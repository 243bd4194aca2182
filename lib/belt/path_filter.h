#pragma once

#include "belt/contact_path.h"
#include "belt/contact_wheel.h"

#include <vector>

namespace fettle::belt {

/// Points of a path, to be kept or not.
using PathSelection = std::vector<bool>;

/// The points at which a surfel within a radius stands higher than a height over the design: where there is something
/// to grind.
/// @param radius  of the wheel's contact, or half the distance of rows, mm   @param height  mm
PathSelection select_high_stock(const Surfels& surfels, const ContactPath& path, double radius, double height);

/// The points at which a wheel has room: nowhere does the design stand in the wheel less its layer, which is rigid. On
/// a concave place narrower than the wheel it does, and in a bore.
PathSelection select_by_room(const Surfels& surfels, const ContactPath& path, const ContactWheel& wheel);

/// The points that are selected; passes end where some are left out between them.
ContactPath select_points(const ContactPath& path, const PathSelection& selection);

} // namespace fettle::belt
