#include "part/anomalies.h"

#include "core/constants.h"
#include "part/outline.h"

#include <cmath>

namespace fettle::part {
namespace {

using Eigen::Vector2d;

// A wall must lean, because anomalies are heights over x-y. Below one degree its triangles become slivers.
const core::Range kDraftDegrees = core::Range::between(1, 80);

double read_length(json::Reader& reader, const char* key, double mm)
{
    return mm * reader.number(key, core::Range::positive());
}

double read_draft(json::Reader& reader)
{
    return reader.number_or("draft_deg", 10, kDraftDegrees) * core::kRadPerDegree;
}

RidgeSection read_section(json::Reader& reader, double mm, const std::string& default_section)
{
    RidgeSection section;
    section.width = read_length(reader, "width", mm);
    section.height = read_length(reader, "height", mm);
    section.round = reader.choice_or("section", default_section, {"round", "flat"}) == "round";
    const double half = section.width / 2;
    if (section.round) {
        if (section.height > half) reader.refuse("height", "a round section is at most half as high as wide");
    } else {
        section.draft = read_draft(reader);
        if (section.height * std::tan(section.draft) > half)
            reader.refuse("height", "the flanks meet below it: decrease it or draft_deg, or increase width");
    }
    return section;
}

Anomaly read_ridge(json::Reader& reader, double mm, const std::string& section)
{
    const Eigen::Matrix2Xd path = mm * reader.matrix("path", 2).transpose();
    if (path.cols() < 2) reader.refuse("path", "needs 2 points or more, got " + std::to_string(path.cols()));
    return ridge_along(path, read_section(reader, mm, section));
}

Anomaly read_ring(json::Reader& reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const double radius = read_length(reader, "radius", mm);
    const RidgeSection section = read_section(reader, mm, "round");
    if (section.width > 2 * radius) reader.refuse("width", "must be at most twice the radius");
    return ring(centre, radius, section);
}

Anomaly read_dot(json::Reader& reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const double radius = read_length(reader, "radius", mm), height = read_length(reader, "height", mm);
    if (height > radius) reader.refuse("height", "a dome is at most as high as its radius");
    return dot(centre, radius, height);
}

Anomaly read_stub(json::Reader& reader, double mm)
{
    const Eigen::Matrix2Xd outline = read_outline(reader.object("outline"), mm);
    SlopedTop top;
    top.low = read_length(reader, "height", mm);
    top.high = mm * reader.number_or("height_end", top.low / mm, core::Range::positive());
    top.direction = reader.number_or("direction_deg", 0) * core::kRadPerDegree;
    return stub(outline, top, read_draft(reader));
}

Anomaly read_blob(json::Reader& reader, double mm)
{
    const Eigen::Matrix2Xd outline = read_outline(reader.object("outline"), mm);
    const double height = read_length(reader, "height", mm);
    return blob(outline, height, read_length(reader, "falloff", mm));
}

Anomaly read_hill(json::Reader& reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const Vector2d axes = mm * reader.vector("semi_axes", 2);
    if (!(axes.minCoeff() > 0)) reader.refuse("semi_axes", "must be positive");
    const double angle = reader.number_or("angle_deg", 0) * core::kRadPerDegree;
    return hill(centre, axes, angle, read_length(reader, "height", mm));
}

Anomaly read_shape(json::Reader& reader, double mm)
{
    const std::string type = reader.choice("type", {"bead", "burr", "ring", "dot", "stub", "blob", "hill"});
    if (type == "bead") return read_ridge(reader, mm, "round");
    if (type == "burr") return read_ridge(reader, mm, "flat");
    if (type == "ring") return read_ring(reader, mm);
    if (type == "dot") return read_dot(reader, mm);
    if (type == "stub") return read_stub(reader, mm);
    if (type == "blob") return read_blob(reader, mm);
    return read_hill(reader, mm);
}

} // namespace

Anomaly read_anomaly(json::Reader reader, double mm)
{
    Anomaly anomaly = read_shape(reader, mm);
    if (std::optional<json::Reader> rough = reader.optional_object("roughness")) {
        Roughness roughness;
        roughness.size = rough->number("size", core::Range::between(0, 0.9));
        roughness.grain = read_length(*rough, "grain", mm);
        if (rough->has("seed")) roughness.seed = rough->integer("seed", 0, 1 << 30);
        rough->reject_unknown_keys();
        anomaly = roughened(anomaly, roughness);
    }
    reader.reject_unknown_keys();
    return anomaly;
}

} // namespace fettle::part
