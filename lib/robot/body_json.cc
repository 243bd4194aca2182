#include "robot/body_json.h"

#include "core/error.h"
#include "core/text.h"
#include "mesh/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace fettle {

namespace {

using json::Reader;

double radius_in(Reader& reader, const std::string& key, double mm, bool may_be_zero = false)
{
    const double most = kLongest / mm;
    return mm * reader.number(key, may_be_zero ? Range::between(0, most) : Range{0, most, false, true});
}

// The ends of a capsule may be one point, those of a cylinder may not.
template <typename Round>
Round ends_in(Reader& reader, double mm, bool may_be_one)
{
    Round round;
    round.from = point_in(reader, "from", mm);
    round.to = point_in(reader, "to", mm);
    if (!may_be_one && round.from == round.to) reader.refuse("to", "is where it is from: the body has no length");
    return round;
}

template <typename Round>
Round round_in(Reader& reader, double mm, bool may_be_one)
{
    Round round = ends_in<Round>(reader, mm, may_be_one);
    round.radius = radius_in(reader, "radius", mm);
    return round;
}

solid::Cone cone_in(Reader& reader, double mm)
{
    solid::Cone cone = ends_in<solid::Cone>(reader, mm, false);
    cone.radius_from = radius_in(reader, "radius_from", mm, true);
    cone.radius_to = radius_in(reader, "radius_to", mm, true);
    if (cone.radius_from == 0 && cone.radius_to == 0) reader.refuse("radius_to", "both radii are 0");
    return cone;
}

solid::Box box_in(Reader& reader, double mm)
{
    const Eigen::VectorXd size = reader.vector("size", 3) * mm;
    for (const double side : size)
        if (!(side > 0 && side <= kLongest)) reader.refuse("size", "must be positive, got " + to_short_text(side / mm));
    return {placement_in(reader.object("at"), mm), size / 2};
}

solid::Hull hull_in(Reader& reader, const std::string& path, double mm)
{
    const std::string file = reader.text("file");
    const std::string unit = reader.choice_or("file_units", "mm", {"mm", "in", "m"});
    const std::filesystem::path beside = std::filesystem::path(path).parent_path() / file;
    const Mesh mesh = read_mesh(beside.string(), parse_length_unit(unit));
    const auto at = reader.object_or_none("at");
    const Eigen::Isometry3d T_body_file = at ? placement_in(*at, mm) : Eigen::Isometry3d::Identity();
    return {T_body_file * mesh.vertices};
}

Solid solid_in(Reader& reader, const std::string& path, double mm)
{
    const std::string shape = reader.choice("shape", {"sphere", "capsule", "cylinder", "cone", "box", "hull"});
    if (shape == "sphere") {
        const Eigen::Vector3d centre = point_in(reader, "centre", mm);
        return solid::Sphere{centre, radius_in(reader, "radius", mm)};
    }
    if (shape == "capsule") return round_in<solid::Capsule>(reader, mm, true);
    if (shape == "cylinder") return round_in<solid::Cylinder>(reader, mm, false);
    if (shape == "cone") return cone_in(reader, mm);
    if (shape == "box") return box_in(reader, mm);
    return hull_in(reader, path, mm);
}

void check_link(Reader& reader, const Robot& robot, int on)
{
    if (on == link::kTable && !robot.table) reader.refuse("link", "8 is the table, and the robot has none");
}

std::size_t body_called(Reader& reader, const std::string& key, const Robot& robot, const std::string& name)
{
    std::vector<std::string> names;
    for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
        if (robot.bodies[i].name == name) return i;
        names.push_back(robot.bodies[i].name);
    }
    if (name == kWorkpiece) return robot.bodies.size();
    names.push_back(kWorkpiece);
    const std::string meant = nearest_word(name, names);
    reader.refuse(key, "no body is called '" + name + "'" + (meant.empty() ? "" : ", did you mean '" + meant + "'?"));
}

