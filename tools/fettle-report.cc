#include "cli/tool.h"
#include "report/index_page.h"
#include "report/page.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <ostream>

using namespace fettle;

namespace {

/// "name=value" of --field-in-head.
std::vector<std::pair<std::string, std::string>> head_fields(const std::vector<std::string>& given)
{
    std::vector<std::pair<std::string, std::string>> fields;
    for (const std::string& text : given) {
        const std::size_t equals = text.find('=');
        if (equals == 0 || equals == std::string::npos)
            throw core::InputError("--field-in-head", "expected NAME=VALUE, got '" + text + "'");
        const std::string name = text.substr(0, equals);
        if (std::ranges::find(fields, name, &std::pair<std::string, std::string>::first) != fields.end())
            throw core::InputError("--field-in-head", "'" + name + "' is given twice");
        fields.emplace_back(name, text.substr(equals + 1));
    }
    return fields;
}

struct Options {
    cli::Tool& t;
    const std::string& title = t.text("--title", "", "TEXT", "Headline");
    const std::string& job = t.optional_file("--job", "FILE", "Job, JSON [the plan's]");
    const std::string& samples = t.optional_file("--samples", "FILE", "Touches, PCD [the surface's]");
    const std::string& surface = t.optional_file("--surface", "FILE", "Desired surface, JSON [the plan's]");
    const std::string& plan = t.optional_file("--plan", "FILE", "Plan, JSON");
    const std::string& grinding = t.optional_file("--grinding", "FILE", "Report of fettle-grind, JSON");
    const std::string& trace = t.optional_file("--trace", "FILE", "Trace of fettle-grind, PCD");
    const std::string& before = t.optional_file("--before", "FILE", "The part before: mesh or cloud");
    const std::optional<units::Units::Length>& before_units =
        t.length_unit("--before-units", "Unit of the part before, if not the run's");
    const std::string& after = t.optional_file("--after", "FILE", "The part after: mesh or cloud");
    const std::string& errors = t.optional_file("--errors", "FILE", "Error map of fettle-compare, PCD");
    const std::string& comparison = t.optional_file("--comparison", "FILE", "Report of fettle-compare, JSON");
    const std::string& alignment = t.optional_file("--alignment", "FILE", "Report of fettle-align, JSON");
    const std::string& form = t.optional_file("--form", "FILE", "What fettle-form measured, JSON");
    const std::string& frames = t.optional_file(
        "--frames", "FILE",
        "Pictures of the stock during the run: the frames.json of --frames of fettle-grind, -mill or -belt");
    const std::string& nominal = t.optional_file(
        "--nominal", "FILE", "What fettle-form measures on the nominal part, JSON: for nominal, actual, deviation");
    const std::vector<std::string>& head = t.repeated_text(
        "--field-in-head", "NAME=VALUE", "Part, serial number, operator, date, …: a field in the page's head each");
    const std::string& judge = t.choice("--judge", "wheel", {"wheel", "all"},
                                        "Over-cut by the wheel alone, or also what the part lacked before grinding");
    const std::vector<std::string>& index = t.file_list(
        "--index", "One page about many: a row for each of these reports that --report of this tool wrote, JSON");

    report::RunFileNames files() const
    {
        return {.job = job,
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
                .nominal = nominal,
                .frames = frames,
                .before_units = before_units};
    }
};

/// The page of many parts, with links to theirs.
void write_index(cli::Tool& t, const std::vector<std::string>& files, const std::string& title)
{
    namespace fs = std::filesystem;
    const fs::path folder = t.output_name() == "-" ? fs::current_path() : fs::absolute(t.output_name()).parent_path();
    std::vector<report::PageSummary> parts;
    std::vector<std::string> links;
    for (const std::string& file : files) {
        parts.push_back(report::read_page_summary(file));
        const fs::path page = fs::absolute(file).parent_path() / parts.back().page;
        links.push_back(page.lexically_normal().lexically_relative(folder.lexically_normal()).generic_string());
    }
    t.output() << report::index_page(parts, links, title, FETTLE_VERSION);
}

const std::string kDescription =
    "Make one page about a run: verdict, job, touches and fit, margin, plan, force trace, maps, statistics, form, "
    "provenance. Self-contained HTML, for the screen and for A4. Sections without their files are left out. Where "
    "the error map knows how much was removed (of a part that fettle-grind ground), the verdict is about the "
    "wheel: "
    "what the part lacked before grinding is stated and not counted. With --index: one page about many parts.";

const std::string kExample =
    "fettle-part parts/wang1.json | fettle-compare --to <(fettle-part parts/wang1.json --without-anomaly) "
    "--within jobs/wang1.json --report errors.json -o errors.pcd; "
    "fettle-report --job jobs/wang1.json --errors errors.pcd --comparison errors.json -o report.html";

/// --index goes without the files of one run.
void require_index_alone(const Options& o)
{
    for (const std::string* file : {&o.job, &o.samples, &o.surface, &o.plan, &o.grinding, &o.trace, &o.before, &o.after,
                                    &o.errors, &o.comparison, &o.alignment, &o.form, &o.nominal, &o.frames})
        if (!file->empty()) throw core::InputError("--index", "goes without files of one run, such as " + *file);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, kDescription, [](cli::Tool& t) {
        const Options o{t};
        t.example(kExample, "an anomaly that was not ground yet: out of tolerance");
        t.output_formats({"html"});
        t.parse();
        if (!o.index.empty()) {
            require_index_alone(o);
            write_index(t, o.index, o.title);
            return cli::Verdict::yes;
        }

        report::RunFiles run = report::read_run(o.files());
        for (const std::string& warning : run.warnings) t.warn(warning);
        run.head = head_fields(o.head);
        run.judges_all = o.judge == "all";
        t.output() << report::report_page(run, o.title, FETTLE_VERSION);
        t.report() = report::page_summary(run, o.title, std::filesystem::path(t.output_name()).filename().string());
        return cli::Verdict::yes;
    });
}
