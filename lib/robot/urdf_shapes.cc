#include "robot/urdf_shapes.h"

#include "core/error.h"
#include "core/text.h"
#include "mesh/mesh_file.h"
#include "robot/body_json.h"
#include "robot/hull_points.h"
#include "robot/mesh_body.h"

#include <urdf_model/link.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// What URDFs leave of a right angle (1.570796327) and of a zero (-1.9e-11 m): rad, and m.
constexpr double kQuarterTurnTolerance = 1e-9, kLengthRounding = 1e-10;

// A rotation by quarter turns, written with nine digits or more, is one: then the closed form is exact.
void round_quarter_turns(Eigen::Ref<Eigen::Matrix3d> R)
{
    const Eigen::Matrix3d rounded = R.array().round();
    if ((R - rounded).cwiseAbs().maxCoeff() < kQuarterTurnTolerance) R = rounded;
}

std::string mesh_path(const std::string& name, const UrdfFiles& files)
{
    const std::string package = "package://", file = "file://";
    std::filesystem::path path = name;
    if (name.starts_with(package)) {
        const std::string rest = name.substr(package.size());
        const std::string called = rest.substr(0, rest.find('/'));
        const auto found = files.packages.find(called);
        if (found == files.packages.end())
            throw core::InputError("link '" + files.link + "': " + name + ": where is the package? --package " +
                                   called + "=DIR says it");
        path = std::filesystem::path(found->second) / rest.substr(std::min(called.size() + 1, rest.size()));
    } else if (name.starts_with(file)) {
        path = name.substr(file.size());
    } else if (path.is_relative()) {
        path = std::filesystem::path(files.source).parent_path() / path;
    }
    std::string suffix = path.extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return std::tolower(c); });
    if (suffix == ".dae")
        throw core::InputError("link '" + files.link + "': " + name + ": COLLADA is not read; convert it to STL");
    if (!std::filesystem::exists(path))
        throw core::InputError("link '" + files.link + "': there is no mesh " + path.string());
    return path.string();
}

Solid mesh_solid(const urdf::Mesh& shape, const Isometry3d& T, const UrdfFiles& files)
{
    const std::string path = mesh_path(shape.filename, files);
    mesh::Mesh mesh = read_body_mesh(path, units::Units::Length::m);
    const Vector3d scale(shape.scale.x, shape.scale.y, shape.scale.z);
    if (!scale.allFinite() || scale.cwiseAbs().minCoeff() == 0)
        throw core::InputError("link '" + files.link + "': the scale of its mesh is 0");
    mesh.vertices = (T.linear() * scale.asDiagonal() * mesh.vertices).colwise() + T.translation();
    if (!files.exact_meshes) return solid::Hull{hull_points(mesh.vertices)};
    if (scale.prod() < 0) mesh.triangles.row(1).swap(mesh.triangles.row(2)); // a mirror turns them inside out
    return solid::Triangles{std::make_shared<MeshBody>(std::move(mesh))};
}

} // namespace

Isometry3d urdf_isometry(const urdf::Pose& pose)
{
    Isometry3d T = Isometry3d::Identity();
    const urdf::Rotation& q = pose.rotation;
    const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
    T.linear() = rotation.normalized().toRotationMatrix();
    round_quarter_turns(T.linear());
    const Vector3d metres(pose.position.x, pose.position.y, pose.position.z);
    T.translation() = kMmPerMetre * ((metres / kLengthRounding).array().round() * kLengthRounding).matrix();
    if (!T.matrix().allFinite() || T.translation().cwiseAbs().maxCoeff() > kMaxLength)
        throw core::InputError("a place is not finite, or beyond 100 m");
    return T;
}

Solid urdf_solid(const urdf::Geometry& geometry, const Isometry3d& T, const UrdfFiles& files)
{
    const auto check = [&](double length) {
        if (!(length > 0 && length * kMmPerMetre <= kMaxLength))
            throw core::InputError("link '" + files.link + "': a length of its collision shape is " +
                                   core::to_short_text(length) + " m");
        return length * kMmPerMetre;
    };
    if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry))
        return solid::Sphere{T.translation(), check(sphere->radius)};
    if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry))
        return solid::Box{T, Vector3d(check(box->dim.x), check(box->dim.y), check(box->dim.z)) / 2};
    if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry)) {
        const Vector3d half(0, 0, check(cylinder->length) / 2);
        return solid::Cylinder{T * Vector3d(-half), T * half, check(cylinder->radius)};
    }
    return mesh_solid(dynamic_cast<const urdf::Mesh&>(geometry), T, files);
}

} // namespace fettle::robot
