#include "diff/diff.h"

#include "cloud/fields.h"
#include "cloud/pcd.h"
#include "core/constants.h"
#include "core/content.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/mesh_file.h"
#include "mesh/stl.h"
#include "json/leaves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

namespace fettle::diff {

namespace {

/// Compares values and collects the differences.
class ValueComparison {
  public:
    explicit ValueComparison(const Tolerance& tolerance) : tolerance_(tolerance) {}

    /// Compares numbers. @param position  function that returns where they are
    template <typename Position>
    void compare(double a, double b, const Position& position)
    {
        ++result_.values;
        if (a == b || (std::isnan(a) && std::isnan(b))) return;
        const double size = std::isfinite(a) && std::isfinite(b) ? std::abs(a - b) : core::kInfinity;
        const double allowed = tolerance_.absolute + tolerance_.relative * std::max(std::abs(a), std::abs(b));
        add(size, size == core::kInfinity || size > allowed,
            [&] { return position() + ": " + core::to_text(a) + " against " + core::to_text(b); });
    }

    /// Counts values that are not numbers. @param text  function that returns the message
    template <typename Text>
    void compare_other(bool equal, const Text& text)
    {
        ++result_.values;
        if (!equal) add(core::kInfinity, true, text);
    }

    void compare_structure(const std::string& what, const std::string& a, const std::string& b)
    {
        if (a != b) add_structure(what + ": " + a + " against " + b);
    }
    void add_structure(const std::string& line) { result_.structure.push_back(line); }
    void add_equal_values(std::size_t count) { result_.values += count; }
    const Difference& result() const { return result_; }

  private:
    template <typename Text>
    void add(double size, bool unequal, const Text& text)
    {
        result_.unequal += unequal;
        if (size <= result_.largest) return;
        result_.largest = size;
        result_.where = text();
    }

