#pragma once

// For the files of this module alone.

#include "cad/design.h"
#include "cad/face_triangle.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <Geom2d_Curve.hxx>
#include <TopoDS_Edge.hxx>

#define BOOST_ALLOW_DEPRECATED_HEADERS // Boost.Geometry includes one of Boost's own
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace fettle::cad {

/// An edge as the border of a face. Each edge is there once for each of its faces, and a seam twice in one.
struct Border {
    int face = 0;
    TopoDS_Edge edge;
    Handle(Geom2d_Curve) parameters; ///< of the edge on the face's surface
    bool is_reversed = false;        ///< the face lies to the right of the curve, seen against du x dv
    bool is_seam = false;            ///< the face lies on both sides
    bool is_pole = false;            ///< a point, where the surface has no normal: apex of a cone, pole of a sphere
    double tolerance = 0;            ///< with which the file's edge and its ends lie on the surfaces, mm
    Eigen::Vector3d pole_normal = Eigen::Vector3d::Zero(); ///< sum of those of the triangles there, by their angles
};

/// A chord of a border between two of its parameters; of a pole, a point.
struct Chord {
    std::uint32_t border = 0;
    double t0 = 0, t1 = 0;
    Eigen::Vector3d a, b; ///< mm
};

/// The triangles and chords of all faces of a triangulated design, where they are placed, with an index of both.
struct Pieces {
    using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
    using Box = boost::geometry::model::box<Point>;
    /// Box of a piece and its number: that of the triangle or, from triangles.size() on, of the chord.
    using Entry = std::pair<Box, std::uint32_t>;
    using Index = boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<16>>;

    std::vector<FaceTriangle> triangles;
    std::vector<int> face_of_triangle;
    std::vector<Border> borders;
    std::vector<Chord> chords;
    Index index;
};

Pieces pieces_of(const Design& design);

/// What evaluates the surfaces of the faces and the curves of the borders. OpenCASCADE's evaluation keeps a cache:
/// each thread needs its own.
class Evaluators {
  public:
    Evaluators(const Design& design, const Pieces& pieces);
    const BRepAdaptor_Surface& surface(int face);
    const BRepAdaptor_Curve& curve(std::uint32_t border);

    /// Outward unit normal of a face; zero where its surface has none.
    Eigen::Vector3d normal(int face, const Eigen::Vector2d& uv);
    /// Unit tangent of a border's curve.
    Eigen::Vector3d tangent(std::uint32_t border, double t);

  private:
    const Design& design_;
    const Pieces& pieces_;
    std::vector<std::unique_ptr<BRepAdaptor_Surface>> surfaces_;
    std::vector<std::unique_ptr<BRepAdaptor_Curve>> curves_;
};

} // namespace fettle::cad
