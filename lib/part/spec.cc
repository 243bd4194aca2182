#include "core/error.h"
#include "core/file.h"
#include "part/anomalies.h"
#include "part/part.h"
#include "part/surface.h"
#include "json/units.h"

#include <filesystem>

namespace fettle::part {
namespace {

// File names in a specification are relative to its folder, on stdin to the working folder.
std::string folder_of(const std::string& path)
{
    const std::string folder = path == "-" ? "" : std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

Eigen::AlignedBox2d read_region(json::Reader reader, double mm)
{
    Eigen::AlignedBox2d region;
    for (int axis = 0; axis < 2; ++axis) {
        const std::string key = axis == 0 ? "x" : "y";
        const Eigen::Vector2d ends = mm * reader.vector(key, 2);
        if (!(ends[0] < ends[1])) reader.refuse(key, "the first number must be less than the second");
        region.min()[axis] = ends[0];
        region.max()[axis] = ends[1];
    }
    reader.reject_unknown_keys();
    return region;
}

ScannedSurface read_scanned(json::Reader reader, const std::string& folder)
{
    ScannedSurface scanned;
    scanned.file = (std::filesystem::path(folder) / reader.text("file")).string();
    scanned.unit = units::parse_length_unit(reader.choice("units", {"mm", "in", "m"}));
    reader.reject_unknown_keys();
    return scanned;
}

} // namespace

PartSpec read_part(const std::string& path)
{
    json::Reader reader = json::Reader::open(path);
    reader.expect_kind("part");
    PartSpec spec;
    spec.source = core::display_name(path);
    spec.units.length = json::read_length_unit(reader);
    const double mm = spec.units.mm();

    spec.step = mm * reader.number("step", core::Range::positive());
    if (reader.has("scan")) {
        if (reader.has("surface")) reader.refuse("scan", "give either scan or surface, not both");
        ScannedSurface scanned = read_scanned(reader.object("scan"), folder_of(path));
        if (reader.has("region")) scanned.region = read_region(reader.object("region"), mm);
        spec.surface = scanned;
    } else {
        AnalyticSurface made;
        made.region = read_region(reader.object("region"), mm);
        made.z = read_part_surface(reader.object("surface"), mm, folder_of(path));
        spec.surface = made;
    }
    if (reader.has("anomalies"))
        for (const json::Reader& anomaly : reader.objects("anomalies"))
            spec.anomalies.push_back(read_anomaly(anomaly, mm));
    if (reader.has("noise")) try {
            spec.noise = sampling::parse_noise(reader.text("noise"), mm);
        } catch (const core::InputError& error) {
            reader.refuse("noise", error.what());
        }
    reader.reject_unknown_keys();
    return spec;
}

} // namespace fettle::part
