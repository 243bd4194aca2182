#include "cli/tool.h"
#include "cloud/cloud_output.h"
#include "merge/merge_run.h"
#include "mesh/read_formats.h"

using namespace fettle;

int main(int argc, char** argv)
{
    const std::string description =
        "Merge scans of one part: find where each lies in the frame of the first, and make one cloud of them.\n"
        "Order, start and overlap are unknown: pairs of points vote for the poses of a pair, further scans must not "
        "contradict them, and then all that overlap are fitted to each other at once, weighted by their noise. The "
        "report has each scan's pose with its covariance. Points that several scans see lie on the weighted mean of "
        "them; field `scans` counts them, `disagreement` is the rms of their distances from the mean. What no scan "
        "sees stays open. Exit 1 if a scan fits nowhere; it is named, and the others are merged.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const auto& scans = t.positional_files("SCAN", std::string("Two or more. ") + mesh::kReadFormats);
        const auto& unit = t.length_unit("--file-units", "Unit of the scans, if they state none");
        const std::string& poses =
            t.optional_file("--poses", "FILE", "Report of an earlier run: begin with its poses, do not search");
        const cloud::CloudOutput out{t};
        t.example("fettle-merge scans/views/1.pcd scans/views/2.pcd scans/views/3.pcd --report poses.json -o part.pcd",
                  "three scans of a hammer's head");
        t.reference("Drost et al. 2010 (point pairs); Chen & Medioni 1992 (point to plane); Lu & Milios 1997 (pose "
                    "graph); Rusinkiewicz 2019 (symmetric normals)");
        t.parse();

        const merge::MergeRun run = merge::merge_files({scans, unit, poses, t.progress("registering")});
        for (const std::string& warning : run.warnings) t.warn(warning);
        if (!run.converged) t.warn("the poses still moved after the last step: see \"pairs\" in the report");
        t.report() = run.report;
        out.write(run.merged, run.units);
        return run.all_placed && run.converged ? cli::Verdict::yes : cli::Verdict::no;
    });
}
