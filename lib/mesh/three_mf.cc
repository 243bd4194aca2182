#include "mesh/three_mf.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "core/xml.h"
#include "core/zip.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace fettle::mesh {
namespace {

constexpr std::string_view kModelType = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// Use of an object by a build item or by a component.
struct Instance {
    std::uint32_t object = 0;
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
};

/// An object: a mesh, or components.
struct Object {
    std::vector<Eigen::Vector3d> vertices;
    std::vector<Eigen::Vector3i> triangles;
    std::vector<Instance> components;
};

std::string_view required(const core::XmlAttributes& attributes, const std::string& name)
{
    const auto text = attributes.find(name);
    if (!text) throw core::InputError("attribute '" + name + "' is missing");
    return *text;
}

double number(const core::XmlAttributes& attributes, const std::string& name)
{
    const std::string_view text = required(attributes, name);
    const auto value = core::parse_number(text);
    if (!value || !std::isfinite(*value)) throw core::InputError(name + ": " + core::in_quotes(text) + " is no number");
    return *value;
}

template <typename Integer>
Integer integer(const core::XmlAttributes& attributes, const std::string& name)
{
    const std::string_view text = required(attributes, name);
    const auto value = core::parse_integer<Integer>(text);
    if (!value || *value < 0)
        throw core::InputError(name + ": " + core::in_quotes(text) + " is no whole number from 0");
    return *value;
}

double unit_in_mm(std::string_view unit)
{
    constexpr std::array<std::pair<std::string_view, double>, 6> kUnits = {
        {{"micron", 1e-3}, {"millimeter", 1}, {"centimeter", 10}, {"inch", 25.4}, {"foot", 304.8}, {"meter", 1000}}};
    for (const auto& [name, mm] : kUnits)
        if (name == unit) return mm;
    throw core::InputError("unit " + core::in_quotes(unit) + " is unknown");
}

/// Twelve numbers, the rows of a 4 x 3 matrix that is applied to row vectors.
Eigen::Affine3d transform(const core::XmlAttributes& attributes)
{
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    const auto text = attributes.find("transform");
    if (!text) return result;
    const auto words = core::words(*text);
    constexpr std::size_t kNumbers = 12;
    if (words.size() != kNumbers)
        throw core::InputError("a transform has 12 numbers, not " + std::to_string(words.size()));
    for (std::size_t i = 0; i < kNumbers; ++i) {
        const auto value = core::parse_number(words[i]);
        if (!value || !std::isfinite(*value))
            throw core::InputError("transform: " + core::in_quotes(words[i]) + " is no number");
        result.matrix()(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(i / 3)) = *value;
    }
    if (result.linear().determinant() == 0) throw core::InputError("a transform has no inverse");
    return result;
}

/// The model's XML.
class ModelReader : public core::XmlHandler {
  public:
    std::map<std::uint32_t, Object> objects;
    std::vector<Instance> items;
    double unit_mm = 1;
    bool is_model = false;

    void begin(std::string_view name, const core::XmlAttributes& attributes) override
    {
        if (depth_++ == 0) return begin_model(name, attributes);
        if (name == "object") {
            const auto id = integer<std::uint32_t>(attributes, "id");
            const auto [place, is_new] = objects.try_emplace(id);
            if (!is_new) throw core::InputError("object " + std::to_string(id) + " is defined twice");
            object_ = &place->second;
        } else if (name == "item") {
            items.push_back({integer<std::uint32_t>(attributes, "objectid"), transform(attributes)});
        } else if (object_ != nullptr) {
            begin_in_object(name, attributes);
        }
    }

    void end(std::string_view name) override
    {
        --depth_;
        if (name == "object") object_ = nullptr;
    }

  private:
    void begin_model(std::string_view name, const core::XmlAttributes& attributes)
    {
        is_model = name == "model";
        unit_mm = unit_in_mm(attributes.find("unit").value_or("millimeter"));
        const std::string_view extensions = attributes.find("requiredextensions").value_or("");
        if (!core::words(extensions).empty())
            throw core::InputError("requires extensions that are not read: " + core::in_quotes(extensions));
    }

    void begin_in_object(std::string_view name, const core::XmlAttributes& attributes)
    {
        if (name == "vertex") {
            object_->vertices.emplace_back(number(attributes, "x"), number(attributes, "y"), number(attributes, "z"));
        } else if (name == "triangle") {
            Eigen::Vector3i corners;
            for (int k = 0; k < 3; ++k) {
                corners[k] = integer<int>(attributes, "v" + std::to_string(k + 1));
                if (static_cast<std::size_t>(corners[k]) >= object_->vertices.size())
                    throw core::InputError("vertex " + std::to_string(corners[k]) + " of a triangle, there are " +
                                           std::to_string(object_->vertices.size()));
            }
            object_->triangles.push_back(corners);
        } else if (name == "component") {
            object_->components.push_back({integer<std::uint32_t>(attributes, "objectid"), transform(attributes)});
        }
    }

