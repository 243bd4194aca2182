#include "cloud/cloud.h"

#include "cloud/element.h"
#include "cloud/viewpoint.h"
#include "core/error.h"

#include <algorithm>

namespace fettle::cloud {

namespace {

const std::string kNormals[] = {"normal_x", "normal_y", "normal_z"};

/// Finds or appends the field and gives it one uninitialised float or double per point.
Field& prepare_field(Cloud& cloud, const std::string& name, Eigen::Index points, int size)
{
    auto field = std::ranges::find(cloud.fields, name, &Field::name);
    if (field == cloud.fields.end()) field = cloud.fields.insert(field, {name, 'F', size, 1, {}});
    field->type = 'F';
    field->size = size;
    field->count = 1;
    field->bytes.resize(points * size);
    return *field;
}

/// A cloud without points that has the viewpoint, comment and frame of another.
Cloud empty_like(const Cloud& cloud)
{
    Cloud empty;
    empty.view_origin = cloud.view_origin;
    empty.view_orientation = cloud.view_orientation;
    empty.comment = cloud.comment;
    empty.frame = cloud.frame;
    return empty;
}

} // namespace

bool has_field(const Cloud& cloud, const std::string& name)
{
    return std::ranges::find(cloud.fields, name, &Field::name) != cloud.fields.end();
}

Eigen::VectorXd field(const Cloud& cloud, const std::string& name)
{
    const auto found = std::ranges::find(cloud.fields, name, &Field::name);
    if (found == cloud.fields.end()) throw core::InputError("the points have no field '" + name + "'");
    if (found->count != 1)
        throw core::InputError("field '" + name + "' has " + std::to_string(found->count) +
                               " elements a point, expected 1");
    Eigen::VectorXd values(cloud.size());
    visit_element(found->type, found->size, [&](auto zero) {
        using T = decltype(zero);
        for (Eigen::Index i = 0; i < values.size(); ++i)
            values[i] = static_cast<double>(load<T>(found->bytes.data() + sizeof(T) * i));
    });
    return values;
}

void set_field(Cloud& cloud, const std::string& name, const Eigen::VectorXd& values, int size)
{
    Field& target = prepare_field(cloud, name, values.size(), size);
    visit_element('F', size, [&](auto zero) {
        using T = decltype(zero);
        for (Eigen::Index i = 0; i < values.size(); ++i)
            store(target.bytes.data() + sizeof(T) * i, static_cast<T>(values[i]));
    });
}

bool has_poses(const Cloud& cloud)
{
    return std::ranges::all_of(kQuaternion, [&](const char* name) { return has_field(cloud, name); });
}

bool has_normals(const Cloud& cloud)
{
    return std::ranges::all_of(kNormals, [&](const std::string& name) { return has_field(cloud, name); });
}

Eigen::Matrix3Xd normals(const Cloud& cloud)
{
    Eigen::Matrix3Xd values(3, cloud.size());
    for (int axis = 0; axis < 3; ++axis) values.row(axis) = field(cloud, kNormals[axis]);
    return values;
}

void set_normals(Cloud& cloud, const Eigen::Matrix3Xd& unit_normals)
{
    for (int axis = 0; axis < 3; ++axis) set_field(cloud, kNormals[axis], unit_normals.row(axis));
}

void set_colours(Cloud& cloud, const Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic>& rgb)
{
    Field& target = prepare_field(cloud, "rgb", rgb.cols(), 4); // viewers expect type F, whatever the bits mean
    for (Eigen::Index i = 0; i < rgb.cols(); ++i) {
        const std::uint32_t packed = static_cast<std::uint32_t>(rgb(0, i)) << 16 |
                                     static_cast<std::uint32_t>(rgb(1, i)) << 8 | static_cast<std::uint32_t>(rgb(2, i));
        store(target.bytes.data() + 4 * i, packed);
    }
}

namespace {

/// Turns the quaternions qw qx qy qz, whatever their lengths.
void turn_poses(Cloud& cloud, const Eigen::Quaterniond& turn)
{
    Eigen::Matrix4Xd q(4, cloud.size());
    for (Eigen::Index k = 0; k < 4; ++k) q.row(k) = field(cloud, kQuaternion[k]);
    for (auto old : q.colwise()) {
        const Eigen::Quaterniond turned = turn * Eigen::Quaterniond(old[0], old[1], old[2], old[3]);
        old << turned.w(), turned.x(), turned.y(), turned.z();
        if (turned.w() < 0) old = -old; // q and -q are the same rotation
    }
    for (Eigen::Index k = 0; k < 4; ++k) set_field(cloud, kQuaternion[k], q.row(k), 8);
}

} // namespace

Cloud transformed(Cloud cloud, const Eigen::Matrix4d& matrix, double mm)
{
    const auto apply = [&](const Eigen::Vector3d& p) {
        Eigen::Vector3d q;
        for (int k = 0; k < 3; ++k)
            q[k] = ((matrix(k, 0) * p[0] + matrix(k, 1) * p[1]) + matrix(k, 2) * p[2]) + matrix(k, 3);
        return q;
    };
    for (Eigen::Index i = 0; i < cloud.size(); ++i) cloud.xyz.col(i) = mm * apply(cloud.xyz.col(i) / mm);
    const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
    if (has_normals(cloud)) set_normals(cloud, R * normals(cloud));
    if (has_poses(cloud)) turn_poses(cloud, Eigen::Quaterniond(R));
    if (has_viewpoint(cloud))
        set_viewpoint(cloud, mm * apply(cloud.view_origin / mm), Eigen::Quaterniond(R) * cloud.view_orientation);
    return cloud;
}

Cloud slice(const Cloud& cloud, Eigen::Index first, Eigen::Index count)
{
    Cloud some = empty_like(cloud);
    some.width = cloud.width;
    some.xyz = cloud.xyz.middleCols(first, count);
    for (const Field& from : cloud.fields) {
        const auto begin = from.bytes.begin() + first * from.stride();
        some.fields.push_back({from.name, from.type, from.size, from.count, {begin, begin + count * from.stride()}});
    }
    return some;
}

Cloud select_points(const Cloud& cloud, const std::vector<Eigen::Index>& indices)
{
    Cloud selected = empty_like(cloud);
    selected.xyz = cloud.xyz(Eigen::all, indices);
    for (const Field& from : cloud.fields) {
        Field to{from.name, from.type, from.size, from.count, {}};
        to.bytes.reserve(from.stride() * indices.size());
        for (const Eigen::Index index : indices) {
            const auto first = from.bytes.begin() + index * from.stride();
            to.bytes.insert(to.bytes.end(), first, first + from.stride());
        }
        selected.fields.push_back(std::move(to));
    }
    return selected;
}

} // namespace fettle::cloud
