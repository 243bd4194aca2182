#include "machining/workpiece.h"

#include "core/error.h"
#include "machining/number_list.h"
#include "machining/refinement.h"
#include "machining/tilt.h"
#include "mesh/stl.h"

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <ostream>
#include <utility>
#include <vector>

namespace fettle {
namespace {

/// Rows that are made triangles at a time: some megabytes.
constexpr Eigen::Index kRowsOfPart = 16;
/// Parts in the making, whatever the number of threads.
constexpr Eigen::Index kPartsAtOnce = 16;

/// The sides of a box, outwards. @param numbers  least corner, greatest corner
Mesh box_mesh(const std::vector<double>& numbers)
{
    Mesh mesh;
    mesh.vertices.resize(3, 8);
    for (int k = 0; k < 8; ++k) // bits 0 to 2 of the number: greatest x, y, z
        for (int axis = 0; axis < 3; ++axis)
            mesh.vertices(axis, k) = numbers[static_cast<std::size_t>(axis + 3 * (k >> axis & 1))];
    mesh.triangles.resize(3, 12);
    mesh.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1, //
        2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,               //
        3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
    return mesh;
}

/// Corners of a triangle.
using Corners = Eigen::Matrix3d;

void add_triangle(std::vector<Corners>& triangles, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c)
{
    if (std::isnan(a.z() + b.z() + c.z())) return;
    triangles.emplace_back();
    triangles.back() << a, b, c;
}

/// The places around a square that has refined neighbours, counter-clockwise from its first corner.
std::vector<Eigen::Vector3d> around(const Refinement& map, Eigen::Index i, Eigen::Index j)
{
    struct Side {
        Eigen::Index i, j;      ///< of the neighbour
        int a, b, da, db;       ///< where the side begins in it, and how it goes on
        Eigen::Index corner[2]; ///< of the square, where the side begins
    };
    const int f = map.factor();
    const Side sides[] = {{i, j - 1, 0, f, 1, 0, {0, 0}},
                          {i + 1, j, 0, 0, 0, 1, {1, 0}},
                          {i, j + 1, f, 0, -1, 0, {1, 1}},
                          {i - 1, j, f, f, 0, -1, {0, 1}}};
    std::vector<Eigen::Vector3d> places;
    for (const Side& side : sides) {
        places.push_back(map.place(i + side.corner[0], j + side.corner[1], 0, 0));
        if (!map.refined(side.i, side.j)) continue;
        for (int k = 1; k < f; ++k) {
            const Eigen::Vector3d place = map.place(side.i, side.j, side.a + k * side.da, side.b + k * side.db);
            if (!std::isnan(place.z())) places.push_back(place);
        }
    }
    return places;
}

/// The triangles of a square that is refined, or next to one that is. @return  is it?
bool add_refined(std::vector<Corners>& triangles, const Refinement& map, Eigen::Index i, Eigen::Index j)
{
    if (map.refined(i, j)) {
        for (int b = 0; b < map.factor(); ++b)
            for (int a = 0; a < map.factor(); ++a) {
                const Eigen::Vector3d at = map.place(i, j, a, b), beyond = map.place(i, j, a + 1, b + 1);
                add_triangle(triangles, at, map.place(i, j, a + 1, b), beyond);
                add_triangle(triangles, at, beyond, map.place(i, j, a, b + 1));
            }
        return true;
    }
    if (!(map.refined(i - 1, j) || map.refined(i + 1, j) || map.refined(i, j - 1) || map.refined(i, j + 1)))
        return false;
    const auto places = around(map, i, j);
    const Eigen::Vector3d middle = (map.place(i, j, 0, 0) + map.place(i + 1, j, 0, 0) + map.place(i, j + 1, 0, 0) +
                                    map.place(i + 1, j + 1, 0, 0)) /
                                   4;
    for (std::size_t k = 0; k < places.size(); ++k)
        add_triangle(triangles, places[k], places[(k + 1) % places.size()], middle);
    return true;
}

std::size_t count_triangles(const HeightField& field, const Refinement* refinement)
{
    std::size_t count = 0;
    std::vector<Corners> finer;
    for (Eigen::Index j = 0; j + 1 < field.rows(); ++j)
        for (Eigen::Index i = 0; i + 1 < field.columns(); ++i) {
            if (refinement && add_refined(finer, *refinement, i, j)) {
                count += finer.size();
                finer.clear();
                continue;
            }
            const double diagonal = field.z(i, j) + field.z(i + 1, j + 1);
            count += !std::isnan(diagonal + field.z(i + 1, j));
            count += !std::isnan(diagonal + field.z(i, j + 1));
        }
    return count;
}

/// Parts of an STL that are made while others are written.
class StlParts {
  public:
    StlParts(const HeightField& field, const Refinement* refinement, const Eigen::Matrix3d& tilted, Eigen::Index parts)
        : field_(&field), refinement_(refinement), R_machine_tilted_(tilted.transpose()), parts_(parts),
          bytes_(static_cast<std::size_t>(std::min(kPartsAtOnce, parts)))
    {
    }
    void make(Eigen::Index begin)
    {
        tbb::parallel_for(std::size_t{0}, bytes_.size(), [&](std::size_t k) {
            bytes_[k].size = 0;
            const Eigen::Index part = begin + static_cast<Eigen::Index>(k), first = part * kRowsOfPart;
            if (part >= parts_) return;
            const Mesh mesh =
                turned(surface_between(*field_, first, std::min(first + kRowsOfPart, field_->rows() - 1), refinement_),
                       R_machine_tilted_);
            bytes_[k].size = kStlTriangle * static_cast<std::size_t>(mesh.triangles.cols());
            if (bytes_[k].room < bytes_[k].size) { // seldom: fresh memory costs more than the triangles
                bytes_[k].room = bytes_[k].size;
                bytes_[k].data = std::make_unique_for_overwrite<char[]>(bytes_[k].room);
            }
            put_stl_triangles(mesh, Units::Length::mm, bytes_[k].data.get());
        });
    }
    void write(std::ostream& out) const
    {
        for (const Bytes& part : bytes_) out.write(part.data.get(), static_cast<std::streamsize>(part.size));
    }

