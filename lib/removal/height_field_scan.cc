#include "removal/height_field.h"

#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fettle {
namespace {

/// A scan may have pinholes; where more than this share of the anomaly has no surface, what to grind is not known.
constexpr double kPinholes = 0.01;

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

} // namespace

HeightField height_field(const Scan& scan, const Job& job, double cell, const std::string& source)
{
    const Polygon B = boundaries(job).anomaly;
    Eigen::Matrix2d box;
    box << B.rowwise().minCoeff(), B.rowwise().maxCoeff();

    HeightField field = empty_height_field(box, {job.wheel.width / 2, job.wheel.radius}, job.theta, cell);
    const Eigen::Matrix2d R_machine_working = rotation_working_machine(job.theta).transpose();
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, field.rows()), [&](const auto& range) {
        for (Eigen::Index j = range.begin(); j < range.end(); ++j)
            for (Eigen::Index i = 0; i < field.columns(); ++i)
                if (const auto z = scan.height(R_machine_working * field.centre(i, j))) field.z(i, j) = *z;
    });
    require_material(field, B, job.units, source);
    return field;
}

} // namespace fettle
