#include "removal/height_field.h"

#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"
#include "mesh/facet_from_above.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fettle {
namespace {

/// A scan may have pinholes; where more than this share of the anomaly has no surface, what to grind is not known.
constexpr double kPinholes = 0.01;

/// A cell's centre may lie this far from a triangle and yet, by rounding, in it; rounding is about 1e-12 of a cell.
constexpr double kSlack = 1e-6; // of a cell
/// Rows that one thread fills at a time.
constexpr Eigen::Index kRowsOfBand = 32;

using CellRange = std::pair<Eigen::Index, Eigen::Index>; ///< first and end; empty unless first < end

/// The cells of a line of `count` whose centres lie from `least` to `most`.
CellRange cells_between(double least, double most, Eigen::Index count)
{
    const auto bounded = [count](double cell) { // NaN, of coordinates that overflow, gives no cells
        return cell > 0 ? static_cast<Eigen::Index>(std::min(cell, static_cast<double>(count))) : 0;
    };
    return {bounded(std::ceil(least - kSlack)), bounded(std::floor(most + kSlack) + 1)};
}

/// A triangle over cells: the centre of cell (i, j) is the point (i, j).
class FacetOverCells {
  public:
    FacetOverCells(const Eigen::Matrix2Xd& places, const Eigen::Vector3i& corners)
    {
        for (int k = 0; k < 3; ++k) {
            edges_[k] = {places.col(corners[k]), places.col(corners[(k + 1) % 3]), 0};
            auto& [low, high, slope] = edges_[k];
            if (low.y() > high.y()) std::swap(low, high);
            if (low.y() < high.y()) slope = (high.x() - low.x()) / (high.y() - low.y());
        }
    }

    CellRange rows(Eigen::Index count) const
    {
        return cells_between(std::min({edges_[0].low.y(), edges_[1].low.y(), edges_[2].low.y()}),
                             std::max({edges_[0].high.y(), edges_[1].high.y(), edges_[2].high.y()}), count);
    }

    /// Columns of the part of the triangle that lies in a row, give or take kSlack.
    CellRange columns(Eigen::Index row, Eigen::Index count) const
    {
        const double below = static_cast<double>(row) - kSlack, above = static_cast<double>(row) + kSlack;
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (const auto& [low, high, slope] : edges_) {
            if (low.y() > above || high.y() < below) continue;
            const double enters = low.x() + (std::max(below, low.y()) - low.y()) * slope;
            const double leaves = low.x() + (std::min(above, high.y()) - low.y()) * slope;
            least = std::min({least, enters, leaves});
            most = std::max({most, enters, leaves});
        }
        return cells_between(least, most, count);
    }

  private:
    struct Edge {
        Eigen::Vector2d low, high;
        double slope; ///< dx / dy; a level edge has none: its ends belong to the other two, too
    };
    Edge edges_[3];
};

/// The highest z of the mesh over each cell's centre: as a ray meets it, but triangle by triangle.
void lay_mesh(HeightField& field, const Mesh& mesh)
{
    const Eigen::Matrix2d R_working_machine = rotation_working_machine(field.theta);
    const Eigen::Matrix2d R_machine_working = R_working_machine.transpose();
    const Eigen::Matrix2Xd places =
        (((R_working_machine * mesh.vertices.topRows<2>()).colwise() - field.origin) / field.cell).array() - 0.5;

    std::vector<std::vector<Eigen::Index>> bands(static_cast<std::size_t>(field.rows() / kRowsOfBand + 1));
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const auto [first, end] = FacetOverCells(places, mesh.triangles.col(t)).rows(field.rows());
        for (Eigen::Index j = first; j < end; j = (j / kRowsOfBand + 1) * kRowsOfBand)
            bands[static_cast<std::size_t>(j / kRowsOfBand)].push_back(t);
    }
    tbb::parallel_for(std::size_t{0}, bands.size(), [&](std::size_t band) {
        const Eigen::Index begin = static_cast<Eigen::Index>(band) * kRowsOfBand;
        for (const Eigen::Index t : bands[band]) {
            const FacetFromAbove facet(mesh, t);
            const FacetOverCells cells(places, mesh.triangles.col(t));
            const auto [first_row, end_row] = cells.rows(field.rows());
            for (Eigen::Index j = std::max(first_row, begin); j < std::min(end_row, begin + kRowsOfBand); ++j) {
                const auto [first, end] = cells.columns(j, field.columns());
                for (Eigen::Index i = first; i < end; ++i) {
                    const auto z = facet.height(R_machine_working * field.centre(i, j));
                    if (z && !(field.z(i, j) >= *z)) field.z(i, j) = *z;
                }
            }
        }
    });
}

