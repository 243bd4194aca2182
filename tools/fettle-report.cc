#include "cli/tool.h"
#include "report/page.h"

#include <ostream>

using namespace fettle;

int main(int argc, char** argv)
{
    const std::string description =
        "One page about a run: verdict, job, touches and fit, margin, plan, force trace, maps, statistics, form, "
        "provenance. "
        "Self-contained HTML, for the screen and for A4. Sections without their files are left out.";
    return tool_main(argc, argv, description, [](Tool& t) {
        const std::string& title = t.text("--title", "", "TEXT", "Headline");
        const std::string& job = t.other_file("--job", "FILE", "Job, JSON [the plan's]");
        const std::string& samples = t.other_file("--samples", "FILE", "Touches, PCD [the surface's]");
        const std::string& surface = t.other_file("--surface", "FILE", "Desired surface, JSON [the plan's]");
        const std::string& plan = t.other_file("--plan", "FILE", "Plan, JSON");
        const std::string& grinding = t.other_file("--grinding", "FILE", "Report of fettle-grind, JSON");
        const std::string& trace = t.other_file("--trace", "FILE", "Trace of fettle-grind, PCD");
        const std::string& before = t.other_file("--before", "FILE", "The part before: mesh or cloud");
        const auto& before_units = t.length_unit("--before-units", "Unit of the part before, if not the run's");
        const std::string& after = t.other_file("--after", "FILE", "The part after: mesh or cloud");
        const std::string& errors = t.other_file("--errors", "FILE", "Error map of fettle-compare, PCD");
        const std::string& comparison = t.other_file("--comparison", "FILE", "Report of fettle-compare, JSON");
        const std::string& alignment = t.other_file("--alignment", "FILE", "Report of fettle-align, JSON");
        const std::string& form = t.other_file("--form", "FILE", "What fettle-form measured, JSON");
        t.example(
            "fettle-part parts/wang1.json | fettle-compare --to <(fettle-part parts/wang1.json --without-anomaly) "
            "--within jobs/wang1.json --report errors.json -o errors.pcd; "
            "fettle-report --job jobs/wang1.json --errors errors.pcd --comparison errors.json -o report.html",
            "an anomaly that was not ground yet: out of tolerance");
        t.parse();

        const RunFiles run = read_run({.job = job,
                                       .samples = samples,
                                       .surface = surface,
                                       .plan = plan,
                                       .grinding = grinding,
                                       .trace = trace,
                                       .before = before,
                                       .after = after,
                                       .errors = errors,
                                       .comparison = comparison,
                                       .alignment = alignment,
                                       .form = form,
                                       .before_units = before_units});
        for (const std::string& doubt : run.doubts) t.warn(doubt);
        t.output() << report_page(run, title, FETTLE_VERSION);
        return Verdict::yes;
    });
}