BodyPair pair_of(Reader& reader, const std::string& key_a, const Robot& robot, const std::string& a,
                 const std::string& key_b, const std::string& b)
{
    const BodyPair pair = std::minmax({body_called(reader, key_a, robot, a), body_called(reader, key_b, robot, b)});
    if (pair.first == pair.second) reader.refuse(key_b, "expected two bodies, got '" + a + "' twice");
    return pair;
}

// The robot may stand otherwise than stated: what it carries against what it does not has that margin, unless another
// is given.
void add_calibration_error(Robot& robot, double error)
{
    const auto on_robot = [&](std::size_t body) {
        if (body == robot.bodies.size()) return false;
        const int on = robot.bodies[body].link;
        return on >= link::kBase && on <= link::kTool;
    };
    std::set<BodyPair> given;
    for (const Robot::Margin& margin : robot.margins) given.insert(margin.pair);
    for (std::size_t a = 0; a < robot.bodies.size(); ++a)
        for (std::size_t b = a + 1; b <= robot.bodies.size(); ++b)
            if (on_robot(a) != on_robot(b) && !given.contains({a, b})) robot.margins.push_back({{a, b}, error});
}

} // namespace

double length_in(Reader& reader, const std::string& key, double mm)
{
    return mm * reader.number(key, Range::between(-kLongest / mm, kLongest / mm));
}

Eigen::Vector3d point_in(Reader& reader, const std::string& key, double mm)
{
    const Eigen::Vector3d point = reader.vector(key, 3) * mm;
    if (!(point.cwiseAbs().maxCoeff() <= kLongest)) reader.refuse(key, "no cell is as large");
    return point;
}

Eigen::Vector3d direction_in(Reader& reader, const std::string& key)
{
    const Eigen::Vector3d direction = reader.vector(key, 3);
    const double length = direction.stableNorm();
    if (!(length > 0)) reader.refuse(key, "a direction must not be 0");
    return direction / length;
}

Eigen::Isometry3d placement_in(Reader reader, double mm)
{
    Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
    if (reader.has("position")) placement.translation() = point_in(reader, "position", mm);
    if (reader.has("quaternion")) {
        const Eigen::VectorXd wxyz = reader.vector("quaternion", 4);
        const double norm = wxyz.stableNorm();
        if (!(norm > 0)) reader.refuse("quaternion", "must not be 0");
        const Eigen::VectorXd unit = wxyz / norm;
        placement.linear() = Eigen::Quaterniond(unit[0], unit[1], unit[2], unit[3]).toRotationMatrix();
    }
    reader.done();
    return placement;
}

void parse_bodies(Reader& reader, const std::string& path, double mm, Robot& robot)
{
    if (reader.has("bodies"))
        for (Reader& body : reader.objects("bodies")) {
            const std::string name = body.text("name");
            if (name == kWorkpiece) body.refuse("name", "is what the part is called");
            for (const Body& other : robot.bodies)
                if (other.name == name) body.refuse("name", "another body is called '" + name + "', too");
            const int on = body.integer("link", link::kCell, link::kTable);
            check_link(body, robot, on);
            robot.bodies.push_back({name, on, solid_in(body, path, mm)});
            body.done();
        }
    if (reader.has("allowed")) {
        const auto pairs = reader.text_rows("allowed", 2);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const std::string key = "allowed[" + std::to_string(i) + "]";
            robot.allowed.push_back(pair_of(reader, key, robot, pairs[i][0], key, pairs[i][1]));
        }
    }
    if (reader.has("margins"))
        for (Reader& margin : reader.objects("margins")) {
            const std::string a = margin.text("a"), b = margin.text("b");
            const BodyPair pair = pair_of(margin, "a", robot, a, "b", b);
            robot.margins.push_back({pair, mm * margin.number("distance", Range::between(0, kLongest / mm))});
            margin.done();
        }
    const double error = mm * reader.number_or("calibration_error", 0, Range::between(0, kLongest / mm));
    if (error > 0) add_calibration_error(robot, error);
}

} // namespace fettle