  private:
    struct Bytes {
        std::unique_ptr<char[]> data;
        std::size_t size = 0, room = 0;
    };
    const HeightField* field_;
    const Refinement* refinement_;
    Eigen::Matrix3d R_machine_tilted_;
    Eigen::Index parts_;
    std::vector<Bytes> bytes_;
};

} // namespace

Workpiece box_workpiece(const std::string& corners, double cell, const Eigen::Matrix3d& rotation_tilted_machine)
{
    const auto numbers = numbers_of(corners, {"x0", "y0", "z0", "x1", "y1", "z1"});
    Eigen::Matrix2d box;
    box << numbers[0], numbers[3], numbers[1], numbers[4];
    if (!((box.col(1) - box.col(0)).minCoeff() > 0 && numbers[5] > numbers[2]))
        throw InputError("a box needs x0 < x1, y0 < y1 and z0 < z1, got " + corners);
    if (!rotation_tilted_machine.isIdentity(0))
        return scanned_workpiece(Scan(turned(box_mesh(numbers), rotation_tilted_machine)), cell);
    Workpiece piece{empty_height_field(box, {0, 0}, 0, cell), numbers[2]};
    piece.lay = [box, top = numbers[5]](HeightField& field) {
        for (Eigen::Index j = 0; j < field.rows(); ++j)
            for (Eigen::Index i = 0; i < field.columns(); ++i) {
                const Eigen::Array2d at = field.centre(i, j).array();
                if ((at >= box.col(0).array()).all() && (at <= box.col(1).array()).all()) field.z(i, j) = top;
            }
    };
    piece.lay(piece.stock);
    return piece;
}

Workpiece scanned_workpiece(Scan scan, double cell)
{
    Workpiece piece{empty_height_field(scan.bounds().topRows<2>(), {0, 0}, 0, cell)};
    piece.lay = [shared = std::make_shared<const Scan>(std::move(scan))](HeightField& field) {
        fettle::lay(field, *shared);
    };
    piece.lay(piece.stock);
    return piece;
}

Mesh surface_between(const HeightField& field, Eigen::Index first, Eigen::Index last, const Refinement* refinement)
{
    const Eigen::Index columns = field.columns(), rows = last - first + 1;
    Mesh mesh;
    mesh.vertices.resize(3, columns * rows);
    for (Eigen::Index j = 0; j < rows; ++j)
        for (Eigen::Index i = 0; i < columns; ++i)
            mesh.vertices.col(j * columns + i) << field.centre(i, first + j), field.z(i, first + j);
    mesh.triangles.resize(3, 2 * (columns - 1) * (rows - 1));
    Eigen::Index count = 0;
    const auto add = [&](Eigen::Index a, Eigen::Index b, Eigen::Index c) {
        if (std::isnan(mesh.vertices(2, a) + mesh.vertices(2, b) + mesh.vertices(2, c))) return;
        mesh.triangles.col(count++) << static_cast<int>(a), static_cast<int>(b), static_cast<int>(c);
    };
    std::vector<Corners> finer;
    for (Eigen::Index j = 0; j + 1 < rows; ++j)
        for (Eigen::Index i = 0; i + 1 < columns; ++i) {
            if (refinement && add_refined(finer, *refinement, i, first + j)) continue;
            const Eigen::Index at = j * columns + i, beyond = at + columns;
            add(at, at + 1, beyond + 1);
            add(at, beyond + 1, beyond);
        }
    const auto more = static_cast<Eigen::Index>(finer.size());
    mesh.triangles.conservativeResize(Eigen::NoChange, count + more);
    Eigen::Index vertex = mesh.vertices.cols();
    mesh.vertices.conservativeResize(Eigen::NoChange, vertex + 3 * more);
    for (const Corners& corners : finer) {
        mesh.triangles.col(count++) =
            Eigen::Vector3i::LinSpaced(static_cast<int>(vertex), static_cast<int>(vertex) + 2);
        mesh.vertices.middleCols<3>(vertex) = corners;
        vertex += 3;
    }
    return mesh;
}

std::size_t write_stl(std::ostream& out, const HeightField& field, const Refinement* refinement,
                      const Eigen::Matrix3d& tilted)
{
    const std::size_t triangles = count_triangles(field, refinement);
    if (triangles > UINT32_MAX) throw InputError("too many triangles for an STL");
    out << stl_header(triangles, Units::Length::mm);
    const Eigen::Index parts = (std::max<Eigen::Index>(field.rows(), 1) - 1 + kRowsOfPart - 1) / kRowsOfPart;
    StlParts made(field, refinement, tilted, parts), next(field, refinement, tilted, parts);
    made.make(0);
    for (Eigen::Index begin = 0; begin < parts; begin += kPartsAtOnce) {
        tbb::task_group making;
        making.run([&] { next.make(begin + kPartsAtOnce); });
        made.write(out);
        making.wait();
        std::swap(made, next);
    }
    return triangles;
}

} // namespace fettle
