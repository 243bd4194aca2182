#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "sampling/estimate.h"

using namespace fettle;

int main(int argc, char** argv)
{
    return tool_main(
        argc, argv, "Add points under the anomaly, estimated from curves through the touches.", [](Tool& t) {
            const std::string& job_file = t.file("JOB", "The job, JSON");
            const std::string& input = t.input("SAMPLES", "touches of fettle-sample, PCD");
            const auto& file_unit = t.length_unit("--file-units", "Unit of the samples, if it is not the job's");
            const bool& ascii = t.flag("--ascii", "Text instead of binary");
            t.example(
                "fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-estimate jobs/hammer.json > points.pcd",
                "touches and estimated points (role 3); those of a plane or a swept surface pass unchanged");
            t.reference("Wang 2007, 4.3, fig. 4-5");
            t.parse();

            const Job job = read_job(job_file);
            const Units units{file_unit.value_or(job.units.length), job.units.force};
            const Cloud samples = read_cloud(input, units).cloud;
            Cloud points;
            try {
                points = with_estimated_points(job, samples);
            } catch (const InputError& error) {
                throw InputError(display_name(input), error.what());
            }
            t.report()
                .set("touches", static_cast<std::size_t>(samples.size()))
                .set("estimated", static_cast<std::size_t>(points.size() - samples.size()));
            write_pcd(t.output(), points, job.units, ascii ? PcdEncoding::ascii : PcdEncoding::binary);
            return Verdict::yes;
        });
}
