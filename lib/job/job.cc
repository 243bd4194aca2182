#include "job/job.h"

#include "core/constants.h"
#include "core/text.h"
#include "job/boundary.h"
#include "json/units.h"

#include <charconv>
#include <cmath>
#include <utility>

namespace fettle::job {

namespace {

using json::Reader;
using json::Value;

// 1 km in mm: no machine table is larger, and squares of it stay far from overflow.
constexpr double kMaxCoordinate = 1e6;

// Radii and widths of wheels: dental ones have tenths of a mm, grindstones two metres. The stock's cells follow from
// them.
constexpr double kMinWheelSize = 0.01, kMaxWheelSize = 1e4; // mm

// A smaller quantity as a divisor causes overflow.
constexpr double kMinQuantity = 1e-100;

// Defaults that depend on another member.
constexpr double kStepOverPerWidth = 0.8;   // adjacent passes overlap by a fifth
constexpr double kMinRadiusPerRadius = 0.5; // a wheel is worn out at half its radius

// The number of a member, converted from the file's unit, or the default, which is in base units.
double quantity(Reader& reader, const std::string& key, double fallback, double unit, const core::Range& range)
{
    const double number = reader.number_or(key, core::kNaN, range);
    const double value = std::isnan(number) ? fallback : number * unit;
    if (std::abs(number) > 0 && std::abs(value) < kMinQuantity) // false for NaN, a missing member
        reader.refuse(key, "too small: " + core::to_text(number));
    return value;
}

Eigen::Matrix3Xd boundary_points(Reader& reader, const std::string& key, double unit)
{
    const Eigen::MatrixXd rows = reader.ragged_matrix(key, 2, 3) * unit;
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Constant(3, rows.rows(), core::kNaN);
    if (rows.rows() > 0) points.topRows(rows.cols()) = rows.transpose();
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        for (Eigen::Index k = 0; k < 3; ++k)
            if (std::abs(points(k, i)) > kMaxCoordinate)
                reader.refuse(key + "[" + std::to_string(i) + "][" + std::to_string(k) + "]",
                              "no casting reaches that far: " + core::to_text(points(k, i) / unit));
    return points;
}

/// Either of position and quaternion may be missing: a shift, or a turn about the part's origin.
void parse_frame(Reader reader, double mm, Job& job)
{
    constexpr double kUnitTolerance = 1e-3; // a quaternion written with three digits
    Eigen::Isometry3d T_part_job = Eigen::Isometry3d::Identity();
    if (reader.has("position")) {
        T_part_job.translation() = mm * reader.vector("position", 3);
        if (!(T_part_job.translation().cwiseAbs().maxCoeff() <= kMaxCoordinate))
            reader.refuse("position", "no casting reaches that far");
    }
    if (reader.has("quaternion")) {
        const Eigen::Vector4d q = reader.vector("quaternion", 4); // w first
        if (!(std::abs(q.norm() - 1) <= kUnitTolerance))
            reader.refuse("quaternion",
                          "expected a unit quaternion, got one of length " + core::to_short_text(q.norm()));
        T_part_job.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    }
    if (reader.has("position") || reader.has("quaternion")) job.T_part_job = T_part_job;
    job.theta = reader.number_or("theta_deg", 0) * core::kRadPerDegree;
    reader.reject_unknown_keys();
}

units::Units parse_units(Reader reader, bool forces_matter)
{
    units::Units units;
    units.length = units::parse_length_unit(reader.choice("length", {"mm", "in"}));
    const std::string force =
        forces_matter ? reader.choice("force", {"N", "lbf"}) : reader.choice_or("force", "N", {"N", "lbf"});
    units.force = units::parse_force_unit(force);
    reader.reject_unknown_keys();
    return units;
}

void parse_surface(Reader reader, Job& job)
{
    job.surface = parse_surface_type(reader.choice("type", kSurfaceTypes));
    if (job.surface == SurfaceType::swept) job.ruling_direction = reader.number("direction_deg") * core::kRadPerDegree;
    reader.reject_unknown_keys();
}

void parse_probe(Reader reader, double mm, Probe& probe)
{
    probe.accuracy = quantity(reader, "accuracy", probe.accuracy, mm, core::Range::positive());
    probe.tip_radius = quantity(reader, "tip_radius", probe.tip_radius, mm, core::Range::at_least(0));
    reader.reject_unknown_keys();
}

void parse_wheel(Reader reader, double mm, GrindingWheel& wheel)
{
    wheel.radius = quantity(reader, "radius", wheel.radius, mm, core::Range::positive());
    wheel.width = quantity(reader, "width", wheel.width, mm, core::Range::positive());
    wheel.min_radius = quantity(reader, "min_radius", kMinRadiusPerRadius * wheel.radius, mm, core::Range::positive());
    for (const auto& [key, size] : {std::pair("radius", wheel.radius), std::pair("width", wheel.width)})
        if (size < kMinWheelSize || size > kMaxWheelSize)
            reader.refuse(key, "no wheel has " + core::to_short_text(size / mm) + "; from " +
                                   core::to_short_text(kMinWheelSize / mm) + " to " +
                                   core::to_short_text(kMaxWheelSize / mm));
    if (wheel.min_radius > wheel.radius)
        reader.refuse("min_radius", "must be at most the radius, " + core::to_short_text(wheel.radius / mm) + ", got " +
                                        core::to_short_text(wheel.min_radius / mm));
    if (reader.has("grinding_ratio")) wheel.grinding_ratio = reader.number("grinding_ratio", core::Range::positive());
    wheel.source = reader.text_or("source", "");
    reader.reject_unknown_keys();
}

void parse_force(Reader reader, const units::Units& units, ForceRange& force)
{
    const double newton = units.newton();
    force.min = quantity(reader, "min", force.min, newton, core::Range::at_least(0));
    force.max = quantity(reader, "max", force.max, newton, core::Range::positive());
    if (force.min >= force.max)
        reader.refuse("max", "must be above min, " + core::to_short_text(force.min / newton) + ", got " +
                                 core::to_short_text(force.max / newton));
    force.down = quantity(reader, "down", (force.min + force.max) / 2, newton, core::Range::positive());
    if (force.down < force.min || force.down >= force.max)
        reader.refuse("down", "must lie between min and max, " + core::to_short_text(force.min / newton) + " and " +
                                  core::to_short_text(force.max / newton) + ", got " +
                                  core::to_short_text(force.down / newton));
    force.stiffness = quantity(reader, "stiffness", force.stiffness, units::base_unit_factor(units, {-1, 1}),
                               core::Range::positive());
    force.preload = quantity(reader, "preload", force.preload, newton, core::Range::at_least(0));
    if (force.preload >= force.max)
        reader.refuse("preload", "must be below max, " + core::to_short_text(force.max / newton) + ", got " +
                                     core::to_short_text(force.preload / newton));
    reader.reject_unknown_keys();
}

void parse_feed(Reader reader, double mm, double width, Feed& feed)
{
    feed.axis = reader.choice_or("axis", std::string(1, feed.axis), {"x", "y"})[0];
    feed.rate = quantity(reader, "rate", feed.rate, mm, core::Range::positive());
    feed.step_over = quantity(reader, "step_over", kStepOverPerWidth * width, mm, core::Range::positive());
    if (feed.step_over > width)
        reader.refuse("step_over", "wider than the wheel, " + core::to_short_text(width / mm) + ": " +
                                       core::to_short_text(feed.step_over / mm) + " leaves ridges");
    reader.reject_unknown_keys();
}

/// -infinity if no boundary point has a z.
double max_boundary_height(const Job& job)
{
    double z = -core::kInfinity;
    for (const Eigen::Matrix3Xd& points : {job.anomaly, job.sampling})
        for (Eigen::Index i = 0; i < points.cols(); ++i) z = std::fmax(z, points(2, i)); // fmax ignores NaN
    return z;
}

// Rounds to 15 digits, which removes the error of converting units and back: numbers are written as they were read.
double rounded(double number)
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
        rows.emplace_back(Eigen::VectorXd(row.unaryExpr(&rounded)));
    }
    return rows;
}

