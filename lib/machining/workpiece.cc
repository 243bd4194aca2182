#include "machining/workpiece.h"

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "machining/limits.h"
#include "machining/refinement.h"
#include "machining/tilt.h"
#include "mesh/shape_file.h"
#include "mesh/stl.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <ostream>
#include <utility>
#include <vector>

namespace fettle::machining {
namespace {

/// Rows triangulated in one chunk: some megabytes of STL.
constexpr Eigen::Index kRowsPerChunk = 16;
/// Chunks triangulated in parallel, whatever the number of threads.
constexpr Eigen::Index kParallelChunks = 16;

/// The sides of a box, oriented outwards. @param numbers  x, y, z of the minimum corner, then of the maximum corner
mesh::Mesh box_mesh(const Eigen::VectorXd& numbers)
{
    mesh::Mesh mesh;
    mesh.vertices.resize(3, 8);
    for (int k = 0; k < 8; ++k) // bits 0 to 2 of k: maximum x, y, z
        for (int axis = 0; axis < 3; ++axis) mesh.vertices(axis, k) = numbers[axis + 3 * (k >> axis & 1)];
    mesh.triangles.resize(3, 12);
    mesh.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1, //
        2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,               //
        3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
    return mesh;
}

using Corners = Eigen::Matrix3d; ///< columns: corners of a triangle, mm

void add_triangle(std::vector<Corners>& triangles, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c)
{
    if (std::isnan(a.z() + b.z() + c.z())) return;
    triangles.emplace_back();
    triangles.back() << a, b, c;
}

/// The vertices on the border of a square with refined neighbours, counter-clockwise from its first corner.
std::vector<Eigen::Vector3d> border_vertices(const Refinement& fine, Eigen::Index i, Eigen::Index j)
{
    struct Side {
        Eigen::Index i, j;      ///< the neighbour
        int a, b, da, db;       ///< start and direction of the side in the neighbour's fine grid
        Eigen::Index corner[2]; ///< corner of the square where the side starts
    };
    const int f = fine.factor();
    const Side sides[] = {{i, j - 1, 0, f, 1, 0, {0, 0}},
                          {i + 1, j, 0, 0, 0, 1, {1, 0}},
                          {i, j + 1, f, 0, -1, 0, {1, 1}},
                          {i - 1, j, f, f, 0, -1, {0, 1}}};
    std::vector<Eigen::Vector3d> vertices;
    for (const Side& side : sides) {
        vertices.push_back(fine.point(i + side.corner[0], j + side.corner[1], 0, 0));
        if (!fine.is_refined(side.i, side.j)) continue;
        for (int k = 1; k < f; ++k) {
            const Eigen::Vector3d vertex = fine.point(side.i, side.j, side.a + k * side.da, side.b + k * side.db);
            if (!std::isnan(vertex.z())) vertices.push_back(vertex);
        }
    }
    return vertices;
}

/// Adds the triangles of a square that is refined or next to a refined one. @return  whether it is
bool add_refined(std::vector<Corners>& triangles, const Refinement& fine, Eigen::Index i, Eigen::Index j)
{
    if (fine.is_refined(i, j)) {
        for (int b = 0; b < fine.factor(); ++b)
            for (int a = 0; a < fine.factor(); ++a) {
                const Eigen::Vector3d corner = fine.point(i, j, a, b), opposite = fine.point(i, j, a + 1, b + 1);
                add_triangle(triangles, corner, fine.point(i, j, a + 1, b), opposite);
                add_triangle(triangles, corner, opposite, fine.point(i, j, a, b + 1));
            }
        return true;
    }
    if (!(fine.is_refined(i - 1, j) || fine.is_refined(i + 1, j) || fine.is_refined(i, j - 1) ||
          fine.is_refined(i, j + 1)))
        return false;
    const auto border = border_vertices(fine, i, j);
    const Eigen::Vector3d middle = (fine.point(i, j, 0, 0) + fine.point(i + 1, j, 0, 0) + fine.point(i, j + 1, 0, 0) +
                                    fine.point(i + 1, j + 1, 0, 0)) /
                                   4;
    for (std::size_t k = 0; k < border.size(); ++k)
        add_triangle(triangles, border[k], border[(k + 1) % border.size()], middle);
    return true;
}

std::size_t count_triangles(const removal::HeightField& field, const Refinement* refinement)
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

/// Double buffering: chunks of an STL are triangulated while the previous ones are written.
class StlChunks {
  public:
    StlChunks(const removal::HeightField& field, const Refinement* refinement, const Eigen::Matrix3d& tilted,
              Eigen::Index chunk_count)
        : field_(&field), refinement_(refinement), R_machine_tilted_(tilted.transpose()), chunk_count_(chunk_count),
          buffers_(std::min(kParallelChunks, chunk_count))
    {
    }
    void triangulate(Eigen::Index begin)
    {
        tbb::parallel_for(std::size_t{0}, buffers_.size(), [&](std::size_t k) {
            Buffer& buffer = buffers_[k];
            buffer.size = 0;
            const Eigen::Index chunk = begin + k, first = chunk * kRowsPerChunk;
            if (chunk >= chunk_count_) return;
            const Eigen::Index last = std::min(first + kRowsPerChunk, field_->rows() - 1);
            const mesh::Mesh mesh = rotated(triangulate_rows(*field_, first, last, refinement_), R_machine_tilted_);
            buffer.size = mesh::kStlTriangleBytes * mesh.triangles.cols();
            if (buffer.capacity < buffer.size) { // seldom: page faults of new memory cost more than the triangles
                buffer.capacity = buffer.size;
                buffer.data = std::make_unique_for_overwrite<char[]>(buffer.capacity);
            }
            mesh::encode_stl_triangles(mesh, units::Units::Length::mm, buffer.data.get());
        });
    }
    void write(std::ostream& out) const
    {
        for (const Buffer& buffer : buffers_) out.write(buffer.data.get(), buffer.size);
    }

