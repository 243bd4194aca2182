#include "cli/tool.h"
#include "cloud/pcd.h"
#include "compare/form.h"
#include "compare/sections.h"
#include "compare/statistics.h"
#include "core/file.h"
#include "job/job.h"

#include <algorithm>
#include <numbers>

namespace {

using namespace fettle;

struct Request {
    FormKind kind = FormKind::flatness;
    std::optional<double> outliers;                    ///< robust standard deviations
    Eigen::Vector3d section = Eigen::Vector3d::Zero(); ///< of straightness; zero: by the points
};

// Without the outliers, if that is asked for. Adds their number to `rejected`.
Form measured(const Request& request, Eigen::Matrix3Xd& points, std::size_t& rejected)
{
    if (request.outliers) {
        const auto kept = without_outliers(request.kind, points, *request.outliers, request.section);
        rejected += static_cast<std::size_t>(points.cols()) - kept.size();
        points = points(Eigen::all, kept).eval();
    }
    return form(request.kind, points, request.section);
}

struct SectionOptions {
    double spacing, width, direction; ///< mm, mm, radians
};

// The form of each section, beside the worst one's.
json::Value sections_json(Request request, const SectionOptions& options, const Eigen::Matrix3Xd& points,
                          const Units& units, std::size_t& rejected)
{
    constexpr std::size_t kFewest = 3; // two points are always straight
    request.section = section_normal(options.direction);
    std::vector<json::Value> rows;
    std::optional<json::Value> worst;
    double widest = -1, widest_squares = 0;
    std::size_t few = 0;
    for (const Section& section : vertical_sections(points, options.direction, options.spacing, options.width)) {
        Eigen::Matrix3Xd line = points(Eigen::all, section.points);
        if (section.points.size() < kFewest) {
            ++few;
            continue;
        }
        const Form found = measured(request, line, rejected);
        const json::Value value = to_json(found, line, units);
        json::Value row;
        row.set("offset", section.offset / units.mm()).set("count", static_cast<std::size_t>(line.cols()));
        row.set("least_squares", found.least_squares.width / units.mm());
        rows.push_back(row.set("minimum_zone", found.minimum_zone.width / units.mm()));
        widest_squares = std::max(widest_squares, found.least_squares.width);
        if (found.minimum_zone.width <= widest) continue;
        widest = found.minimum_zone.width;
        worst = value;
        worst->set("offset", section.offset / units.mm());
    }
    if (!worst) throw InputError("no section has as many as 3 points");
    worst->set("least_squares", widest_squares / units.mm());
    return worst->set("sections", rows).set("sections_too_few", few);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string description =
        "Form error of measured points: the width of the zone that holds them all, about the element of least squares "
        "and at its narrowest (minimum zone). Out: JSON, with both elements, and the points that touch the minimum "
        "zone.\n"
        "No filter is applied, and every point counts: noise widens the zone by some five of its standard deviations "
        "among a hundred points and ten among a million, an outlier by all that it is off. --outliers leaves out what "
        "is no part of the surface.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::vector<std::string> kinds = {"flatness", "cylindricity", "sphericity", "straightness"};
        const std::string& kind = t.word("FORM", kinds, "What is measured");
        const std::string& path = t.input("POINTS", "PCD, PLY or XYZ");
        const auto& unit = t.length_unit("--file-units", "Unit of POINTS, if not the job's");
        const std::string& job_path =
            t.other_file("--within", "JOB", "Only points inside its anomaly's boundary; its units");
        const auto& outliers =
            t.number_if_given("--outliers", "SIGMAS",
                              "Leave out points farther from the least squares element than so many robust "
                              "standard deviations; they are counted",
                              Range::positive());
        const auto& spacing =
            t.number_if_given("--sections", "LENGTH",
                              "Straightness of sections so far apart, in vertical planes; without it, of all "
                              "points as one line",
                              Range::positive());
        const auto& width = t.number_if_given(
            "--section-width", "LENGTH", "Points within half of it belong to a section; as --sections, if not given",
            Range::positive());
        const double& direction =
            t.number("--direction", 0, "DEG", "Of the sections, counter-clockwise from X", Range::between(-360, 360));
        t.example("fettle-form flatness scans/panel.pcd",
                  "how flat a scanned panel is, in the unit that the file states");
        t.reference("ISO 12781 (flatness), 12180 (cylindricity), 12780 (straightness), 1101; Wang 2007, 6.2");
        t.parse();
        if (spacing && kind != "straightness")
            throw InputError("--sections", "goes with straightness, not with " + kind);
        if (width && !spacing) throw InputError("--section-width", "goes with --sections");

        const std::optional<Job> job = job_path.empty() ? std::nullopt : std::optional(read_job(job_path));
        std::optional<Units> stated = job ? std::optional(job->units) : std::nullopt;
        if (unit) stated = Units{*unit, job ? job->units.force : Units::Force::N};
        const CloudFile file = read_cloud(path, stated);
        const Units units = job ? job->units : file.units;

        std::vector<Region> region(static_cast<std::size_t>(file.cloud.size()), Region::inside);
        if (job) region = regions(*job, file.cloud.xyz);
        std::vector<Eigen::Index> used;
        Eigen::Index dropped = 0;
        for (Eigen::Index i = 0; i < file.cloud.size(); ++i) {
            if (!file.cloud.xyz.col(i).allFinite())
                ++dropped;
            else if (region[static_cast<std::size_t>(i)] == Region::inside)
                used.push_back(i);
        }
        if (dropped > 0) t.warn(display_name(path) + ": " + std::to_string(dropped) + " points without x y z dropped");
        Eigen::Matrix3Xd points = file.cloud.xyz(Eigen::all, used);
        Request request;
        request.kind = static_cast<FormKind>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
        request.outliers = outliers;
        json::Value result;
        std::size_t rejected = 0;
        try {
            if (spacing) {
                const double mm = units.mm();
                const SectionOptions sections{*spacing * mm, width.value_or(*spacing) * mm,
                                              direction * std::numbers::pi / 180};
                result = sections_json(request, sections, points, units, rejected);
            } else {
                const Form found = measured(request, points, rejected);
                result = to_json(found, points, units);
            }
        } catch (const InputError& error) {
            throw InputError(display_name(path), kind + ": " + error.what());
        }
        result.set("dropped", static_cast<std::size_t>(dropped)).set("outliers", rejected);
        t.report() = result;
        t.output() << result;
        return Verdict::yes;
    });
}
