#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "cloud/fields.h"
#include "cloud/pcd.h"
#include "core/file.h"
#include "job/frame.h"
#include "job/plausible.h"
#include "sampling/estimate.h"

using namespace fettle;

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Add points under the anomaly, estimated from curves through the touches.", [](cli::Tool& t) {
            const std::string& job_file = t.positional_file("JOB", "The job, JSON");
            const std::string& input = t.main_input("SAMPLES", "touches of fettle-sample, PCD");
            const auto& file_unit = t.length_unit("--file-units", "Unit of the samples, if it is not the job's");
            const cloud::CloudOutput out{t};
            t.example(
                "fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-estimate jobs/hammer.json > points.pcd",
                "touches and estimated points (role 3); those of a plane or a swept surface pass unchanged");
            t.reference("Wang 2007, 4.3, fig. 4-5");
            t.parse();

            const job::Job job = job::read_job(job_file);
            const units::Units units{file_unit.value_or(job.units.length), job.units.force};
            cloud::Cloud samples = cloud::read_cloud(input, units).cloud;
            job::move_to_job_frame(samples, job);
            if (cloud::has_field(samples, "role"))
                job::check_touch_places({samples.xyz, cloud::integer_field(samples, "role")}, job,
                                        core::display_name(input));
            const cloud::Cloud points = cli::with_error_prefix(
                core::display_name(input), [&] { return sampling::with_estimated_points(job, samples); });
            t.report().set("touches", samples.size()).set("estimated", points.size() - samples.size());
            out.write(job::in_job_frame(points, job), job.units);
            return cli::Verdict::yes;
        });
}
