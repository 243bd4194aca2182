#include "find/find.h"

#include "core/error.h"
#include "json/units.h"

#include <algorithm>

namespace fettle::find {
namespace {

void check_rows(const FindResult& result, const std::vector<int>& rows, const std::string& option)
{
    for (const int row : rows)
        if (std::ranges::find(result.anomalies, row, &FoundAnomaly::number) == result.anomalies.end())
            throw core::InputError(option, std::to_string(row) + " is no row: " +
                                               std::to_string(result.anomalies.size()) + " anomalies were found");
}

} // namespace

void judge(FindResult& result, const std::vector<int>& keep, const std::vector<int>& drop)
{
    check_rows(result, keep, "--keep");
    check_rows(result, drop, "--drop");
    for (const int row : keep)
        if (std::ranges::find(drop, row) != drop.end())
            throw core::InputError("--drop", std::to_string(row) + " is in --keep, too");
    for (FoundAnomaly& anomaly : result.anomalies)
        if (std::ranges::find(keep, anomaly.number) != keep.end()) anomaly.doubt.clear();
    std::erase_if(result.anomalies,
                  [&](const FoundAnomaly& anomaly) { return std::ranges::find(drop, anomaly.number) != drop.end(); });
}

mesh::CloudMesh labelled(mesh::CloudMesh part, const FindResult& result)
{
    Eigen::VectorXd anomaly = Eigen::VectorXd::Zero(part.points.size()), height = anomaly;
    for (const FoundAnomaly& found : result.anomalies)
        for (std::size_t i = 0; i < found.points.size(); ++i) {
            anomaly[found.points[i]] = found.number;
            height[found.points[i]] = found.heights[Eigen::Index(i)];
        }
    cloud::set_field(part.points, "anomaly", anomaly);
    cloud::set_field(part.points, "height", height);
    return part;
}

void set_report(json::Value& report, const FindResult& result, const units::Units& units)
{
    const double mm = units.mm();
    report.set("kind", "found").set("units", json::to_json(units.length)).set("noise", result.noise / mm);
    std::vector<json::Value> rows;
    for (const FoundAnomaly& found : result.anomalies) {
        json::Value row;
        row.set("anomaly", found.number)
            .set("probability", found.probability)
            .set("height", found.height / mm)
            .set("area", found.area / (mm * mm))
            .set("volume", found.volume / (mm * mm * mm))
            .set("significance", found.significance)
            .set("doubt", found.doubt)
            .set("job", found.job);
        if (!found.wheel.empty()) row.set("wheel", found.wheel);
        if (!found.like.empty()) row.set("like", found.like);
        rows.push_back(row);
    }
    report.set("anomalies", rows);
    if (!result.absent.empty())
        report.set("absent", std::vector<json::Value>(result.absent.begin(), result.absent.end()));
}

} // namespace fettle::find