    Tolerance tolerance_;
    Difference result_;
};

using Leaves = std::vector<json::Leaf>;

void compare_json(const Leaves& leaves_a, const std::string& name_a, const Leaves& leaves_b, const std::string& name_b,
                  ValueComparison& values)
{
    std::map<std::string, const json::Leaf*> unmatched;
    for (const json::Leaf& leaf : leaves_b) unmatched[leaf.path] = &leaf;
    for (const json::Leaf& leaf : leaves_a) {
        const auto found = unmatched.find(leaf.path);
        if (found == unmatched.end()) {
            values.add_structure(leaf.path + ": only in " + name_a);
            continue;
        }
        const json::Leaf& other = *found->second;
        const double* number_a = std::get_if<double>(&leaf.value);
        const double* number_b = std::get_if<double>(&other.value);
        if (number_a != nullptr && number_b != nullptr)
            values.compare(*number_a, *number_b, [&] { return leaf.path; });
        else
            values.compare_other(leaf.value == other.value, [&] {
                return leaf.path + ": " + json::to_text(leaf) + " against " + json::to_text(other);
            });
        unmatched.erase(found);
    }
    for (const json::Leaf& leaf : leaves_b) // in the order of the file
        if (unmatched.contains(leaf.path)) values.add_structure(leaf.path + ": only in " + name_b);
}

std::string field_list(const cloud::Cloud& cloud)
{
    std::string list = "x y z";
    for (const cloud::Field& field : cloud.fields)
        list += ' ' + field.name + (field.count == 1 ? "" : "[" + std::to_string(field.count) + "]");
    return list;
}

std::string unit_list(const units::Units& units)
{
    return units::to_string(units.length) + ' ' + units::to_string(units.force);
}

// Colours are packed into four bytes, whatever the field's type is; as floats they would be tiny numbers or NaN.
bool is_colour(const cloud::Field& field)
{
    return (field.name == "rgb" || field.name == "rgba") && field.size == 4 && field.count == 1;
}

void compare_field(const cloud::Field& a, const cloud::Field& b, double unit, ValueComparison& values)
{
    const std::size_t elements = a.bytes.size() / a.size;
    if (a.type == b.type && a.size == b.size && a.bytes == b.bytes) return values.add_equal_values(elements);
    const bool colours = is_colour(a) && is_colour(b);
    for (std::size_t i = 0; i < elements; ++i) {
        const double value_a = colours ? cloud::element(a, 'U', i) : cloud::element(a, a.type, i);
        const double value_b = colours ? cloud::element(b, 'U', i) : cloud::element(b, b.type, i);
        values.compare(value_a / unit, value_b / unit, [&] {
            return "point " + std::to_string(i / a.count) + ", " + a.name +
                   (a.count == 1 ? "" : "[" + std::to_string(i % a.count) + "]");
        });
    }
}

void compare_viewpoint(const cloud::Cloud& a, const cloud::Cloud& b, double unit, ValueComparison& values)
{
    for (int axis = 0; axis < 3; ++axis)
        values.compare(a.view_origin[axis] / unit, b.view_origin[axis] / unit,
                       [&] { return "VIEWPOINT, origin " + std::string(1, "xyz"[axis]); });
    for (int part = 0; part < 4; ++part)
        values.compare(a.view_orientation.coeffs()[part], b.view_orientation.coeffs()[part],
                       [&] { return "VIEWPOINT, orientation " + std::string(1, "xyzw"[part]); });
}

void compare_clouds(const cloud::CloudFile& file_a, const cloud::CloudFile& file_b, ValueComparison& values)
{
    const cloud::Cloud& a = file_a.cloud;
    const cloud::Cloud& b = file_b.cloud;
    values.compare_structure("units", unit_list(file_a.units), unit_list(file_b.units));
    values.compare_structure("fields", field_list(a), field_list(b));
    values.compare_structure("points", std::to_string(a.size()), std::to_string(b.size()));
    values.compare_structure("width", std::to_string(a.width), std::to_string(b.width));
    if (!values.result().structure.empty()) return; // the values cannot be compared
    const double unit = file_a.units.mm();
    compare_viewpoint(a, b, unit, values);
    for (Eigen::Index i = 0; i < a.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            values.compare(a.xyz(axis, i) / unit, b.xyz(axis, i) / unit,
                           [&] { return "point " + std::to_string(i) + ", " + "xyz"[axis]; });
    for (std::size_t f = 0; f < a.fields.size(); ++f)
        compare_field(a.fields[f], b.fields[f],
                      units::base_unit_factor(file_a.units, cloud::field_dimension(a.fields[f].name)), values);
}

/// A mesh, and what reading it dropped.
struct MeshFile {
    mesh::Mesh mesh;
    mesh::MeshRepair repair;
};

void compare_meshes(const MeshFile& file_a, const MeshFile& file_b, ValueComparison& values)
{
    const mesh::Mesh &a = file_a.mesh, &b = file_b.mesh;
    const auto compare_counts = [&](const char* what, Eigen::Index of_a, Eigen::Index of_b) {
        values.compare_structure(what, std::to_string(of_a), std::to_string(of_b));
    };
    compare_counts("triangles", a.triangles.cols(), b.triangles.cols());
    compare_counts("triangles with NaN or infinite corners", file_a.repair.dropped_triangles,
                   file_b.repair.dropped_triangles);
    compare_counts("vertices of no triangle", file_a.repair.unused_vertices, file_b.repair.unused_vertices);
    if (!values.result().structure.empty()) return;
    for (Eigen::Index t = 0; t < a.triangles.cols(); ++t)
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                values.compare(a.vertices(axis, a.triangles(k, t)), b.vertices(axis, b.triangles(k, t)), [&] {
                    return "triangle " + std::to_string(t) + ", corner " + std::to_string(k) + ", " + "xyz"[axis];
                });
}

using Content = std::variant<Leaves, cloud::CloudFile, MeshFile>;

Content read_content(std::string_view bytes, const std::string& name)
{
    const std::string_view text = core::strip_byte_order_mark(bytes, name);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) throw core::InputError(name, "empty");
    if (text[first] == '{' || text[first] == '[') return json::flatten(bytes, name);
    if (mesh::looks_like_cloud(bytes)) return cloud::parse_cloud(bytes, name);
    if (!mesh::is_binary_stl(bytes) && !mesh::looks_like_damaged_stl(bytes))
        core::refuse_other_content(bytes, name, "points, a mesh or JSON");
    MeshFile file;
    file.mesh = mesh::parse_mesh(bytes, name, units::Units::Length::mm, &file.repair);
    return file;
}

std::string kind_of(const Content& content)
{
    return std::holds_alternative<Leaves>(content)             ? "JSON"
           : std::holds_alternative<cloud::CloudFile>(content) ? "points"
                                                               : "a mesh";
}

} // namespace

Difference compare_contents(std::string_view a, const std::string& name_a, std::string_view b,
                            const std::string& name_b, const Tolerance& tolerance)
{
    ValueComparison values(tolerance);
    const Content content_a = read_content(a, name_a);
    const Content content_b = read_content(b, name_b);
    values.compare_structure("kind", kind_of(content_a), kind_of(content_b));
    if (content_a.index() != content_b.index()) return values.result();
    if (const auto* leaves = std::get_if<Leaves>(&content_a))
        compare_json(*leaves, name_a, std::get<Leaves>(content_b), name_b, values);
    else if (const auto* cloud = std::get_if<cloud::CloudFile>(&content_a))
        compare_clouds(*cloud, std::get<cloud::CloudFile>(content_b), values);
    else
        compare_meshes(std::get<MeshFile>(content_a), std::get<MeshFile>(content_b), values);
    return values.result();
}

} // namespace fettle::diff
