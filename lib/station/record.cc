#include "station/record.h"

#include "json/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::station {
namespace {

constexpr int kMaxManualRuns = 1000000; // more than a life of work

/// Rows [x, y, z], or [x, y] where the probe found no surface.
json::Value to_rows(const std::vector<Eigen::Vector3d>& points, double mm)
{
    std::vector<json::Value> rows;
    for (const Eigen::Vector3d& point : points) {
        const Eigen::VectorXd row = point / mm;
        rows.emplace_back(Eigen::VectorXd(row.head(std::isnan(point.z()) ? 2 : 3)));
    }
    return rows;
}

std::vector<Eigen::Vector3d> points_of(json::Reader& reader, const std::string& key, double mm)
{
    const Eigen::MatrixXd rows = reader.ragged_matrix(key, 2, 3);
    std::vector<Eigen::Vector3d> points;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const double z = rows.cols() > 2 ? rows(i, 2) : std::numeric_limits<double>::quiet_NaN();
        points.push_back(Eigen::Vector3d(rows(i, 0), rows(i, 1), z) * mm);
    }
    return points;
}

template <class Enumeration>
Enumeration parse_word(json::Reader& reader, const std::string& key, const std::vector<std::string>& words)
{
    return Enumeration(std::ranges::find(words, reader.choice(key, words)) - words.begin());
}

} // namespace

Record begin_record(const job::Job& settings)
{
    Record record;
    record.settings = record.job = settings;
    return record;
}

json::Value to_json(const Record& record)
{
    const double mm = record.job.units.mm();
    std::vector<json::Value> stops;
    for (const auto& [asked, free, lifted] : record.stops)
        stops.push_back(json::Value().set("asked", asked).set("free", free).set("lifted", lifted));
    return json::Value()
        .set("kind", "session")
        .set("units", json::to_json(record.job.units))
        .set("stage", kStageWords[std::size_t(record.stage)])
        .set("mode", kModeWords[std::size_t(record.mode)])
        .set("anomaly", to_rows(record.anomaly, mm))
        .set("sampling", to_rows(record.sampling, mm))
        .set("touches", to_rows(record.touches, mm))
        .set("manual_runs", record.manual_runs)
        .set("peak_force", record.peak_force / record.job.units.newton())
        .set("stops", stops)
        .set("settings", job::to_json(record.settings))
        .set("job", job::to_json(record.job));
}

Record parse_record(json::Reader reader)
{
    reader.expect_kind("session");
    Record record;
    record.job = job::parse_job(reader.object("job"));
    record.settings = job::parse_job(reader.object("settings"));
    const double mm = record.job.units.mm();
    reader.object("units"); // those of the job
    record.stage = parse_word<Stage>(reader, "stage", kStageWords);
    record.mode = parse_word<Mode>(reader, "mode", kModeWords);
    record.anomaly = points_of(reader, "anomaly", mm);
    record.sampling = points_of(reader, "sampling", mm);
    record.touches = points_of(reader, "touches", mm);
    record.manual_runs = reader.integer("manual_runs", 0, kMaxManualRuns);
    record.peak_force = reader.number("peak_force", core::Range::at_least(0)) * record.job.units.newton();
    for (json::Reader& stop : reader.objects("stops"))
        record.stops.push_back({stop.number("asked"), stop.number("free"), stop.number("lifted")});
    reader.reject_unknown_keys();
    return record;
}

} // namespace fettle::station
