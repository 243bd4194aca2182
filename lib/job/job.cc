#include "job/job.h"

#include "core/constants.h"
#include "core/text.h"
#include "job/boundary.h"
#include "json/units.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

using json::Reader;
using json::Value;

// A kilometre: no table is larger, and squares of it stay far from overflow.
constexpr double kLargestCoordinate = 1e6;

// What is divided by less overflows.
constexpr double kLeastQuantity = 1e-100;

// Defaults that follow from another member.
constexpr double kStepOverPerWidth = 0.8;        // neighbouring passes overlap by a fifth
constexpr double kLeastRadiusPerRadius = 0.5;    // a wheel is used up at half its radius
constexpr double kClearanceAboveBoundary = 50.8; // 2 in, for travelling

// A number in the file's unit, or the default, which is in base units already.
double quantity(Reader& reader, const std::string& key, double otherwise, double unit, const Range& range)
{
    const double number = reader.number_or(key, kNaN, range);
    const double value = std::isnan(number) ? otherwise : number * unit;
    if (std::abs(number) > 0 && std::abs(value) < kLeastQuantity) // NaN: not given
        reader.refuse(key, "too small: " + to_text(number));
    return value;
}

Eigen::Matrix3Xd boundary_points(Reader& reader, const std::string& key, double unit)
{
    const Eigen::MatrixXd rows = reader.ragged(key, 2, 3) * unit;
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Constant(3, rows.rows(), kNaN);
    if (rows.rows() > 0) points.topRows(rows.cols()) = rows.transpose();
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        for (Eigen::Index k = 0; k < 3; ++k)
            if (std::abs(points(k, i)) > kLargestCoordinate)
                reader.refuse(key + "[" + std::to_string(i) + "][" + std::to_string(k) + "]",
                              "no casting reaches that far: " + to_text(points(k, i) / unit));
    return points;
}

Units parse_units(Reader reader, bool forces_matter)
{
    Units units;
    units.length = parse_length_unit(reader.choice("length", {"mm", "in"}));
    const std::string force =
        forces_matter ? reader.choice("force", {"N", "lbf"}) : reader.choice_or("force", "N", {"N", "lbf"});
    units.force = parse_force_unit(force);
    reader.done();
    return units;
}

void parse_surface_type(Reader reader, Job& job)
{
    const std::string type = reader.choice("type", {"plane", "swept", "freeform"});
    job.surface = type == "plane" ? SurfaceType::plane : type == "swept" ? SurfaceType::swept : SurfaceType::freeform;
    if (job.surface == SurfaceType::swept) job.direction = reader.number("direction_deg") * kRadPerDegree;
    reader.done();
}

void parse_probe(Reader reader, double mm, Probe& probe)
{
    probe.accuracy = quantity(reader, "accuracy", probe.accuracy, mm, Range::positive());
    probe.tip_radius = quantity(reader, "tip_radius", probe.tip_radius, mm, Range::at_least(0));
    reader.done();
}

void parse_wheel(Reader reader, double mm, GrindingWheel& wheel)
{
    wheel.radius = quantity(reader, "radius", wheel.radius, mm, Range::positive());
    wheel.width = quantity(reader, "width", wheel.width, mm, Range::positive());
    wheel.min_radius = quantity(reader, "min_radius", kLeastRadiusPerRadius * wheel.radius, mm, Range::positive());
    if (wheel.min_radius > wheel.radius)
        reader.refuse("min_radius", "must be at most the radius, " + to_short_text(wheel.radius / mm) + ", got " +
                                        to_short_text(wheel.min_radius / mm));
    reader.done();
}

void parse_force(Reader reader, const Units& units, ForceRange& force)
{
    const double newton = units.newton();
    force.min = quantity(reader, "min", force.min, newton, Range::at_least(0));
    force.max = quantity(reader, "max", force.max, newton, Range::positive());
    if (force.min >= force.max)
        reader.refuse("max", "must be above min, " + to_short_text(force.min / newton) + ", got " +
                                 to_short_text(force.max / newton));
    force.down = quantity(reader, "down", (force.min + force.max) / 2, newton, Range::positive());
    if (force.down < force.min || force.down >= force.max)
        reader.refuse("down", "must lie between min and max, " + to_short_text(force.min / newton) + " and " +
                                  to_short_text(force.max / newton) + ", got " + to_short_text(force.down / newton));
    force.stiffness = quantity(reader, "stiffness", force.stiffness, to_base(units, {-1, 1}), Range::positive());
    force.preload = quantity(reader, "preload", force.preload, newton, Range::at_least(0));
    if (force.preload >= force.max)
        reader.refuse("preload", "must be below max, " + to_short_text(force.max / newton) + ", got " +
                                     to_short_text(force.preload / newton));
    reader.done();
}

void parse_feed(Reader reader, double mm, double width, Feed& feed)
{
    feed.axis = reader.choice_or("axis", std::string(1, feed.axis), {"x", "y"})[0];
    feed.rate = quantity(reader, "rate", feed.rate, mm, Range::positive());
    feed.step_over = quantity(reader, "step_over", kStepOverPerWidth * width, mm, Range::positive());
    if (feed.step_over > width)
        reader.refuse("step_over", "wider than the wheel, " + to_short_text(width / mm) + ": " +
                                       to_short_text(feed.step_over / mm) + " leaves ridges");
    reader.done();
}

