#include "diff/diff.h"

#include "cloud/fields.h"
#include "cloud/pcd.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "mesh/mesh_file.h"
#include "json/leaves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <variant>

namespace fettle {

namespace {

/// Counts the values compared and remembers the largest difference.
class Tally {
  public:
    explicit Tally(const Tolerance& tolerance) : tolerance_(tolerance) {}

    template <typename Place>
    void number(double a, double b, const Place& place)
    {
        ++found_.values;
        if (a == b || (std::isnan(a) && std::isnan(b))) return;
        const double by = std::isfinite(a) && std::isfinite(b) ? std::abs(a - b) : kInfinite;
        const double allowed = tolerance_.absolute + tolerance_.relative * std::max(std::abs(a), std::abs(b));
        const bool unequal = by == kInfinite || by > allowed;
        note(by, unequal, [&] { return place() + ": " + to_text(a) + " against " + to_text(b); });
    }

    template <typename Text>
    void other(bool equal, const Text& text)
    {
        ++found_.values;
        if (!equal) note(kInfinite, true, text);
    }

    void structure(const std::string& line) { found_.structure.push_back(line); }
    void same_structure(const std::string& what, const std::string& a, const std::string& b)
    {
        if (a != b) structure(what + ": " + a + " against " + b);
    }
    void equal_values(std::size_t count) { found_.values += count; }
    Difference result() const { return found_; }

  private:
    template <typename Text>
    void note(double by, bool unequal, const Text& text)
    {
        if (unequal) ++found_.unequal;
        if (by <= found_.largest) return;
        found_.largest = by;
        found_.where = text();
    }

