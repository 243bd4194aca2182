#include "cli/tool.h"
#include "cloud/pcd.h"
#include "compare/form.h"
#include "compare/statistics.h"
#include "core/file.h"
#include "job/job.h"

#include <algorithm>

int main(int argc, char** argv)
{
    using namespace fettle;
    const std::string description =
        "Form error of measured points: the width of the zone that holds them all, about the element of least squares "
        "and at its narrowest (minimum zone). Out: JSON, with both elements and the points that hold the minimum zone.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::vector<std::string> kinds = {"flatness", "cylindricity", "sphericity"};
        const std::string& kind = t.word("FORM", kinds, "What is measured");
        const std::string& path = t.input("POINTS", "PCD, PLY or XYZ");
        const auto& unit = t.length_unit("--file-units", "Unit of POINTS, if not the job's");
        const std::string& job_path =
            t.text("--within", "", "JOB", "Only points inside its anomaly's boundary; its units");
        t.example("fettle-form flatness scans/panel.pcd",
                  "how flat a scanned panel is, in the unit that the file states");
        t.reference("ISO 1101; Wang 2007, 6.2");
        t.parse();

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
        const Eigen::Matrix3Xd points = file.cloud.xyz(Eigen::all, used);
        json::Value result;
        try {
            const auto which = std::find(kinds.begin(), kinds.end(), kind) - kinds.begin();
            result = to_json(form(static_cast<FormKind>(which), points), points, units);
        } catch (const InputError& error) {
            throw InputError(display_name(path), kind + ": " + error.what());
        }
        result.set("dropped", static_cast<std::size_t>(dropped));
        t.report() = result;
        t.output() << result;
        return Verdict::yes;
    });
}