double highest(const Job& job)
{
    double z = -std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3Xd& points : {job.anomaly, job.sampling})
        for (Eigen::Index i = 0; i < points.cols(); ++i) z = std::fmax(z, points(2, i)); // fmax passes NaN over
    return std::isfinite(z) ? z : 0;
}

// 15 digits: what a change of units and back spoils is rounded off, so that numbers come back as they were written.
double cleaned(double number)
{
    if (!std::isfinite(number)) return number;
    char text[40];
    const auto written = std::to_chars(text, text + sizeof text, number, std::chars_format::scientific, 14);
    double value = number;
    std::from_chars(text, written.ptr, value);
    return value;
}

Value points_to_json(const Eigen::Matrix3Xd& points, double unit)
{
    std::vector<Value> rows;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::VectorXd row = points.col(i).head(std::isnan(points(2, i)) ? 2 : 3) / unit;
        rows.emplace_back(Eigen::VectorXd(row.unaryExpr(&cleaned)));
    }
    return rows;
}

} // namespace

std::string to_string(SurfaceType type)
{
    return type == SurfaceType::plane ? "plane" : type == SurfaceType::swept ? "swept" : "freeform";
}

Eigen::Matrix2d rotation_working_machine(double theta)
{
    const double c = std::cos(theta), s = std::sin(theta);
    return (Eigen::Matrix2d() << c, s, -s, c).finished();
}

Job read_job(const std::string& path) { return parse_job(Reader::open(path)); }

Job parse_job(Reader reader)
{
    Job job;
    job.source = reader.source();
    reader.expect_kind("job");
    job.units = parse_units(reader.object("units"), reader.has("force") || reader.has("removal"));
    const double mm = job.units.mm();

    if (auto frame = reader.object_or_none("frame")) {
        job.theta = frame->number_or("theta_deg", 0) * kRadPerDegree;
        frame->done();
    }
    parse_surface_type(reader.object("surface"), job);
    job.anomaly = boundary_points(reader, "anomaly", mm);
    if (reader.has("sampling") || job.surface != SurfaceType::plane)
        job.sampling = boundary_points(reader, "sampling", mm);
    if (auto probe = reader.object_or_none("probe")) parse_probe(*probe, mm, job.probe);
    job.tolerance = quantity(reader, "tolerance", job.tolerance, mm, Range::positive());
    job.safe_height = quantity(reader, "safe_height", highest(job) + kClearanceAboveBoundary, mm, {});
    if (auto wheel = reader.object_or_none("wheel")) parse_wheel(*wheel, mm, job.wheel);
    if (auto force = reader.object_or_none("force")) parse_force(*force, job.units, job.force);
    job.feed.step_over = kStepOverPerWidth * job.wheel.width;
    if (auto feed = reader.object_or_none("feed")) parse_feed(*feed, mm, job.wheel.width, job.feed);
    if (auto removal = reader.object_or_none("removal")) {
        job.removal = quantity(*removal, "coefficient", job.removal, to_base(job.units, {3, -1}), Range::positive());
        removal->done();
    }
    reader.done();
    boundaries(job); // refuses what is no pair of polygons
    return job;
}

Value to_json(const Job& job)
{
    const double mm = job.units.mm();
    const double newton = job.units.newton();
    const auto in = [](double value, double unit) { return Value(cleaned(value / unit)); };

    Value surface;
    surface.set("type", to_string(job.surface));
    if (job.surface == SurfaceType::swept) surface.set("direction_deg", in(job.direction, kRadPerDegree));

    Value value;
    value.set("kind", "job")
        .set("units", json::to_json(job.units))
        .set("frame", Value().set("theta_deg", in(job.theta, kRadPerDegree)))
        .set("surface", surface)
        .set("anomaly", points_to_json(job.anomaly, mm));
    if (job.sampling.cols() > 0) value.set("sampling", points_to_json(job.sampling, mm));
    value
        .set("probe",
             Value().set("accuracy", in(job.probe.accuracy, mm)).set("tip_radius", in(job.probe.tip_radius, mm)))
        .set("tolerance", in(job.tolerance, mm))
        .set("safe_height", in(job.safe_height, mm))
        .set("wheel", Value()
                          .set("radius", in(job.wheel.radius, mm))
                          .set("width", in(job.wheel.width, mm))
                          .set("min_radius", in(job.wheel.min_radius, mm)))
        .set("force", Value()
                          .set("min", in(job.force.min, newton))
                          .set("down", in(job.force.down, newton))
                          .set("max", in(job.force.max, newton))
                          .set("stiffness", in(job.force.stiffness, to_base(job.units, {-1, 1})))
                          .set("preload", in(job.force.preload, newton)))
        .set("feed", Value()
                         .set("axis", std::string(1, job.feed.axis))
                         .set("rate", in(job.feed.rate, mm))
                         .set("step_over", in(job.feed.step_over, mm)))
        .set("removal", Value().set("coefficient", in(job.removal, to_base(job.units, {3, -1}))));
    return value;
}

} // namespace fettle