  private:
    struct Buffer {
        std::unique_ptr<char[]> data;
        std::size_t size = 0, capacity = 0;
    };
    const removal::HeightField* field_;
    const Refinement* refinement_;
    Eigen::Matrix3d R_machine_tilted_;
    Eigen::Index chunk_count_;
    std::vector<Buffer> buffers_;
};

} // namespace

Workpiece box_workpiece(const std::string& corners, double cell, const Eigen::Matrix3d& rotation_tilted_machine)
{
    const Eigen::VectorXd numbers = core::parse_number_list(corners, {"x0", "y0", "z0", "x1", "y1", "z1"});
    for (const double number : numbers)
        require_within("a corner's coordinate", number, core::Range::between(-kLengthRange.max, kLengthRange.max));
    const Eigen::AlignedBox2d box(Eigen::Vector2d(numbers[0], numbers[1]), Eigen::Vector2d(numbers[3], numbers[4]));
    if (!(box.sizes().minCoeff() > 0 && numbers[5] > numbers[2]))
        throw core::InputError("a box needs x0 < x1, y0 < y1 and z0 < z1, got " + corners);
    if (!rotation_tilted_machine.isIdentity(0))
        return scanned_workpiece(sampling::Scan(rotated(box_mesh(numbers), rotation_tilted_machine)), cell);
    Workpiece piece{removal::empty_height_field(box, {0, 0}, 0, cell), numbers[2]};
    piece.rasterize = [box, top = numbers[5]](removal::HeightField& field) {
        for (Eigen::Index j = 0; j < field.rows(); ++j)
            for (Eigen::Index i = 0; i < field.columns(); ++i)
                if (box.contains(field.centre(i, j))) field.z(i, j) = top;
    };
    piece.rasterize(piece.stock);
    piece.size = numbers.tail<3>() - numbers.head<3>();
    return piece;
}

Workpiece scanned_workpiece(sampling::Scan scan, double cell)
{
    const Eigen::AlignedBox2d box(scan.bounds().min().head<2>(), scan.bounds().max().head<2>());
    Workpiece piece{removal::empty_height_field(box, {0, 0}, 0, cell)};
    piece.size = scan.bounds().sizes();
    piece.rasterize = [shared = std::make_shared<const sampling::Scan>(std::move(scan))](removal::HeightField& field) {
        fettle::removal::rasterize(field, *shared);
    };
    piece.rasterize(piece.stock);
    return piece;
}

mesh::Mesh triangulate_rows(const removal::HeightField& field, Eigen::Index first, Eigen::Index last,
                            const Refinement* refinement)
{
    const Eigen::Index columns = field.columns(), rows = last - first + 1;
    mesh::Mesh mesh;
    mesh.vertices.resize(3, columns * rows);
    for (Eigen::Index j = 0; j < rows; ++j)
        for (Eigen::Index i = 0; i < columns; ++i)
            mesh.vertices.col(j * columns + i) << field.centre(i, first + j), field.z(i, first + j);
    mesh.triangles.resize(3, 2 * (columns - 1) * (rows - 1));
    Eigen::Index count = 0;
    const auto add = [&](Eigen::Index a, Eigen::Index b, Eigen::Index c) {
        if (std::isnan(mesh.vertices(2, a) + mesh.vertices(2, b) + mesh.vertices(2, c))) return;
        mesh.triangles.col(count++) = Eigen::Vector3i(a, b, c);
    };
    std::vector<Corners> finer;
    for (Eigen::Index j = 0; j + 1 < rows; ++j)
        for (Eigen::Index i = 0; i + 1 < columns; ++i) {
            if (refinement && add_refined(finer, *refinement, i, first + j)) continue;
            const Eigen::Index corner = j * columns + i, above = corner + columns;
            add(corner, corner + 1, above + 1);
            add(corner, above + 1, above);
        }
    const Eigen::Index more = finer.size();
    mesh.triangles.conservativeResize(Eigen::NoChange, count + more);
    Eigen::Index vertex = mesh.vertices.cols();
    mesh.vertices.conservativeResize(Eigen::NoChange, vertex + 3 * more);
    for (const Corners& corners : finer) {
        const int first_corner = vertex;
        mesh.triangles.col(count++) << first_corner, first_corner + 1, first_corner + 2;
        mesh.vertices.middleCols<3>(vertex) = corners;
        vertex += 3;
    }
    return mesh;
}

std::size_t write_stl(std::ostream& out, const removal::HeightField& field, const Refinement* refinement,
                      const Eigen::Matrix3d& tilted)
{
    const std::size_t triangles = count_triangles(field, refinement);
    if (triangles > UINT32_MAX) throw core::InputError("too many triangles for an STL");
    out << mesh::make_stl_header(triangles, units::Units::Length::mm);
    const Eigen::Index chunks = (std::max<Eigen::Index>(field.rows(), 1) - 1 + kRowsPerChunk - 1) / kRowsPerChunk;
    StlChunks ready(field, refinement, tilted, chunks), next(field, refinement, tilted, chunks);
    ready.triangulate(0);
    for (Eigen::Index begin = 0; begin < chunks; begin += kParallelChunks) {
        tbb::task_group background;
        background.run([&] { next.triangulate(begin + kParallelChunks); });
        ready.write(out);
        background.wait();
        std::swap(ready, next);
    }
    return triangles;
}

Workpiece read_workpiece(const std::string& stock, const std::optional<units::Units::Length>& unit, double cell,
                         const Eigen::Matrix3d& rotation_tilted_machine)
{
    constexpr std::string_view kBox = "box:";
    if (stock.starts_with(kBox)) {
        if (unit) throw core::InputError("a box is in mm; --stock-units belongs to a file");
        return box_workpiece(stock.substr(kBox.size()), cell, rotation_tilted_machine);
    }
    mesh::ShapeFile file = mesh::read_shape(stock, units::Units{unit.value_or(units::Units::Length::mm)});
    std::string warning;
    if (const auto* mesh = std::get_if<mesh::Mesh>(&file.shape))
        warning = repair_warning(file.repair, mesh->triangles.cols(), core::display_name(stock));
    const auto rasterized = [&](auto& shape) {
        return scanned_workpiece(sampling::Scan(rotated(std::move(shape), rotation_tilted_machine)), cell);
    };
    Workpiece piece = std::visit(rasterized, file.shape);
    piece.warning = warning;
    return piece;
}

PartMesh read_machined_surface(const std::string& path, const std::optional<units::Units::Length>& unit,
                               const std::optional<double>& step, const Eigen::Matrix3d& rotation_tilted_machine)
{
    PartMesh part = read_part_mesh(path, unit, rotation_tilted_machine);
    if (!step) return part;
    core::with_error_prefix("--step", [&] {
        const removal::HeightField field = scanned_workpiece(sampling::Scan(std::move(part.mesh)), *step).stock;
        part.mesh = triangulate_rows(field, 0, field.rows() - 1);
    });
    return part;
}

} // namespace fettle::machining
