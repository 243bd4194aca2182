#include "view/view.h"

#include "core/error.h"
#include "draw/base64.h"
#include "draw/figures.h"
#include "draw/outline.h"
#include "geometry/statistics.h"
#include "job/region.h"
#include "view/encode.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

namespace fettle::view {
namespace {

using Eigen::Index;

const std::string& source_of(const Layer& layer) { return layer.source.empty() ? layer.name : layer.source; }

/// The scale of a field of a layer by itself.
draw::PictureScale own_scale(const Layer& layer, const std::string& field, const ViewOptions& options)
{
    draw::PictureOptions picture = options.picture;
    picture.field = field;
    if (field == "error" && options.error_limit) picture.scale = options.error_limit;
    // A mesh's heights are judged by what is seen of it, as in its picture.
    if (field == "z") return draw::picture_scale(as_shape(layer.part), picture);
    return draw::field_values(layer.part.points, field, picture.units, picture.job, picture).scale;
}

/// Scales of the fields by name, so wide that they hold those of all layers.
std::map<std::string, draw::PictureScale> shared_scales(const std::vector<Layer>& layers, const ViewOptions& options)
{
    std::map<std::string, draw::PictureScale> shared;
    for (const Layer& layer : layers)
        core::with_error_prefix(source_of(layer), [&] {
            for (const std::string& field : layer.fields) {
                const draw::PictureScale own = own_scale(layer, field, options);
                const auto [known, is_new] = shared.emplace(field, own);
                if (is_new) continue;
                known->second.low = std::min(known->second.low, own.low);
                known->second.high = std::max(known->second.high, own.high);
            }
        });
    return shared;
}

/// The colours of a legend from low to high, 256 times red, green, blue, in base64.
std::string legend_colours(const draw::PictureScale& scale)
{
    constexpr int kColours = 256;
    std::string bytes;
    for (int i = 0; i < kColours; ++i) {
        // A page looks the place of a value up, and so the value in the middle of each place is shown. Classes are few.
        const double value = std::lerp(scale.low, scale.high, (i + 0.5) / kColours);
        for (const std::uint8_t c : scale(value)) bytes += static_cast<char>(c);
    }
    return draw::base64(bytes);
}

std::vector<json::Value> described_classes(const draw::PictureScale& scale)
{
    std::vector<json::Value> classes;
    for (const draw::FieldClass& found : scale.classes)
        classes.push_back(
            json::Value()
                .set("value", found.value)
                .set("name", found.name)
                .set("count", found.count)
                .set("colour", Eigen::VectorXd(Eigen::Vector3d(found.colour[0], found.colour[1], found.colour[2]))));
    return classes;
}

/// Classes take the colours of equal steps, so that the page finds them as it finds those of numbers.
draw::PictureScale stepped(const draw::PictureScale& classes)
{
    draw::PictureScale scale = classes;
    const auto [low, high] = std::ranges::minmax(classes.classes, {}, &draw::FieldClass::value);
    scale.low = low.value - 0.5;
    scale.high = high.value + 0.5;
    return scale;
}

std::string stepped_colours(const draw::PictureScale& scale)
{
    draw::PictureScale rounded = scale;
    std::string bytes;
    constexpr int kColours = 256;
    for (int i = 0; i < kColours; ++i)
        for (const std::uint8_t c : rounded(std::round(std::lerp(scale.low, scale.high, (i + 0.5) / kColours))))
            bytes += static_cast<char>(c);
    return draw::base64(bytes);
}

/// The largest and the smallest error inside B with their places.
std::vector<json::Value> extremes(const Layer& layer, const Eigen::VectorXd& errors, const ViewOptions& options)
{
    std::vector<job::Region> region;
    if (options.picture.job) region = job::classify_regions(*options.picture.job, layer.part.points.xyz);
    Index max = -1, min = -1;
    for (Index i = 0; i < errors.size(); ++i) {
        if (!std::isfinite(errors[i]) || !layer.part.points.xyz.col(i).allFinite()) continue;
        if (!region.empty() && region[std::size_t(i)] != job::Region::inside) continue;
        if (max < 0 || errors[i] > errors[max]) max = i;
        if (min < 0 || errors[i] < errors[min]) min = i;
    }
    std::vector<json::Value> places;
    if (max < 0) return places;
    const std::string unit = " " + units::to_string(options.picture.units.length);
    // Below this share of the largest it is rounding, as in the pictures.
    constexpr double kMinRelative = 1e-4;
    const double largest = std::max(std::abs(errors[max]), std::abs(errors[min]));
    const auto add = [&](Index i, const std::string& name) {
        if (std::abs(errors[i]) <= kMinRelative * largest) return;
        places.push_back(
            json::Value()
                .set("point", Eigen::VectorXd(layer.part.points.xyz.col(i) / options.picture.units.mm()))
                .set("text", name + " " + (errors[i] > 0 ? "+" : "") + draw::short_text(errors[i]) + unit));
    };
    add(max, "max");
    if (min != max) add(min, "min");
    return places;
}

std::string summary(const Eigen::VectorXd& numbers, const ViewOptions& options, const std::string& unit)
{
    const geometry::Statistics s = geometry::statistics(numbers, Eigen::VectorXd::Zero(numbers.size()), std::nullopt);
    return std::string(options.picture.job ? "inside B: " : "") + "mean " + draw::short_text(s.mean) + ", min " +
           draw::short_text(s.min) + ", max " + draw::short_text(s.max) + (unit.empty() ? "" : " " + unit) + ", " +
           std::to_string(s.count) + " points";
}

ShownField shown_field(const Layer& layer, const std::string& name, draw::PictureScale scale,
                       const ViewOptions& options)
{
    const draw::PictureOptions& picture = options.picture;
    const draw::FieldValues own = draw::field_values(layer.part.points, name, picture.units, picture.job, picture);
    const std::string unit = draw::unit_of_field(name, picture.units);
    // Heights are shaded as on a map; the colours of other fields are read as numbers.
    constexpr double kHeightShading = 0.75, kFieldShading = 0.45;
    json::Value description;
    description.set("name", name).set("unit", unit).set("shading", name == "z" ? kHeightShading : kFieldShading);
    if (scale.packed) return {name, own.numbers, scale, description};
    const bool has_classes = !scale.classes.empty();
    if (has_classes) scale = stepped(own.scale);
    const Index undefined = own.numbers.size() - own.numbers.array().isFinite().count();
    std::vector<json::Value> ticks;
    for (const auto& [value, text] : draw::scale_ticks(scale))
        ticks.push_back(json::Value().set("value", value).set("text", text));
    description.set("low", scale.low)
        .set("high", scale.high)
        .set("diverging", scale.diverging)
        .set("colours", has_classes ? stepped_colours(scale) : legend_colours(scale))
        .set("ticks", ticks)
        .set("classes", described_classes(scale))
        .set("undefined", undefined)
        .set("lengthUnit", 1);
    if (name == "error") description.set("extremes", extremes(layer, own.numbers, options));
    // Vertices of a mesh lie as densely as its shape needs: their mean says nothing of the part.
    if (!has_classes && !(layer.part.is_mesh() && name == "z"))
        description.set("summary",
                        summary(draw::numbers_inside(layer.part.points.xyz, own.numbers, picture.job), options, unit));
    return {name, own.numbers, scale, description};
}

/// B and S on the first layer's surface.
json::Value described_boundaries(const std::vector<Layer>& layers, const ViewOptions& options)
{
    json::Value boundaries;
    if (!options.picture.job) return boundaries;
    const double mm = options.picture.units.mm();
    for (const draw::Outline& outline : draw::outlines_on(as_shape(layers.front().part), *options.picture.job))
        boundaries.set(outline.name, json::Value()
                                         .set("corners", Eigen::MatrixXd(outline.corners.topRows<2>().transpose() / mm))
                                         .set("line", Eigen::MatrixXd(outline.line.transpose() / mm)));
    return boundaries;
}

/// @param count  of the layers that are in it, from the first on
json::Value described_box(const std::vector<Layer>& layers, std::size_t count, double mm)
{
    Eigen::AlignedBox3d box;
    for (const Layer& layer : std::span(layers).first(count))
        for (const Eigen::Vector3d& p : layer.part.points.xyz.colwise())
            if (p.allFinite()) box.extend(p);
    if (box.isEmpty() && count < layers.size()) return described_box(layers, layers.size(), mm);
    if (box.isEmpty())
        throw core::InputError(source_of(layers.front()), "no point has a finite x, y and z: there is nothing to draw");
    return json::Value().set("min", Eigen::VectorXd(box.min() / mm)).set("max", Eigen::VectorXd(box.max() / mm));
}

/// JSON that is also text of an XML document.
draw::Html script_text(const json::Value& value)
{
    std::string safe;
    for (const char c : value.text())
        if (c == '<' || c == '>' || c == '&')
            safe += c == '<' ? "\\u003c" : c == '>' ? "\\u003e" : "\\u0026";
        else
            safe += c;
    return draw::Html::from_markup(safe);
}

} // namespace

draw::Html view_element(const std::vector<Layer>& layers, const ViewOptions& options, const draw::Html& fallback)
{
    const double mm = options.picture.units.mm();
    json::Value scene;
    scene.set("unit", units::to_string(options.picture.units.length))
        .set("box", described_box(layers, layers.size(), mm))
        .set("focus", described_box(layers, 1, mm));
    const std::map<std::string, draw::PictureScale> scales = shared_scales(layers, options);
    draw::Html blocks;
    std::vector<json::Value> described;
    for (const Layer& layer : layers) {
        std::vector<ShownField> fields;
        for (const std::string& name : layer.fields)
            fields.push_back(shown_field(layer, name, scales.at(name), options));
        EncodedLayer encoded = encode_layer(layer.part, fields, mm);
        described.push_back(encoded.description.set("name", layer.name));
        blocks += draw::element("script", {{"type", "text/plain"}, {"class", "block"}},
                                draw::Html::from_markup(std::move(encoded.block)));
    }
    scene.set("boundaries", described_boundaries(layers, options))
        .set("touches", Eigen::MatrixXd(options.touches.transpose() / mm))
        .set("pick", options.pick)
        .set("layers", described);
    if (const std::optional<job::Job>& job = options.picture.job; job && job->T_part_job) {
        Eigen::Matrix4d to_part = job->T_part_job->matrix();
        to_part.topRightCorner<3, 1>() /= mm;
        scene.set("toPart", Eigen::MatrixXd(to_part));
    }
    return draw::element(
        "div", {{"class", "fettle-view"}},
        draw::element("div", {{"class", "fallback"}}, fallback) +
            draw::element("script", {{"type", "application/json"}, {"class", "scene"}}, script_text(scene)) + blocks);
}

std::vector<std::string> default_fields(const cloud::Cloud& points)
{
    std::vector<std::string> fields = {cloud::has_field(points, "error") ? "error" : "z"};
    if (cloud::has_field(points, "class")) fields.emplace_back("class");
    return fields;
}

mesh::MeshOrCloud as_shape(const mesh::CloudMesh& part)
{
    if (part.is_mesh()) return mesh::Mesh{part.points.xyz, part.triangles, part.points.frame};
    return part.points;
}

} // namespace fettle::view
