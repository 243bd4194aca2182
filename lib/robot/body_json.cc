#include "robot/body_json.h"

#include "core/error.h"
#include "core/text.h"
#include "mesh/mesh_file.h"
#include "robot/hull_points.h"
#include "robot/mesh_body.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

namespace fettle::robot {

namespace {

using json::Reader;

double read_radius(Reader& reader, const std::string& key, double mm, bool may_be_zero = false)
{
    const double max = kMaxLength / mm;
    return mm * reader.number(key, may_be_zero ? core::Range::between(0, max) : core::Range{0, max, false, true});
}

// Reads the ends of the axis. They may coincide for a capsule only.
template <typename Round>
Round read_axis(Reader& reader, double mm, bool may_coincide)
{
    Round round;
    round.from = read_point(reader, "from", mm);
    round.to = read_point(reader, "to", mm);
    if (!may_coincide && round.from == round.to) reader.refuse("to", "equals from: the body has no length");
    return round;
}

template <typename Round>
Round read_round(Reader& reader, double mm, bool may_coincide)
{
    Round round = read_axis<Round>(reader, mm, may_coincide);
    round.radius = read_radius(reader, "radius", mm);
    return round;
}

solid::Cone read_cone(Reader& reader, double mm)
{
    solid::Cone cone = read_axis<solid::Cone>(reader, mm, false);
    cone.radius_from = read_radius(reader, "radius_from", mm, true);
    cone.radius_to = read_radius(reader, "radius_to", mm, true);
    if (cone.radius_from == 0 && cone.radius_to == 0) reader.refuse("radius_to", "both radii are 0");
    return cone;
}

solid::Box read_box(Reader& reader, double mm)
{
    const Eigen::VectorXd size = reader.vector("size", 3) * mm;
    for (const double side : size)
        if (!(side > 0 && side <= kMaxLength))
            reader.refuse("size", "must be positive, got " + core::to_short_text(side / mm));
    return {read_placement(reader.object("at"), mm), size / 2};
}

// A mesh in a file of its own, in the body's frame.
mesh::Mesh read_file_mesh(Reader& reader, const std::string& path, double mm)
{
    const std::string file = reader.text("file");
    const std::string unit = reader.choice_or("file_units", "mm", {"mm", "in", "m"});
    const std::filesystem::path mesh_path = std::filesystem::path(path).parent_path() / file;
    mesh::Mesh mesh = read_body_mesh(mesh_path.string(), units::parse_length_unit(unit));
    const auto at = reader.optional_object("at");
    if (at) mesh.vertices = read_placement(*at, mm) * mesh.vertices;
    return mesh;
}

Solid read_solid(Reader& reader, const std::string& path, double mm)
{
    const std::string shape = reader.choice("shape", {"sphere", "capsule", "cylinder", "cone", "box", "hull", "mesh"});
    if (shape == "sphere") {
        const Eigen::Vector3d centre = read_point(reader, "centre", mm);
        return solid::Sphere{centre, read_radius(reader, "radius", mm)};
    }
    if (shape == "capsule") return read_round<solid::Capsule>(reader, mm, true);
    if (shape == "cylinder") return read_round<solid::Cylinder>(reader, mm, false);
    if (shape == "cone") return read_cone(reader, mm);
    if (shape == "box") return read_box(reader, mm);
    mesh::Mesh mesh = read_file_mesh(reader, path, mm);
    if (shape == "hull") return solid::Hull{hull_points(mesh.vertices)};
    return solid::Triangles{std::make_shared<MeshBody>(std::move(mesh))};
}

std::size_t find_body(Reader& reader, const std::string& key, const Robot& robot, const std::string& name)
{
    std::vector<std::string> names;
    for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
        if (robot.bodies[i].name == name) return i;
        names.push_back(robot.bodies[i].name);
    }
    if (name == kWorkpieceName) return robot.bodies.size();
    names.push_back(kWorkpieceName);
    const std::string similar = core::nearest_word(name, names);
    reader.refuse(key,
                  "no body is called '" + name + "'" + (similar.empty() ? "" : ", did you mean '" + similar + "'?"));
}

BodyPair read_pair(Reader& reader, const std::string& key_a, const Robot& robot, const std::string& a,
                   const std::string& key_b, const std::string& b)
{
    const BodyPair pair = std::minmax({find_body(reader, key_a, robot, a), find_body(reader, key_b, robot, b)});
    if (pair.first == pair.second) reader.refuse(key_b, "expected two bodies, got '" + a + "' twice");
    return pair;
}

// The robot's true position may differ from the file by `error`: every pair of a body on the robot and one that is not
// gets that margin, unless the file gives another.
void add_calibration_error(Robot& robot, double error)
{
    const auto on_robot = [&](std::size_t body) {
        if (body == robot.bodies.size()) return false;
        const int link_index = robot.bodies[body].link;
        return link_index >= link::kBase && link_index <= link::kTool;
    };
    std::set<BodyPair> given;
    for (const Robot::Margin& margin : robot.margins) given.insert(margin.pair);
    for (std::size_t a = 0; a < robot.bodies.size(); ++a)
        for (std::size_t b = a + 1; b <= robot.bodies.size(); ++b)
            if (on_robot(a) != on_robot(b) && !given.contains({a, b})) robot.margins.push_back({{a, b}, error});
}

} // namespace

