#include "robot/robot.h"

#include "core/constants.h"
#include "robot/body_json.h"

#include "core/error.h"
#include "core/text.h"
#include "json/document.h"
#include "json/units.h"

#include <cmath>
#include <numbers>

namespace fettle {

namespace {

using json::Reader;

// A right angle written with six digits is one.
constexpr double kRightAngle = 1e-6;

JointRange range_in(Reader& reader, const std::string& least, const std::string& most, double unit, double limit)
{
    const JointRange range = {reader.number(least, Range::between(-limit, limit)) * unit,
                              reader.number(most, Range::between(-limit, limit)) * unit};
    if (range.least > range.most)
        reader.refuse(most, "must be at least " + least + ", " + to_short_text(range.least / unit) + ", got " +
                                to_short_text(range.most / unit));
    return range;
}

std::optional<double> speed_in(Reader& reader, const std::string& key, double unit)
{
    const double nothing = 0;
    const double speed = reader.number_or(key, nothing, Range::positive());
    return speed > nothing ? std::optional(speed * unit) : std::nullopt;
}

DhRow row_in(Reader reader, double mm)
{
    DhRow row;
    row.alpha = reader.number("alpha_deg", Range::between(-180, 180)) * kRadPerDegree;
    row.a = length_in(reader, "a", mm);
    row.d = length_in(reader, "d", mm);
    row.offset = reader.number_or("theta_offset_deg", 0, Range::between(-360, 360)) * kRadPerDegree;
    row.range = range_in(reader, "min_deg", "max_deg", kRadPerDegree, kMostJointDegrees);
    row.max_speed = speed_in(reader, "max_speed_deg", kRadPerDegree);
    reader.done();
    return row;
}

bool right_angle(double angle) { return std::abs(std::abs(angle) - std::numbers::pi / 2) <= kRightAngle; }

// The closed form of robot/arm.h rests on these.
void check_closed_form(Reader& reader, std::array<DhRow, 6>& dh)
{
    const auto refuse = [&](std::size_t row, const std::string& key, const std::string& wanted) {
        reader.refuse("dh[" + std::to_string(row) + "]." + key, "the inverse has a closed form only " + wanted);
    };
    for (const std::size_t i : {0u, 2u, 3u, 4u}) {
        if (!right_angle(dh[i].alpha)) refuse(i, "alpha_deg", "with 90 or -90 here");
        dh[i].alpha = std::copysign(std::numbers::pi / 2, dh[i].alpha);
    }
    if (dh[1].alpha != 0) refuse(1, "alpha_deg", "with axes 2 and 3 parallel: 0");
    if (dh[1].a == 0) refuse(1, "a", "with an upper arm: not 0");
    if (dh[2].a == 0 && dh[3].d == 0) refuse(3, "d", "with a forearm: not 0, or dh[2].a not 0");
    for (const std::size_t i : {3u, 4u})
        if (dh[i].a != 0) refuse(i, "a", "with a spherical wrist: 0");
    if (dh[4].d != 0) refuse(4, "d", "with a spherical wrist: 0");
}

void parse_dh(Reader& reader, double mm, Robot& robot)
{
    std::vector<Reader> rows = reader.objects("dh");
    if (rows.size() != robot.dh.size())
        reader.refuse("dh", "expected a row for each of 6 joints, got " + std::to_string(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) robot.dh[i] = row_in(std::move(rows[i]), mm);
    check_closed_form(reader, robot.dh);
}

Eigen::Isometry3d tool_in(Reader reader, double mm)
{
    const double alpha = reader.number_or("alpha_deg", 0, Range::between(-180, 180)) * kRadPerDegree;
    const double theta = reader.number_or("theta_deg", 0, Range::between(-360, 360)) * kRadPerDegree;
    const double a = length_in(reader, "a", mm);
    const double d = length_in(reader, "d", mm);
    reader.done();
    return dh_transform(theta, d, a, alpha);
}

Track track_in(Reader reader, double mm)
{
    Track track;
    track.axis = direction_in(reader, "axis");
    track.range = range_in(reader, "min", "max", mm, kLongest / mm);
    track.max_speed = speed_in(reader, "max_speed", mm);
    reader.done();
    return track;
}

Table table_in(Reader reader, double mm)
{
    Table table;
    table.point = point_in(reader, "point", mm);
    table.axis = direction_in(reader, "axis");
    table.range = range_in(reader, "min_deg", "max_deg", kRadPerDegree, kMostJointDegrees);
    table.max_speed = speed_in(reader, "max_speed_deg", kRadPerDegree);
    table.unit = reader.text_or("unit", "");
    reader.done();
    return table;
}

} // namespace

std::string body_name(const Robot& robot, std::size_t body)
{
    return body < robot.bodies.size() ? robot.bodies[body].name : kWorkpiece;
}

Eigen::Isometry3d dh_transform(double theta, double d, double a, double alpha)
{
    const double c = std::cos(theta), s = std::sin(theta), c_alpha = std::cos(alpha), s_alpha = std::sin(alpha);
    Eigen::Isometry3d A;
    A.linear() << c, -s * c_alpha, s * s_alpha, s, c * c_alpha, -c * s_alpha, 0, s_alpha, c_alpha;
    A.translation() << a * c, a * s, d;
    A.makeAffine();
    return A;
}

Robot read_robot(const std::string& path)
{
    Reader reader = Reader::open(path);
    Robot robot;
    robot.source = reader.source();
    reader.expect_kind("robot");
    const double mm = mm_per(json::read_length_unit(reader));
    parse_dh(reader, mm, robot);
    const std::string coupling = reader.choice("coupling", {"serial", "parallelogram"});
    robot.coupling = coupling == "serial" ? Coupling::serial : Coupling::parallelogram;
    const Eigen::AngleAxisd half_turn(std::numbers::pi, Eigen::Vector3d::UnitX());
    const auto tool = reader.object_or_none("tool");
    robot.T_flange_tool = (tool ? tool_in(*tool, mm) : Eigen::Isometry3d::Identity()) * half_turn;
    if (const auto base = reader.object_or_none("base")) robot.T_cell_base = placement_in(*base, mm);
    if (const auto track = reader.object_or_none("track")) robot.track = track_in(*track, mm);
    if (const auto table = reader.object_or_none("table")) robot.table = table_in(*table, mm);
    parse_bodies(reader, path, mm, robot);
    reader.done();
    return robot;
}

} // namespace fettle