/// The same over a cloud, whose surface is found cell by cell. Beside the walls that a wheel leaves it has none, but a
/// ground part has a point in each cell.
void lay_cloud(HeightField& field, const Scan& cloud)
{
    const Eigen::Matrix2d R_machine_working = rotation_working_machine(field.theta).transpose();
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, field.rows()), [&](const auto& range) {
        for (Eigen::Index j = range.begin(); j < range.end(); ++j)
            for (Eigen::Index i = 0; i < field.columns(); ++i) {
                const Eigen::Vector2d xy = R_machine_working * field.centre(i, j);
                auto z = cloud.height(xy);
                if (!z) z = cloud.highest_point(xy, field.cell / 2);
                if (z) field.z(i, j) = *z;
            }
    });
}

/// @throws InputError if the field has a hole inside B
void require_material(const HeightField& field, const Polygon& B, const Units& units, const std::string& source)
{
    const auto first_centre = [&](double x) { // index of the first centre from x on
        const double column = std::ceil((x - field.origin.x()) / field.cell - 0.5);
        return static_cast<Eigen::Index>(std::clamp(column, 0.0, static_cast<double>(field.columns())));
    };
    Eigen::Index cells = 0, missing = 0;
    Eigen::Vector2d place;
    for (Eigen::Index j = 0; j < field.rows(); ++j)
        for (const auto& [from, to] : inside(B, {0, field.centre(0, j).y()}, Eigen::Vector2d::UnitX()))
            for (Eigen::Index i = first_centre(from); i < first_centre(to); ++i) {
                ++cells;
                if (!std::isnan(field.z(i, j))) continue;
                if (missing++ == 0) place = rotation_working_machine(field.theta).transpose() * field.centre(i, j);
            }
    if (static_cast<double>(missing) <= kPinholes * static_cast<double>(cells)) return;
    const double unit = units.mm();
    const auto number = [unit](double mm) { return to_text(std::round(mm / unit * 1000) / 1000); };
    throw InputError(source, "no surface over " +
                                 to_text(std::ceil(100 * static_cast<double>(missing) / static_cast<double>(cells))) +
                                 " % of the anomaly, first at x " + number(place.x()) + ", y " + number(place.y()));
}

HeightField field_around(const Polygon& region, const Job& job, double cell)
try {
    Eigen::Matrix2d box;
    box << region.rowwise().minCoeff(), region.rowwise().maxCoeff();
    return empty_height_field(box, {job.wheel.width / 2, job.wheel.radius}, job.theta, cell);
} catch (const InputError& error) {
    throw InputError(job.source, error.what());
}

} // namespace

void lay(HeightField& field, const Scan& scan)
{
    if (const Mesh* mesh = scan.mesh())
        lay_mesh(field, *mesh);
    else
        lay_cloud(field, scan);
}

HeightField height_field(const Scan& scan, const Job& job, double cell, const std::string& source, Extent extent)
{
    const auto [B, S] = boundaries(job);
    HeightField field = field_around(extent == Extent::sampling && S.size() > 0 ? S : B, job, cell);
    lay(field, scan);
    require_material(field, B, job.units, source);
    return field;
}

} // namespace fettle
