#include "robot/robot.h"

#include "core/constants.h"
#include "robot/body_json.h"
#include "robot/mesh_body.h"
#include "robot/urdf.h"

#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "json/document.h"
#include "json/units.h"

#include <cmath>
#include <numbers>

namespace fettle::robot {

namespace {

using json::Reader;

// Angles written with six digits count as right angles, rad.
constexpr double kRightAngleTolerance = 1e-6;

JointRange read_range(Reader& reader, const std::string& min_key, const std::string& max_key, double unit, double limit)
{
    const JointRange range = {reader.number(min_key, core::Range::between(-limit, limit)) * unit,
                              reader.number(max_key, core::Range::between(-limit, limit)) * unit};
    if (range.min > range.max)
        reader.refuse(max_key, "must be at least " + min_key + ", " + core::to_short_text(range.min / unit) + ", got " +
                                   core::to_short_text(range.max / unit));
    return range;
}

std::optional<double> read_speed(Reader& reader, const std::string& key, double unit)
{
    const double speed = reader.number_or(key, 0, core::Range::positive());
    return speed > 0 ? std::optional(speed * unit) : std::nullopt;
}

DhRow read_dh_row(Reader reader, double mm)
{
    DhRow row;
    row.alpha = reader.number("alpha_deg", core::Range::between(-180, 180)) * core::kRadPerDegree;
    row.a = read_length(reader, "a", mm);
    row.d = read_length(reader, "d", mm);
    row.offset = reader.number_or("theta_offset_deg", 0, core::Range::between(-360, 360)) * core::kRadPerDegree;
    row.range = read_range(reader, "min_deg", "max_deg", core::kRadPerDegree, kMaxJointDegrees);
    row.max_speed = read_speed(reader, "max_speed_deg", core::kRadPerDegree);
    reader.reject_unknown_keys();
    return row;
}

bool is_right_angle(double angle) { return std::abs(std::abs(angle) - std::numbers::pi / 2) <= kRightAngleTolerance; }

// The closed form of the inverse (robot/arm.h) assumes these conditions. Nearly right twists are set to right angles.
void check_closed_form(Reader& reader, std::array<DhRow, 6>& dh)
{
    const auto refuse = [&](std::size_t row, const std::string& key, const std::string& wanted) {
        reader.refuse("dh[" + std::to_string(row) + "]." + key, "the inverse has a closed form only " + wanted);
    };
    for (const std::size_t i : {0u, 2u, 3u, 4u}) {
        if (!is_right_angle(dh[i].alpha)) refuse(i, "alpha_deg", "with 90 or -90 here");
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
    for (std::size_t i = 0; i < rows.size(); ++i) robot.dh[i] = read_dh_row(std::move(rows[i]), mm);
    check_closed_form(reader, robot.dh);
}

Eigen::Isometry3d read_tool(Reader reader, double mm)
{
    const double alpha = reader.number_or("alpha_deg", 0, core::Range::between(-180, 180)) * core::kRadPerDegree;
    const double theta = reader.number_or("theta_deg", 0, core::Range::between(-360, 360)) * core::kRadPerDegree;
    const double a = read_length(reader, "a", mm);
    const double d = read_length(reader, "d", mm);
    reader.reject_unknown_keys();
    return dh_transform(theta, d, a, alpha);
}

Track read_track(Reader reader, double mm)
{
    Track track;
    track.axis = read_direction(reader, "axis");
    track.range = read_range(reader, "min", "max", mm, kMaxLength / mm);
    track.max_speed = read_speed(reader, "max_speed", mm);
    reader.reject_unknown_keys();
    return track;
}

Table read_table(Reader reader, double mm)
{
    Table table;
    table.point = read_point(reader, "point", mm);
    table.axis = read_direction(reader, "axis");
    table.range = read_range(reader, "min_deg", "max_deg", core::kRadPerDegree, kMaxJointDegrees);
    table.max_speed = read_speed(reader, "max_speed_deg", core::kRadPerDegree);
    table.unit = reader.text_or("unit", "");
    reader.reject_unknown_keys();
    return table;
}

Robot parse_robot(const std::string& text, const std::string& path)
{
    Reader reader = Reader::parse(text, core::display_name(path));
    Robot robot;
    reader.expect_kind("robot");
    const double mm = units::mm_per(json::read_length_unit(reader));
    parse_dh(reader, mm, robot);
    const std::string coupling = reader.choice("coupling", {"serial", "parallelogram"});
    robot.coupling = coupling == "serial" ? Coupling::serial : Coupling::parallelogram;
    const Eigen::AngleAxisd half_turn(std::numbers::pi, Eigen::Vector3d::UnitX());
    const auto tool = reader.optional_object("tool");
    robot.T_flange_tool = (tool ? read_tool(*tool, mm) : Eigen::Isometry3d::Identity()) * half_turn;
    if (const auto base = reader.optional_object("base")) robot.T_cell_base = read_placement(*base, mm);
    if (const auto track = reader.optional_object("track")) robot.track = read_track(*track, mm);
    if (const auto table = reader.optional_object("table")) robot.table = read_table(*table, mm);
    parse_bodies(reader, path, mm, robot);
    reader.reject_unknown_keys();
    return robot;
}

// Notes the meshes that have no inside.
void note_open_meshes(Robot& robot)
{
    for (const Body& body : robot.bodies) {
        const auto* triangles = std::get_if<solid::Triangles>(&body.solid);
        if (triangles != nullptr && !triangles->body->surface.closed())
            robot.notes.push_back("the mesh of '" + body.name +
                                  "' is not closed: a body wholly inside it would not be noticed");
    }
}

std::string digest_of(const std::string& text, const Robot& robot)
{
    core::Digest digest;
    digest.add(text);
    const auto add = [&](const auto& matrix) {
        digest.add({reinterpret_cast<const char*>(matrix.data()),
                    static_cast<std::size_t>(matrix.size()) * sizeof(*matrix.data())});
    };
    add(robot.T_flange_tool.matrix()); // of a URDF an option says it
    for (const Body& body : robot.bodies) {
        if (const auto* hull = std::get_if<solid::Hull>(&body.solid)) add(hull->points);
        if (const auto* triangles = std::get_if<solid::Triangles>(&body.solid)) {
            add(triangles->body->mesh.vertices);
            add(triangles->body->mesh.triangles);
        }
    }
    return digest.text();
}

} // namespace

std::string body_name(const Robot& robot, std::size_t body)
{
    return body < robot.bodies.size() ? robot.bodies[body].name : kWorkpieceName;
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
    const std::string text = core::read_file(path, core::kMaxJsonBytes);
    Robot robot = parse_robot(text, path);
    note_open_meshes(robot);
    robot.digest = digest_of(text, robot);
    return robot;
}

Robot read_robot(const std::string& path, const UrdfOptions& options)
{
    const std::string text = core::read_file(path, core::kMaxJsonBytes);
    const bool has_options =
        !options.srdf.empty() || !options.tip.empty() || !options.packages.empty() || !options.exact_meshes;
    if (!looks_like_xml(text) && has_options)
        throw core::InputError("--package, --srdf, --tip and --link-meshes go with a URDF, and " +
                               core::display_name(path) + " is none");
    Robot robot = looks_like_xml(text) ? parse_urdf(text, core::display_name(path), options) : parse_robot(text, path);
    note_open_meshes(robot);
    robot.digest = digest_of(text, robot);
    return robot;
}

} // namespace fettle::robot
