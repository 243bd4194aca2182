#include "cli/tool.h"
#include "report/page.h"

#include <ostream>

using namespace fettle;

int main(int argc, char** argv)
{
    const std::string description =
        "One page about a run: verdict, job, touches and fit, margin, plan, force trace, maps, statistics, form, "
        "provenance. Self-contained HTML, for the screen and for A4. Sections without their files are left out.";
    return cli::tool_main(argc, argv, description, [](cli::Tool& t) {
        const std::string& title = t.text("--title", "", "TEXT", "Headline");
        const std::string& job = t.optional_file("--job", "FILE", "Job, JSON [the plan's]");
        const std::string& samples = t.optional_file("--samples", "FILE", "Touches, PCD [the surface's]");
        const std::string& surface = t.optional_file("--surface", "FILE", "Desired surface, JSON [the plan's]");
        const std::string& plan = t.optional_file("--plan", "FILE", "Plan, JSON");
        const std::string& grinding = t.optional_file("--grinding", "FILE", "Report of fettle-grind, JSON");
        const std::string& trace = t.optional_file("--trace", "FILE", "Trace of fettle-grind, PCD");
        const std::string& before = t.optional_file("--before", "FILE", "The part before: mesh or cloud");
        const auto& before_units = t.length_unit("--before-units", "Unit of the part before, if not the run's");
        const std::string& after = t.optional_file("--after", "FILE", "The part after: mesh or cloud");
        const std::string& errors = t.optional_file("--errors", "FILE", "Error map of fettle-compare, PCD");
        const std::string& comparison = t.optional_file("--comparison", "FILE", "Report of fettle-compare, JSON");
        const std::string& alignment = t.optional_file("--alignment", "FILE", "Report of fettle-align, JSON");
        const std::string& form = t.optional_file("--form", "FILE", "What fettle-form measured, JSON");
        t.example(
            "fettle-part parts/wang1.json | fettle-compare --to <(fettle-part parts/wang1.json --without-anomaly) "
            "--within jobs/wang1.json --report errors.json -o errors.pcd; "
            "fettle-report --job jobs/wang1.json --errors errors.pcd --comparison errors.json -o report.html",
            "an anomaly that was not ground yet: out of tolerance");
        t.parse();

        const report::RunFiles run = report::read_run({.job = job,
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
        for (const std::string& warning : run.warnings) t.warn(warning);
        t.output() << report::report_page(run, title, FETTLE_VERSION);
        return cli::Verdict::yes;
    });
}