Value frame_to_json(const Job& job)
{
    Value frame;
    if (job.T_part_job) {
        const Eigen::Vector3d position = job.T_part_job->translation() / job.units.mm();
        const Eigen::Quaterniond q(job.T_part_job->linear());
        const Eigen::Vector4d numbers = (q.w() < 0 ? -1 : 1) * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
        frame.set("position", Eigen::VectorXd(position.unaryExpr(&rounded)))
            .set("quaternion", Eigen::VectorXd(numbers.unaryExpr(&rounded)));
    }
    return frame.set("theta_deg", rounded(job.theta / core::kRadPerDegree));
}

} // namespace

std::string to_string(SurfaceType type)
{
    return type == SurfaceType::plane ? "plane" : type == SurfaceType::swept ? "swept" : "freeform";
}

SurfaceType parse_surface_type(const std::string& name)
{
    return name == "plane" ? SurfaceType::plane : name == "swept" ? SurfaceType::swept : SurfaceType::freeform;
}

Job validated(const Job& job, const std::string& source)
{
    return parse_job(Reader::parse(to_json(job).text(), source));
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

    if (auto frame = reader.optional_object("frame")) parse_frame(*frame, mm, job);
    parse_surface(reader.object("surface"), job);
    job.anomaly = boundary_points(reader, "anomaly", mm);
    if (reader.has("sampling") || job.surface != SurfaceType::plane)
        job.sampling = boundary_points(reader, "sampling", mm);
    if (auto probe = reader.optional_object("probe")) parse_probe(*probe, mm, job.probe);
    job.tolerance = quantity(reader, "tolerance", job.tolerance, mm, core::Range::positive());
    const double highest = max_boundary_height(job);
    job.is_safe_height_known = reader.has("safe_height") || std::isfinite(highest);
    job.safe_height =
        quantity(reader, "safe_height", (std::isfinite(highest) ? highest : 0) + kTravelClearance, mm, {});
    if (auto wheel = reader.optional_object("wheel")) parse_wheel(*wheel, mm, job.wheel);
    if (auto force = reader.optional_object("force")) parse_force(*force, job.units, job.force);
    job.feed.step_over = kStepOverPerWidth * job.wheel.width;
    if (auto feed = reader.optional_object("feed")) parse_feed(*feed, mm, job.wheel.width, job.feed);
    if (auto removal = reader.optional_object("removal")) {
        job.removal_coefficient = quantity(*removal, "coefficient", job.removal_coefficient,
                                           units::base_unit_factor(job.units, {3, -1}), core::Range::positive());
        removal->reject_unknown_keys();
    }
    reader.reject_unknown_keys();
    working_boundaries(job); // throws for invalid polygons
    return job;
}

