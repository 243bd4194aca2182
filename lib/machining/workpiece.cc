#include "machining/workpiece.h"

#include "core/error.h"
#include "machining/number_list.h"
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

std::size_t count_triangles(const HeightField& field)
{
    std::size_t count = 0;
    for (Eigen::Index j = 0; j + 1 < field.rows(); ++j)
        for (Eigen::Index i = 0; i + 1 < field.columns(); ++i) {
            const double diagonal = field.z(i, j) + field.z(i + 1, j + 1);
            count += !std::isnan(diagonal + field.z(i + 1, j));
            count += !std::isnan(diagonal + field.z(i, j + 1));
        }
    return count;
}

/// Parts of an STL that are made while others are written.
class StlParts {
  public:
    StlParts(const HeightField& field, Eigen::Index parts)
        : field_(&field), parts_(parts), bytes_(static_cast<std::size_t>(std::min(kPartsAtOnce, parts)))
    {
        // made once: fresh memory costs more than the triangles
        const std::size_t most = kStlTriangle * 2 * static_cast<std::size_t>(field.columns() * kRowsOfPart);
        for (Bytes& part : bytes_) part.data = std::make_unique_for_overwrite<char[]>(most);
    }
    void make(Eigen::Index begin)
    {
        tbb::parallel_for(std::size_t{0}, bytes_.size(), [&](std::size_t k) {
            bytes_[k].size = 0;
            const Eigen::Index part = begin + static_cast<Eigen::Index>(k), first = part * kRowsOfPart;
            if (part >= parts_) return;
            const Mesh mesh = surface_between(*field_, first, std::min(first + kRowsOfPart, field_->rows() - 1));
            bytes_[k].size = kStlTriangle * static_cast<std::size_t>(mesh.triangles.cols());
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
        std::size_t size = 0;
    };
    const HeightField* field_;
    Eigen::Index parts_;
    std::vector<Bytes> bytes_;
};

} // namespace

Workpiece box_workpiece(const std::string& corners, double cell)
{
    const auto numbers = numbers_of(corners, {"x0", "y0", "z0", "x1", "y1", "z1"});
    Eigen::Matrix2d box;
    box << numbers[0], numbers[3], numbers[1], numbers[4];
    if (!((box.col(1) - box.col(0)).minCoeff() > 0 && numbers[5] > numbers[2]))
        throw InputError("a box needs x0 < x1, y0 < y1 and z0 < z1, got " + corners);
    Workpiece piece{empty_height_field(box, {0, 0}, 0, cell), numbers[2]};
    HeightField& field = piece.stock;
    for (Eigen::Index j = 0; j < field.rows(); ++j)
        for (Eigen::Index i = 0; i < field.columns(); ++i)
            if ((field.centre(i, j).array() <= box.col(1).array()).all()) field.z(i, j) = numbers[5];
    return piece;
}

Workpiece scanned_workpiece(const Scan& scan, double cell)
{
    Workpiece piece{empty_height_field(scan.bounds().topRows<2>(), {0, 0}, 0, cell)};
    lay(piece.stock, scan);
    return piece;
}

Mesh surface_between(const HeightField& field, Eigen::Index first, Eigen::Index last)
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
    for (Eigen::Index j = 0; j + 1 < rows; ++j)
        for (Eigen::Index i = 0; i + 1 < columns; ++i) {
            const Eigen::Index at = j * columns + i, beyond = at + columns;
            add(at, at + 1, beyond + 1);
            add(at, beyond + 1, beyond);
        }
    mesh.triangles.conservativeResize(Eigen::NoChange, count);
    return mesh;
}

std::size_t write_stl(std::ostream& out, const HeightField& field)
{
    const std::size_t triangles = count_triangles(field);
    if (triangles > UINT32_MAX) throw InputError("too many triangles for an STL");
    out << stl_header(triangles, Units::Length::mm);
    const Eigen::Index parts = (std::max<Eigen::Index>(field.rows(), 1) - 1 + kRowsOfPart - 1) / kRowsOfPart;
    StlParts made(field, parts), next(field, parts);
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
