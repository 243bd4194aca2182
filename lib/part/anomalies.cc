#include "part/anomalies.h"

#include "core/constants.h"
#include "part/outline.h"

#include <cmath>

namespace fettle {
namespace {

using Eigen::Vector2d;

// A wall is a height over x-y: it must lean. Below a degree its triangles become needles.
const Range kDraftDegrees = Range::between(1, 80);

RidgeSection read_section(json::Reader& reader, double mm, const std::string& otherwise)
{
    RidgeSection section;
    section.width = mm * reader.number("width", Range::positive());
    section.height = mm * reader.number("height", Range::positive());
    section.round = reader.choice_or("section", otherwise, {"round", "flat"}) == "round";
    const double half = section.width / 2;
    if (section.round) {
        if (section.height > half) reader.refuse("height", "a round section is at most half as high as wide");
    } else {
        section.draft = reader.number_or("draft_deg", 10, kDraftDegrees) * kRadPerDegree;
        if (section.height * std::tan(section.draft) > half)
            reader.refuse("height", "the flanks meet below it: lower it, or make width greater or draft_deg smaller");
    }
    return section;
}

Anomaly read_path(json::Reader& reader, double mm, const std::string& section)
{
    const Eigen::Matrix2Xd path = mm * reader.matrix("path", 2).transpose();
    if (path.cols() < 2) reader.refuse("path", "needs 2 points or more, got " + std::to_string(path.cols()));
    return ridge_along(path, read_section(reader, mm, section));
}

Anomaly read_ring(json::Reader& reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const double radius = mm * reader.number("radius", Range::positive());
    const RidgeSection section = read_section(reader, mm, "round");
    if (section.width > 2 * radius) reader.refuse("width", "must be at most twice the radius");
    return ring(centre, radius, section);
}

Anomaly read_dot(json::Reader& reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const double radius = mm * reader.number("radius", Range::positive());
    const double height = mm * reader.number("height", Range::positive());
    if (height > radius) reader.refuse("height", "a dome is at most as high as its radius");
    return dot(centre, radius, height);
}

Anomaly read_stub(json::Reader& reader, double mm)
{
    const Eigen::Matrix2Xd outline = read_outline(reader.object("outline"), mm);
    SlopedTop top;
    top.low = mm * reader.number("height", Range::positive());
    top.high = mm * reader.number_or("height_end", top.low / mm, Range::positive());
    top.direction = reader.number_or("direction_deg", 0) * kRadPerDegree;
    return stub(outline, top, reader.number_or("draft_deg", 10, kDraftDegrees) * kRadPerDegree);
}

Anomaly read_blob(json::Reader& reader, double mm)
{
    const Eigen::Matrix2Xd outline = read_outline(reader.object("outline"), mm);
    const double height = mm * reader.number("height", Range::positive());
    return blob(outline, height, mm * reader.number("falloff", Range::positive()));
}

Anomaly read_hill(json::Reader& reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const Vector2d axes = mm * reader.vector("semi_axes", 2);
    if (!(axes.minCoeff() > 0)) reader.refuse("semi_axes", "must be positive");
    const double angle = reader.number_or("angle_deg", 0) * kRadPerDegree;
    return hill(centre, axes, angle, mm * reader.number("height", Range::positive()));
}

Anomaly read_shape(json::Reader& reader, double mm)
{
    const std::string type = reader.choice("type", {"bead", "burr", "ring", "dot", "stub", "blob", "hill"});
    if (type == "bead") return read_path(reader, mm, "round");
    if (type == "burr") return read_path(reader, mm, "flat");
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
    if (std::optional<json::Reader> rough = reader.object_or_none("roughness")) {
        Roughness roughness;
        roughness.size = rough->number("size", Range::between(0, 0.9));
        roughness.grain = mm * rough->number("grain", Range::positive());
        roughness.seed = static_cast<std::uint64_t>(rough->has("seed") ? rough->integer("seed", 0, 1 << 30) : 1);
        rough->done();
        anomaly = roughened(anomaly, roughness);
    }
    reader.done();
    return anomaly;
}

} // namespace fettle