Value to_json(const Job& job)
{
    const double mm = job.units.mm();
    const double newton = job.units.newton();
    const auto in = [](double value, double unit) { return Value(rounded(value / unit)); };

    Value surface;
    surface.set("type", to_string(job.surface));
    if (job.surface == SurfaceType::swept) surface.set("direction_deg", in(job.ruling_direction, core::kRadPerDegree));

    Value wheel;
    wheel.set("radius", in(job.wheel.radius, mm))
        .set("width", in(job.wheel.width, mm))
        .set("min_radius", in(job.wheel.min_radius, mm));
    if (job.wheel.grinding_ratio) wheel.set("grinding_ratio", *job.wheel.grinding_ratio);
    if (!job.wheel.source.empty()) wheel.set("source", job.wheel.source);

    Value value;
    value.set("kind", "job")
        .set("units", json::to_json(job.units))
        .set("frame", frame_to_json(job))
        .set("surface", surface)
        .set("anomaly", points_to_json(job.anomaly, mm));
    if (job.sampling.cols() > 0) value.set("sampling", points_to_json(job.sampling, mm));
    value
        .set("probe",
             Value().set("accuracy", in(job.probe.accuracy, mm)).set("tip_radius", in(job.probe.tip_radius, mm)))
        .set("tolerance", in(job.tolerance, mm));
    if (job.is_safe_height_known) value.set("safe_height", in(job.safe_height, mm));
    value.set("wheel", wheel)
        .set("force", Value()
                          .set("min", in(job.force.min, newton))
                          .set("down", in(job.force.down, newton))
                          .set("max", in(job.force.max, newton))
                          .set("stiffness", in(job.force.stiffness, units::base_unit_factor(job.units, {-1, 1})))
                          .set("preload", in(job.force.preload, newton)))
        .set("feed", Value()
                         .set("axis", std::string(1, job.feed.axis))
                         .set("rate", in(job.feed.rate, mm))
                         .set("step_over", in(job.feed.step_over, mm)))
        .set("removal",
             Value().set("coefficient", in(job.removal_coefficient, units::base_unit_factor(job.units, {3, -1}))));
    return value;
}

} // namespace fettle::job
