#include "cloud/ply.h"

#include "cloud/element.h"
#include "cloud/ply_body.h"
#include "cloud/ply_header.h"
#include "core/error.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace fettle::cloud {

namespace {

using Property = PlyHeader::Property;
using Element = PlyHeader::Element;

template <typename Body>
std::size_t list_length(Body& body, const Property& property)
{
    const char type = property.count_signed ? 'I' : 'U';
    const std::size_t length = visit_element(type, property.count_size, [&](auto zero) {
        const auto number = body.template value<decltype(zero)>(property);
        if constexpr (std::is_signed_v<decltype(zero)>)
            if (number < 0) body.refuse("property " + property.name + ": a list of " + std::to_string(number));
        return static_cast<std::size_t>(number);
    });
    body.check_list_room(length);
    return length;
}

template <typename Body>
void skip(Body& body, const Property& property)
{
    const std::size_t length = property.list ? list_length(body, property) : 1;
    for (std::size_t k = 0; k < length; ++k)
        visit_element(property.type, property.size, [&](auto zero) { body.template value<decltype(zero)>(property); });
}

std::string field_name(const std::string& property)
{
    if (property == "nx" || property == "ny" || property == "nz") return "normal_" + property.substr(1);
    constexpr std::string_view kScalar = "scalar_"; // prefix that CloudCompare gives to scalar fields
    return property.starts_with(kScalar) && property.size() > kScalar.size() ? property.substr(kScalar.size())
                                                                             : property;
}

int axis_of(const Property& property)
{
    return property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : -1;
}

template <typename Body>
Cloud read_vertices(Body& body, const Element& element, const std::string& source)
{
    Cloud cloud;
    cloud.xyz.resize(3, element.count);
    int axes = 0;
    for (const Property& property : element.properties) {
        if (axis_of(property) >= 0 && !property.list) {
            ++axes;
        } else if (!property.list) {
            if (has_field(cloud, field_name(property.name)))
                throw core::InputError(source,
                                       "element vertex: field '" + field_name(property.name) + "' is duplicated");
            cloud.fields.push_back({field_name(property.name), property.type, property.size, 1, {}});
            cloud.fields.back().bytes.resize(element.count * property.size);
        }
    }
    if (axes != 3) throw core::InputError(source, "element vertex without x, y and z");
    for (std::size_t i = 0; i < element.count; ++i) {
        body.begin_item(element.name, i);
        std::size_t f = 0;
        for (const Property& property : element.properties) {
            if (property.list) {
                skip(body, property);
                continue;
            }
            const int axis = axis_of(property);
            visit_element(property.type, property.size, [&](auto zero) {
                const auto number = body.template value<decltype(zero)>(property);
                if (axis >= 0)
                    cloud.xyz(axis, i) = static_cast<double>(number);
                else
                    store(cloud.fields[f].bytes.data() + i * sizeof number, number);
            });
            if (axis < 0) ++f;
        }
        body.end_item();
    }
    return cloud;
}

/// Joins red, green and blue of one byte each to the one field `rgb` that such properties are written for, in the place
/// of the first of them.
void join_colours(Cloud& cloud)
{
    std::array<std::vector<Field>::iterator, 3> channels;
    constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
    for (std::size_t k = 0; k < kChannels.size(); ++k) {
        channels[k] = std::ranges::find(cloud.fields, kChannels[k], &Field::name);
        if (channels[k] == cloud.fields.end() || channels[k]->size != 1 || channels[k]->type != 'U') return;
    }
    if (has_field(cloud, "rgb")) return;
    Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> rgb(3, cloud.size());
    for (Eigen::Index i = 0; i < cloud.size(); ++i)
        for (Eigen::Index k = 0; k < 3; ++k)
            rgb(k, i) = std::to_integer<std::uint8_t>(channels[std::size_t(k)]->bytes[std::size_t(i)]);
    const auto place = std::distance(cloud.fields.begin(), *std::ranges::min_element(channels));
    std::erase_if(cloud.fields, [&](const Field& field) { return std::ranges::count(kChannels, field.name) > 0; });
    set_colours(cloud, rgb);
    std::rotate(cloud.fields.begin() + place, cloud.fields.end() - 1, cloud.fields.end());
}

bool is_corner_list(const Property& property)
{
    return property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

template <typename Body>
void read_face(Body& body, const Property& property, std::size_t vertices, Ply& ply)
{
    const std::size_t length = list_length(body, property);
    if (length < 3) body.refuse("a face of " + std::to_string(length) + " corners");
    for (std::size_t k = 0; k < length; ++k) {
        const auto corner = visit_element(property.type, property.size, [&](auto zero) {
            return static_cast<std::int64_t>(body.template value<decltype(zero)>(property));
        });
        if (corner < 0 || corner >= static_cast<std::int64_t>(vertices))
            body.refuse("vertex " + std::to_string(corner) + " of " + std::to_string(vertices));
        ply.corners.push_back(static_cast<std::uint32_t>(corner));
    }
    ply.ends.push_back(ply.corners.size());
}

template <typename Body>
void read_faces(Body& body, const Element& element, std::size_t vertices, Ply& ply, const std::string& source)
{
    const auto corners = std::find_if(element.properties.begin(), element.properties.end(), is_corner_list);
    if (corners == element.properties.end())
        throw core::InputError(source, "element face without the list vertex_indices");
    if (corners->type == 'F') throw core::InputError(source, "element face: vertex_indices are not integers");
    for (std::size_t i = 0; i < element.count; ++i) {
        body.begin_item(element.name, i);
        for (const Property& property : element.properties)
            if (&property == &*corners)
                read_face(body, property, vertices, ply);
            else
                skip(body, property);
        body.end_item();
    }
}

template <typename Body>
Ply read_body(Body body, const PlyHeader& header, const std::string& source)
{
    Ply ply;
    const std::size_t vertices = std::ranges::find(header.elements, "vertex", &Element::name)->count;
    for (const Element& element : header.elements) {
        if (element.count > 0 && element.properties.empty())
            throw core::InputError(source, "element " + element.name + " without a property");
        if (element.count > 0) body.check_room(element);
        if (element.name == "vertex") {
            ply.vertices = read_vertices(body, element, source);
            join_colours(ply.vertices);
        } else if (element.name == "face") {
            if (element.count > 0) read_faces(body, element, vertices, ply, source);
        } else {
            for (std::size_t i = 0; i < element.count; ++i) {
                body.begin_item(element.name, i);
                for (const Property& property : element.properties) skip(body, property);
                body.end_item();
            }
        }
    }
    body.end();
    return ply;
}

} // namespace

Ply parse_ply(std::string_view bytes, const std::string& source)
{
    const PlyHeader header = parse_ply_header(bytes, source);
    if (std::ranges::find(header.elements, "vertex", &Element::name) == header.elements.end())
        throw core::InputError(source, "PLY without element vertex");
    const std::string_view body = bytes.substr(header.body);
    Ply ply = header.encoding == PlyHeader::Encoding::ascii
                  ? read_body(AsciiPlyBody(body, header.lines, source), header, source)
                  : read_body(BinaryPlyBody(body, header.encoding == PlyHeader::Encoding::big_endian, source), header,
                              source);
    ply.vertices.frame = header.frame;
    return ply;
}

bool looks_like_ply(std::string_view bytes) { return bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n"); }

bool ply_has_faces(std::string_view bytes)
{
    if (!looks_like_ply(bytes)) return false;
    try {
        for (const Element& element : parse_ply_header(bytes, "").elements)
            if (element.name == "face") return element.count > 0;
    } catch (const core::InputError&) { // parse_ply() will report it
    }
    return false;
}

} // namespace fettle::cloud