    Object* object_ = nullptr; // whose element is open
    int depth_ = 0;
};

/// The target of the relationship to the model.
class RelationshipReader : public core::XmlHandler {
  public:
    std::string model;

    void begin(std::string_view name, const core::XmlAttributes& attributes) override
    {
        if (name == "Relationship" && attributes.find("Type") == kModelType) model = required(attributes, "Target");
    }
    void end(std::string_view) override {}
};

void parse_file(const core::ZipArchive& archive, const std::string& name, core::XmlHandler& handler,
                const std::string& source)
{
    const std::string place = source + ": " + name;
    core::XmlParser parser(handler, place);
    archive.read(name, [&](std::string_view piece) {
        parser.feed(piece);
        return true;
    });
    parser.finish();
}

/// Name of the model in the archive.
std::string model_name(const core::ZipArchive& archive, const std::string& source)
{
    RelationshipReader relationships;
    if (archive.has("_rels/.rels")) parse_file(archive, "_rels/.rels", relationships, source);
    if (relationships.model.empty()) throw core::InputError(source, "a ZIP archive without a 3MF model");
    return relationships.model.substr(relationships.model.starts_with('/') ? 1 : 0);
}

/// Joins what is built.
class Assembly {
  public:
    Assembly(const ModelReader& model, const std::string& source) : model_(model), source_(source) {}

    Mesh joined()
    {
        for (const Instance& item : model_.items) add(item, Eigen::Affine3d::Identity(), 0);
        Mesh mesh;
        mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
        for (std::size_t i = 0; i < vertices_.size(); ++i)
            mesh.vertices.col(static_cast<Eigen::Index>(i)) = vertices_[i];
        mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles_[t];
        return mesh;
    }

  private:
    void add(const Instance& instance, const Eigen::Affine3d& outer, int depth)
    {
        // Components of components multiply: a short file could ask for any number of triangles.
        constexpr int kMaxDepth = 32;
        constexpr std::size_t kMaxInstances = 100'000, kMaxVertices = 100'000'000;
        if (depth > kMaxDepth) throw core::InputError(source_, "3MF: components are nested too deep, or in a circle");
        if (++instances_ > kMaxInstances) throw core::InputError(source_, "3MF: more than 100000 components");
        const auto found = model_.objects.find(instance.object);
        if (found == model_.objects.end())
            throw core::InputError(source_, "3MF: object " + std::to_string(instance.object) + " does not exist");
        const Object& object = found->second;
        const Eigen::Affine3d transform = outer * instance.transform;
        for (const Instance& component : object.components) add(component, transform, depth + 1);
        const std::size_t first = vertices_.size();
        if (first + object.vertices.size() > kMaxVertices)
            throw core::InputError(source_, "3MF: more than 100 million vertices");
        for (const Eigen::Vector3d& vertex : object.vertices) vertices_.emplace_back(transform * vertex);
        const bool is_mirrored = transform.linear().determinant() < 0;
        for (Eigen::Vector3i corners : object.triangles) {
            if (is_mirrored) std::swap(corners[1], corners[2]);
            triangles_.emplace_back(corners.array() + static_cast<int>(first));
        }
    }

    const ModelReader& model_;
    const std::string& source_;
    std::vector<Eigen::Vector3d> vertices_;
    std::vector<Eigen::Vector3i> triangles_;
    std::size_t instances_ = 0;
};

} // namespace

ThreeMf parse_three_mf(std::string_view bytes, const std::string& source)
{
    const core::ZipArchive archive(bytes, source);
    ModelReader model;
    parse_file(archive, model_name(archive, source), model, source);
    if (!model.is_model) throw core::InputError(source, "3MF: its XML is no model");
    if (model.items.empty()) throw core::InputError(source, "3MF: nothing is built");
    return {Assembly(model, source).joined(), model.unit_mm};
}

double three_mf_unit(std::string_view bytes, const std::string& source)
{
    const core::ZipArchive archive(bytes, source);
    ModelReader model;
    const std::string name = model_name(archive, source), place = source + ": " + name;
    core::XmlParser parser(model, place);
    archive.read(name, [&](std::string_view piece) {
        parser.feed(piece);
        return !model.is_model;
    });
    return model.unit_mm;
}

bool looks_like_three_mf(std::string_view bytes) { return core::looks_like_zip(bytes); }

} // namespace fettle::mesh
