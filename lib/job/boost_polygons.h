#pragma once

// Polygons of jobs as Boost.Geometry's. For the files of lib/job alone: it takes seconds to compile.

// With optimisation, g++ 12 warns of values in Boost.Geometry's rescale policy that are set through references.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#define BOOST_ALLOW_DEPRECATED_HEADERS // Boost.Geometry includes one of Boost's own
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include <Eigen/Core>

namespace fettle::job {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using BoostPolygon = bg::model::polygon<Point, false, false>; // counter-clockwise, not closed
using BoostPolygons = bg::model::multi_polygon<BoostPolygon>;

inline BoostPolygon to_boost(const Eigen::Matrix2Xd& polygon)
{
    BoostPolygon result;
    for (Eigen::Index i = 0; i < polygon.cols(); ++i) result.outer().emplace_back(polygon(0, i), polygon(1, i));
    return result;
}

} // namespace fettle::job
