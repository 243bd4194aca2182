#include "job/joined.h"

#include "job/boost_polygons.h"

#include <algorithm>

namespace fettle::job {

Polygon joined(const Polygon& a, const Polygon& b)
{
    const auto counter_clockwise = [](const Polygon& polygon) {
        BoostPolygon result = to_boost(polygon);
        bg::correct(result);
        return result;
    };
    BoostPolygons pieces;
    bg::union_(counter_clockwise(a), counter_clockwise(b), pieces);
    const auto largest =
        std::ranges::max_element(pieces, {}, [](const BoostPolygon& piece) { return bg::area(piece); });
    if (largest == pieces.end()) return {};
    Polygon result(2, largest->outer().size());
    for (std::size_t i = 0; i < largest->outer().size(); ++i)
        result.col(Eigen::Index(i)) << largest->outer()[i].x(), largest->outer()[i].y();
    return result;
}

} // namespace fettle::job