double read_length(Reader& reader, const std::string& key, double mm)
{
    return mm * reader.number(key, core::Range::between(-kMaxLength / mm, kMaxLength / mm));
}

Eigen::Vector3d read_point(Reader& reader, const std::string& key, double mm)
{
    const Eigen::Vector3d point = reader.vector(key, 3) * mm;
    if (!(point.cwiseAbs().maxCoeff() <= kMaxLength)) reader.refuse(key, "exceeds 100 m, the largest cell");
    return point;
}

Eigen::Vector3d read_direction(Reader& reader, const std::string& key)
{
    const Eigen::Vector3d direction = reader.vector(key, 3);
    const double length = direction.stableNorm();
    if (!(length > 0)) reader.refuse(key, "a direction must not be 0");
    return direction / length;
}

Eigen::Isometry3d read_placement(Reader reader, double mm)
{
    Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
    if (reader.has("position")) placement.translation() = read_point(reader, "position", mm);
    if (reader.has("quaternion")) {
        const Eigen::VectorXd wxyz = reader.vector("quaternion", 4);
        const double norm = wxyz.stableNorm();
        if (!(norm > 0)) reader.refuse("quaternion", "must not be 0");
        const Eigen::VectorXd unit = wxyz / norm;
        placement.linear() = Eigen::Quaterniond(unit[0], unit[1], unit[2], unit[3]).toRotationMatrix();
    }
    reader.reject_unknown_keys();
    return placement;
}

mesh::Mesh read_body_mesh(const std::string& path, units::Units::Length unit)
{
    mesh::MeshRepair repair;
    mesh::Mesh mesh = mesh::read_mesh(path, unit, &repair);
    if (repair.dropped_triangles > 0)
        throw core::InputError(path, std::to_string(repair.dropped_triangles) +
                                         " of its facets have NaN or infinite corners: the body is not whole");
    return mesh;
}

void parse_bodies(Reader& reader, const std::string& path, double mm, Robot& robot)
{
    if (reader.has("bodies"))
        for (Reader& body : reader.objects("bodies")) {
            const std::string name = body.text("name");
            if (name == kWorkpieceName) body.refuse("name", "is reserved for the part");
            for (const Body& other : robot.bodies)
                if (other.name == name) body.refuse("name", "another body is called '" + name + "', too");
            const int link_index = body.integer("link", link::kCell, link::kTable);
            if (link_index == link::kTable && !robot.table)
                body.refuse("link", "8 is the table, and the robot has none");
            robot.bodies.push_back({name, link_index, read_solid(body, path, mm)});
            body.reject_unknown_keys();
        }
    if (reader.has("allowed")) {
        const auto pairs = reader.text_rows("allowed", 2);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const std::string key = "allowed[" + std::to_string(i) + "]";
            robot.allowed.push_back(read_pair(reader, key, robot, pairs[i][0], key, pairs[i][1]));
        }
    }
    if (reader.has("margins"))
        for (Reader& margin : reader.objects("margins")) {
            const std::string a = margin.text("a"), b = margin.text("b");
            const BodyPair pair = read_pair(margin, "a", robot, a, "b", b);
            robot.margins.push_back({pair, mm * margin.number("distance", core::Range::between(0, kMaxLength / mm))});
            margin.reject_unknown_keys();
        }
    const double error = mm * reader.number_or("calibration_error", 0, core::Range::between(0, kMaxLength / mm));
    if (error > 0) add_calibration_error(robot, error);
}

} // namespace fettle::robot
