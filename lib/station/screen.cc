#include "station/screen.h"

#include "core/constants.h"
#include "core/fixed_text.h"
#include "core/text.h"
#include "station/sketch.h"

#include <algorithm>
#include <cmath>

namespace fettle::station {
namespace {

constexpr int kSketchRows = 14;
constexpr int kSecondsPerMinute = 60;

std::string number(double value, int digits) { return core::to_fixed_text(value, digits); }

std::string heading(const Record& record)
{
    static const char* const kTitles[] = {"show the anomaly",  "show what may be touched",
                                          "touch the surface", "judge the fit",
                                          "grinding",          "manual",
                                          "stopped",           "done"};
    return std::string("fettle-station: ") + kTitles[std::size_t(record.stage)] + "   [" +
           kModeWords[std::size_t(record.mode)] + "]   theta " + number(record.job.theta / core::kRadPerDegree, 1) +
           " deg";
}

std::string keys(const Record& record, bool works)
{
    if (works && record.stage == Stage::manual) return "arrows: steer   u: up, down   SPACE or n: end   q: end session";
    if (works) return "SPACE: stop   q: stop and end";
    switch (record.stage) {
    case Stage::anomaly:
    case Stage::sampling:
        return "arrows: move   r: record   b: back   n: next   [ ]: turn the head   q: end";
    case Stage::touch:
        return "ENTER: touch   b: back   q: end";
    case Stage::review:
        return "a: automatic   m: manual   ENTER: start   b: touch again   q: end";
    case Stage::done:
        return "m, ENTER: manual   q: end";
    default:
        return "ENTER: go on   a: automatic   m: manual   q: end";
    }
}

std::string clock_text(double seconds)
{
    const int whole = int(std::lround(std::max(seconds, 0.0)));
    const std::string rest = std::to_string(whole % kSecondsPerMinute);
    return std::to_string(whole / kSecondsPerMinute) + ":" + (rest.size() < 2 ? "0" : "") + rest;
}

std::string machine_line(const Live& live, const units::Units& units)
{
    if (!live.has_machine) return "no machine yet";
    const Eigen::Vector3d at = live.machine.commanded / units.mm();
    return "x " + number(at.x(), 3) + "  y " + number(at.y(), 3) + "  z " + number(at.z(), 3) + " " +
           units::to_string(units.length) + "   time " + number(live.machine.time, 1) + " s";
}

/// The force as a bar of F_max.
std::string force_line(const Live& live, const job::Job& job)
{
    constexpr int kBar = 30;
    const double share = live.machine.force / job.force.max;
    const int filled = std::clamp(int(std::lround(share * kBar)), 0, kBar);
    return "force " + number(live.machine.force / job.units.newton(), 1) + " of " +
           number(job.force.max / job.units.newton(), 1) + " " + units::to_string(job.units.force) + " [" +
           std::string(std::size_t(filled), '=') + std::string(std::size_t(kBar - filled), ' ') + "]";
}

std::vector<std::string> facts(const Session& session, const plan::Plan* plan, const Live& live)
{
    const Record& record = session.record();
    switch (record.stage) {
    case Stage::anomaly:
    case Stage::sampling:
        return {"points: " + std::to_string(record.anomaly.size()) + " around the anomaly, " +
                std::to_string(record.sampling.size()) + " around what may be touched"};
    case Stage::touch:
        return {"touches: " + std::to_string(record.touches.size())};
    case Stage::review:
        return describe_fit(*plan);
    default:
        break;
    }
    std::vector<std::string> lines = {force_line(live, record.job)};
    if (live.layer > 0)
        lines.push_back("layer " + std::to_string(live.layer) + "   pass " + std::to_string(live.pass) + " of " +
                        std::to_string(plan->passes.size()) + "   left in this covering " + clock_text(live.time_left));
    return lines;
}

} // namespace

std::vector<std::string> describe_fit(const plan::Plan& plan)
{
    const surface::Surface& surface = plan.surface;
    const double mm = plan.job.units.mm();
    const std::string unit = " " + units::to_string(plan.job.units.length);
    std::string fit = surface.method + " through " + std::to_string(surface.touches.cols()) + " touches, rms " +
                      core::to_short_text(surface.rms / mm) + unit;
    if (!surface.outliers.empty()) fit += ", outliers " + std::to_string(surface.outliers.size());
    return {fit, "error band " + core::to_short_text(surface.prediction->band / mm) + unit + ", raised by " +
                     core::to_short_text(surface.prediction->shift / mm) + unit + "; tolerance " +
                     core::to_short_text(plan.job.tolerance / mm) + unit};
}

std::vector<std::string> draw_screen(const Session& session, const plan::Plan* plan, const Live& live)
{
    const Record& record = session.record();
    const bool works = record.stage == Stage::grind || record.stage == Stage::manual;
    SketchContent content{record, nullptr, std::nullopt};
    if (record.stage == Stage::review) content.plan = plan;
    if (live.has_machine) content.tool = live.machine.commanded.head<2>();
    std::vector<std::string> lines = {heading(record), ""};
    for (std::string& line : sketch(content, int(kScreenColumns), kSketchRows)) lines.push_back(std::move(line));
    lines.emplace_back();
    for (std::string& line : facts(session, plan, live)) lines.push_back(std::move(line));
    lines.push_back(machine_line(live, record.job.units));
    lines.push_back(session.message());
    lines.resize(kScreenRows - 1);
    lines.push_back(keys(record, works));
    for (std::string& line : lines)
        if (line.size() > kScreenColumns) line.resize(kScreenColumns);
    return lines;
}

} // namespace fettle::station
