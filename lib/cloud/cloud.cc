#include "cloud/cloud.h"

#include "cloud/element.h"
#include "core/error.h"

#include <algorithm>

namespace fettle {

namespace {

const Field* find_field(const Cloud& cloud, const std::string& name)
{
    const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                    [&name](const Field& candidate) { return candidate.name == name; });
    return found == cloud.fields.end() ? nullptr : &*found;
}

const std::string kNormals[] = {"normal_x", "normal_y", "normal_z"};

Field& field_to_set(Cloud& cloud, const std::string& name)
{
    if (const Field* found = find_field(cloud, name))
        return cloud.fields[static_cast<std::size_t>(found - cloud.fields.data())];
    Field& added = cloud.fields.emplace_back();
    added.name = name;
    return added;
}

} // namespace

bool has_field(const Cloud& cloud, const std::string& name) { return find_field(cloud, name) != nullptr; }

Eigen::VectorXd field(const Cloud& cloud, const std::string& name)
{
    const Field* found = find_field(cloud, name);
    if (found == nullptr) throw InputError("the points have no field '" + name + "'");
    if (found->count != 1)
        throw InputError("field '" + name + "' has " + std::to_string(found->count) + " elements a point, expected 1");
    Eigen::VectorXd values(cloud.size());
    visit_element(found->type, found->size, [&](auto zero) {
        using T = decltype(zero);
        for (Eigen::Index i = 0; i < values.size(); ++i)
            values[i] = static_cast<double>(load<T>(found->bytes.data() + sizeof(T) * static_cast<std::size_t>(i)));
    });
    return values;
}

void set_field(Cloud& cloud, const std::string& name, const Eigen::VectorXd& values, int size)
{
    Field& target = field_to_set(cloud, name);
    target.type = 'F';
    target.size = size;
    target.count = 1;
    target.bytes.resize(static_cast<std::size_t>(values.size()) * static_cast<std::size_t>(size));
    visit_element('F', size, [&](auto zero) {
        using T = decltype(zero);
        for (Eigen::Index i = 0; i < values.size(); ++i)
            store(target.bytes.data() + sizeof(T) * static_cast<std::size_t>(i), static_cast<T>(values[i]));
    });
}

bool has_normals(const Cloud& cloud)
{
    return std::all_of(std::begin(kNormals), std::end(kNormals),
                       [&cloud](const std::string& name) { return has_field(cloud, name); });
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
    Field& target = field_to_set(cloud, "rgb");
    target.type = 'F'; // what viewers look for; the four bytes are 0x00RRGGBB all the same
    target.size = 4;
    target.count = 1;
    target.bytes.resize(4 * static_cast<std::size_t>(rgb.cols()));
    for (Eigen::Index i = 0; i < rgb.cols(); ++i) {
        const std::uint32_t packed = static_cast<std::uint32_t>(rgb(0, i)) << 16 |
                                     static_cast<std::uint32_t>(rgb(1, i)) << 8 | static_cast<std::uint32_t>(rgb(2, i));
        store(target.bytes.data() + 4 * static_cast<std::size_t>(i), packed);
    }
}

Cloud part(const Cloud& cloud, Eigen::Index first, Eigen::Index count)
{
    Cloud some;
    some.view_origin = cloud.view_origin;
    some.view_orientation = cloud.view_orientation;
    some.comment = cloud.comment;
    some.width = cloud.width;
    some.xyz = cloud.xyz.middleCols(first, count);
    for (const Field& from : cloud.fields) {
        const std::ptrdiff_t stride = std::ptrdiff_t{from.size} * from.count;
        const auto begin = from.bytes.begin() + first * stride;
        some.fields.push_back({from.name, from.type, from.size, from.count, {begin, begin + count * stride}});
    }
    return some;
}

Cloud select(const Cloud& cloud, const std::vector<Eigen::Index>& indices)
{
    Cloud chosen;
    chosen.view_origin = cloud.view_origin;
    chosen.view_orientation = cloud.view_orientation;
    chosen.comment = cloud.comment;
    chosen.xyz = cloud.xyz(Eigen::all, indices);
    for (const Field& from : cloud.fields) {
        Field to{from.name, from.type, from.size, from.count, {}};
        const std::size_t stride = static_cast<std::size_t>(from.size) * static_cast<std::size_t>(from.count);
        to.bytes.reserve(stride * indices.size());
        for (const Eigen::Index index : indices) {
            const auto first = from.bytes.begin() + index * static_cast<std::ptrdiff_t>(stride);
            to.bytes.insert(to.bytes.end(), first, first + static_cast<std::ptrdiff_t>(stride));
        }
        chosen.fields.push_back(std::move(to));
    }
    return chosen;
}

} // namespace fettle
