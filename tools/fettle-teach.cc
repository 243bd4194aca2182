#include "cli/tool.h"
#include "job/job.h"
#include "job/picked.h"
#include "json/document.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <ostream>

using namespace fettle;

namespace {

/// The job as it would be read from a file: with all that read_job() checks.
Job checked(const Job& job) { return parse_job(json::Reader::parse(to_json(job).text(), "the job that was taught")); }

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Make a job from points that were picked on a scan.", [](Tool& t) {
        const std::string& like = t.file("JOB", "Settings to start from: any job, JSON; its boundaries are replaced");
        const std::string& anomaly = t.required_text(
            "--anomaly", "POINTS", "Around the anomaly, picked in CloudCompare or pcd_viewer: their text");
        const std::string& sampling = t.text("--sampling", "", "POINTS", "Around what may be touched");
        const auto& file_units = t.length_unit("--file-units", "Unit of POINTS, if it is not the job's");
        const std::string& surface =
            t.choice("--surface", "", {"plane", "swept", "freeform"}, "Of the good surface; default: as in JOB");
        const auto& direction = t.number_if_given("--direction", "DEG", "Of the rulings of a swept surface, from X_w");
        const auto& theta = t.number_if_given("--theta", "DEG", "Of the wheel's axis, counter-clockwise from X_m");
        t.example("fettle-teach jobs/wang1.json --anomaly <(printf "
                  "'0.5,0.5,0.75\\n2.5,0.5,0.75\\n2.5,2.5,0.75\\n0.5,2.5,0.75\\n') "
                  "--theta 30",
                  "another anomaly and another angle of the wheel");
        t.reference("Wang 2007, 3 and 6.1.1: what the operator teaches");
        t.parse();

        constexpr double kDegree = std::numbers::pi / 180;
        Job job = read_job(like);
        const double mm = mm_per(file_units.value_or(job.units.length));
        job.anomaly = read_picked(anomaly) * mm;
        if (!sampling.empty())
            job.sampling = read_picked(sampling) * mm;
        else if (job.surface == SurfaceType::plane && (surface.empty() || surface == "plane"))
            job.sampling.resize(3, 0); // a plane may do without; the old one lies elsewhere
        if (!surface.empty())
            job.surface = surface == "plane"   ? SurfaceType::plane
                          : surface == "swept" ? SurfaceType::swept
                                               : SurfaceType::freeform;
        if (direction) {
            if (job.surface != SurfaceType::swept) throw InputError("--direction", "goes with a swept surface alone");
            job.direction = *direction * kDegree;
        }
        if (theta) job.theta = *theta * kDegree;
        t.output() << to_json(checked(job));
        return Verdict::yes;
    });
}