    static constexpr double kInfinite = std::numeric_limits<double>::infinity();
    Tolerance tolerance_;
    Difference found_;
};

using Leaves = std::vector<json::Leaf>;

void compare_json(const Leaves& leaves_a, const std::string& name_a, const Leaves& leaves_b, const std::string& name_b,
                  Tally& tally)
{
    std::map<std::string, const json::Leaf*> others;
    for (const json::Leaf& leaf : leaves_b) others[leaf.path] = &leaf;
    for (const json::Leaf& leaf : leaves_a) {
        const auto found = others.find(leaf.path);
        if (found == others.end()) {
            tally.structure(leaf.path + ": only in " + name_a);
            continue;
        }
        const json::Leaf& other = *found->second;
        const double* number_a = std::get_if<double>(&leaf.value);
        const double* number_b = std::get_if<double>(&other.value);
        if (number_a != nullptr && number_b != nullptr)
            tally.number(*number_a, *number_b, [&] { return leaf.path; });
        else
            tally.other(leaf.value == other.value,
                        [&] { return leaf.path + ": " + json::to_text(leaf) + " against " + json::to_text(other); });
        others.erase(found);
    }
    for (const json::Leaf& leaf : leaves_b) // in the order of the file
        if (others.contains(leaf.path)) tally.structure(leaf.path + ": only in " + name_b);
}

std::string field_list(const Cloud& cloud)
{
    std::string list = "x y z";
    for (const Field& field : cloud.fields)
        list += ' ' + field.name + (field.count == 1 ? "" : "[" + std::to_string(field.count) + "]");
    return list;
}

std::string unit_list(const Units& units) { return to_string(units.length) + ' ' + to_string(units.force); }

// Colours are four bytes, whatever the type says; as floats they would be tiny numbers or NaN.
bool is_colour(const Field& field)
{
    return (field.name == "rgb" || field.name == "rgba") && field.size == 4 && field.count == 1;
}

void compare_field(const Field& a, const Field& b, double unit, Tally& tally)
{
    const auto elements = a.bytes.size() / static_cast<std::size_t>(a.size);
    if (a.type == b.type && a.size == b.size && a.bytes == b.bytes) return tally.equal_values(elements);
    const bool colours = is_colour(a) && is_colour(b);
    for (std::size_t i = 0; i < elements; ++i) {
        const double value_a = colours ? element(a, 'U', i) : element(a, a.type, i);
        const double value_b = colours ? element(b, 'U', i) : element(b, b.type, i);
        tally.number(value_a / unit, value_b / unit, [&] {
            const std::size_t count = static_cast<std::size_t>(a.count);
            return "point " + std::to_string(i / count) + ", " + a.name +
                   (count == 1 ? "" : "[" + std::to_string(i % count) + "]");
        });
    }
}

void compare_viewpoint(const Cloud& a, const Cloud& b, double unit, Tally& tally)
{
    for (int axis = 0; axis < 3; ++axis)
        tally.number(a.view_origin[axis] / unit, b.view_origin[axis] / unit,
                     [&] { return "VIEWPOINT, origin " + std::string(1, "xyz"[axis]); });
    for (int part = 0; part < 4; ++part)
        tally.number(a.view_orientation.coeffs()[part], b.view_orientation.coeffs()[part],
                     [&] { return "VIEWPOINT, orientation " + std::string(1, "xyzw"[part]); });
}

void compare_clouds(const CloudFile& file_a, const CloudFile& file_b, Tally& tally)
{
    const Cloud& a = file_a.cloud;
    const Cloud& b = file_b.cloud;
    tally.same_structure("units", unit_list(file_a.units), unit_list(file_b.units));
    tally.same_structure("fields", field_list(a), field_list(b));
    tally.same_structure("points", std::to_string(a.size()), std::to_string(b.size()));
    tally.same_structure("width", std::to_string(a.width), std::to_string(b.width));
    if (!tally.result().structure.empty()) return; // nothing to hold against each other
    const double unit = file_a.units.mm();
    compare_viewpoint(a, b, unit, tally);
    for (Eigen::Index i = 0; i < a.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            tally.number(a.xyz(axis, i) / unit, b.xyz(axis, i) / unit,
                         [&] { return "point " + std::to_string(i) + ", " + "xyz"[axis]; });
    for (std::size_t f = 0; f < a.fields.size(); ++f)
        compare_field(a.fields[f], b.fields[f], to_base(file_a.units, field_dimension(a.fields[f].name)), tally);
}

void compare_meshes(const Mesh& a, const Mesh& b, Tally& tally)
{
    tally.same_structure("triangles", std::to_string(a.triangles.cols()), std::to_string(b.triangles.cols()));
    if (!tally.result().structure.empty()) return;
    for (Eigen::Index t = 0; t < a.triangles.cols(); ++t)
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                tally.number(a.vertices(axis, a.triangles(k, t)), b.vertices(axis, b.triangles(k, t)), [&] {
                    return "triangle " + std::to_string(t) + ", corner " + std::to_string(k) + ", " + "xyz"[axis];
                });
}

using Content = std::variant<Leaves, CloudFile, Mesh>;

Content read_content(std::string_view bytes, const std::string& name)
{
    const std::string_view text = without_mark(bytes, name);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) throw InputError(name, "empty");
    if (text[first] == '{' || text[first] == '[') return json::leaves(bytes, name);
    if (looks_like_cloud(bytes)) return parse_cloud(bytes, name);
    return parse_mesh(bytes, name);
}

std::string kind_of(const Content& content)
{
    return std::holds_alternative<Leaves>(content)      ? "JSON"
           : std::holds_alternative<CloudFile>(content) ? "points"
                                                        : "a mesh";
}

} // namespace

Difference difference(std::string_view a, const std::string& name_a, std::string_view b, const std::string& name_b,
                      const Tolerance& tolerance)
{
    Tally tally(tolerance);
    const Content content_a = read_content(a, name_a);
    const Content content_b = read_content(b, name_b);
    tally.same_structure("kind", kind_of(content_a), kind_of(content_b));
    if (content_a.index() != content_b.index()) return tally.result();
    if (const auto* leaves = std::get_if<Leaves>(&content_a))
        compare_json(*leaves, name_a, std::get<Leaves>(content_b), name_b, tally);
    else if (const auto* cloud = std::get_if<CloudFile>(&content_a))
        compare_clouds(*cloud, std::get<CloudFile>(content_b), tally);
    else
        compare_meshes(std::get<Mesh>(content_a), std::get<Mesh>(content_b), tally);
    return tally.result();
}

} // namespace fettle
