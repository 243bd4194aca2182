// Measurements of the programs tables-*.cc beside the figures of Wang 2007, chapter 4. Where the paper leaves its setup
// open, the title says so, and a row has no bar: it is shown with its ratio. Verdict no when a bar is missed.

#include "tables-guesses.h"
#include "tables-report.h"

#include "cli/tool.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ostream>

using namespace fettle;
using namespace fettle::study;

namespace {

void planes(Report& report)
{
    report.title(
        "Table 4-2, planes, in: mean, deviation and largest error of 100 trials. Between the 1st percentile of a\n"
        "level plane with errors along z and the 99th of one under 45 degrees with errors on all axes (here: its\n"
        "median); the paper names neither.");
    struct Row {
        std::string what, name;
        double mean, deviation, largest;
    };
    for (const Row& row : {Row{"3 random", "random3", .0622, .3806, 3.8197},
                           {"4 random", "random4", .0137, .0099, .0762},
                           {"5 random", "random5", .0104, .0053, .0383},
                           {"6 random", "random6", .0098, .0043, .0346},
                           {"3, 2 in apart", "apart2", .0133, .0197, .1997},
                           {"3, 2.67 in apart", "apart2.67", .0094, .0033, .0188}}) {
        const auto draws = [&](const std::string& setup, const std::string& figure) {
            return report.of("4-2/" + setup + "/" + row.name + "/" + figure);
        };
        report.drawn(row.what + ", mean", row.mean, draws("level", "mean"), draws("tilted", "mean"));
        report.drawn(row.what + ", deviation", row.deviation, draws("level", "sd"), draws("tilted", "sd"));
        report.drawn(row.what + ", largest", row.largest, draws("level", "max"), draws("tilted", "max"));
    }
}

void line(Report& report)
{
    const auto p95 = [&](const std::string& name) { return quantile(report.of("line/" + name), 0.95); };
    report.words("\nLine of 4.4.2: error of a line of 5 in, 95 % of the draws, in (the paper gives no figures)");
    report.words("2 random" + number(p95("random2")) + "   2, half the length apart" + number(p95("apart2")) +
                 "   3 random" + number(p95("random3")) + "   ends and middle" + number(p95("ends_and_middle")));
    report.holds("two touches must be farther apart", p95("apart2") < p95("random2") / 2);
    report.holds("three random ones are much better than two", p95("random3") < p95("random2") / 2);
    report.holds("both ends and the middle are the best of these", p95("ends_and_middle") < p95("apart2"));
}

void searches(Report& report)
{
    report.title("Table 4-1, concave patch, 2 x 2 in anomaly: hill climbing for each method. The paper leaves k, the\n"
                 "candidates and the uniform sampling open: k = 60/in and 0.7 in give about its number of touches.");
    struct Row {
        std::string what, name;
        double touches, band, deviation;
    };
    // What is reproduced has a bar.
    struct Bars {
        bool touches, band;
    };
    const auto both = [&](const Row& row, const Bars& bars) {
        const std::vector<double>&touches = report.of(row.name + "/touches"), &band = report.of(row.name + "/band");
        if (bars.touches)
            report.near(row.what + ", touches", row.touches, touches);
        else
            report.shown(row.what + ", touches", row.touches, mean(touches));
        if (bars.band)
            report.near(row.what + ", mean band, in", row.band, band);
        else
            report.shown(row.what + ", mean band, in", row.band, mean(band));
        report.shown(row.what + ", its deviation", row.deviation, deviation(band));
    };
    both({"griddata with estimated points", "climb/concave_2x2", 16, .0827, .0181}, {false, true});
    both({"griddata without", "climb/concave_2x2-bare", 16, .1443, .0246}, {false, false});
    both({"B-spline with estimated points", "climb/concave_2x2-spline", 472, .1657, .0713}, {true, false});
    both({"B-spline without", "climb/concave_2x2-spline-bare", 481, .2047, .062}, {true, false});
    report.holds("the B-spline needs many more touches", mean(report.of("climb/concave_2x2-spline/touches")) >
                                                             10 * mean(report.of("climb/concave_2x2/touches")));
    report.holds("griddata has the smaller band",
                 mean(report.of("climb/concave_2x2/band")) < mean(report.of("climb/concave_2x2-spline/band")));

    report.title("Table 4-4, 5 x 4 in patches: as few touches as the discards leave (k = 60/in, 0.7 in; for the small\n"
                 "anomaly 100/in, 0.6 in)");
    for (const Row& row : {Row{"concave 2 x 2", "climb/concave_2x2", 16, .0827, .0181},
                           {"convex 2 x 2", "climb/convex_2x2", 15, .0758, .0193},
                           {"saddle 2 x 2", "climb/saddle_2x2", 21, .1112, .0328},
                           {"concave 1 x 1", "climb/concave_1x1", 7, .0252, .0086},
                           {"convex 1 x 1", "climb/convex_1x1", 7, .0099, .0028},
                           {"saddle 1 x 1", "climb/saddle_1x1", 9, .0178, .0064}})
        both(row, {false, row.name.ends_with("2x2")});
    for (const std::string patch : {"concave", "convex", "saddle"})
        report.holds(patch + ": a larger anomaly has the larger band",
                     mean(report.of("climb/" + patch + "_2x2/band")) > mean(report.of("climb/" + patch + "_1x1/band")));
}

void strategies(Report& report)
{
    report.title("Table 4-5, error band, in: the simple strategy (median; must be within 25 %) and the best of as many "
                 "touches\nthat the search finds (mean; open as above)");
    struct Row {
        std::string what, name;
        double searched, simple;
    };
    for (const Row& row : {Row{"concave 2 x 2, 16 touches", "concave_2x2", .0961, .1196},
                           {"concave 1 x 1, 8 touches", "concave_1x1", .0272, .0506},
                           {"convex 2 x 2, 16 touches", "convex_2x2", .0790, .0991},
                           {"convex 1 x 1, 8 touches", "convex_1x1", .0112, .0497},
                           {"saddle 2 x 2, 16 touches", "saddle_2x2", .1206, .1658},
                           {"saddle 1 x 1, 8 touches", "saddle_1x1", .0210, .0615}}) {
        const double simple = quantile(report.of("simple/" + row.name), 0.5),
                     best = mean(report.of("best/" + row.name + "/band"));
        // The median of normal draws scatters by 1.25 times as much as the mean.
        report.near(row.what + ", simple", row.simple, simple, 1.25 * standard_error(report.of("simple/" + row.name)));
        report.shown(row.what + ", searched", row.searched, best);
        report.holds("the search is better than the simple strategy", best < simple);
        if (row.name.ends_with("2x2"))
            report.near("  searched, errors to 0.7 in from S", row.searched,
                        report.of("best/" + row.name + "-over/band"));
    }
}

void estimated(Report& report)
{
    report.title(
        "Table 4-3, error band, in: medians; one touch drawn in each of equal parts of a curve's side, where the "
        "paper\ndrew them by hand");
    const auto band = [&](const std::string& name) { return quantile(report.of("4-3/" + name), 0.5); };
    report.shown("3 curves of 6 points", .0827, band("3x6"));
    report.shown("3 curves of 4 points", .1213, band("3x4"));
    report.shown("2 curves of 6 points", .1597, band("2x6"));
    report.shown("2 curves of 4 points", .1670, band("2x4"));
    report.holds("more estimated points lead to better results",
                 band("3x6") < band("2x6") && band("3x4") < band("2x4"));
    report.holds("24 points: on more curves of fewer points they are better", band("3x4") < band("2x6"));

    report.words("The same with errors over all of S, not of the anomaly alone:");
    const auto over_all = [&](const std::string& what, const std::string& name, double published) {
        const std::vector<double>& bands = report.of("guess/over-sampling/4-3/" + name);
        report.near(what, published, quantile(bands, 0.5), 1.25 * standard_error(bands));
    };
    over_all("3 curves of 6 points", "3x6", .0827);
    over_all("3 curves of 4 points", "3x4", .1213);
    over_all("2 curves of 6 points", "2x6", .1597);
    over_all("2 curves of 4 points", "2x4", .1670);

    report.title(
        "Figure 4-8 and eq. 4-3: estimated points for each in2 of a square anomaly until the band of a saddle is\n"
        "0.1 in; the paper does not say how curved its saddles were");
    for (const std::string& radius : kRadii) {
        const double here = points_per_area(report.values(), radius);
        if (radius == "10")
            report.near("saddles of " + radius + " in, 1/in2", kPointsPerArea, here, 0);
        else
            report.shown("saddles of " + radius + " in, 1/in2", kPointsPerArea, here);
    }
}

void strips(Report& report)
{
    constexpr int kStrips = 4; // of 0.25 in; farther out the patch ends on some sides
    report.words(
        "\nFigures 4-9 and 4-10: share of the touches in strips of 0.25 in around the anomaly over that of the places");
    report.words("that might be touched there (the paper's histograms have no numbers)");
    for (const std::string patch : {"concave", "convex", "saddle"})
        for (const std::string size : {"2x2", "1x1"}) {
            const std::string name = "climb/" + patch + "_" + size;
            std::string shares = padded(patch + " " + size, 14);
            std::array<double, kStrips> density{};
            for (int i = 0; i < kStrips; ++i) {
                const std::string strip = std::to_string(i);
                density[static_cast<std::size_t>(i)] =
                    mean(report.of(name + "/strip" + strip)) / mean(report.of(name + "/even" + strip));
                shares += number(density[static_cast<std::size_t>(i)]);
            }
            report.words(shares);
            const double evenly = mean(report.of(name + "/even0"));
            report.holds("denser beside the anomaly than anywhere on the patch", density[0] - 1,
                         standard_error(report.of(name + "/strip0")) / evenly);
        }
}

void regressions(Report& report)
{
    report.title(
        "4.5: the published regressions on five surfaces each that are neither cylinders nor spheres: mean |predicted "
        "-\nactual|, in");
    report.at_most("convex, error band", .082, mean(report.of("others/convex/band_off")));
    report.at_most("convex, shift distance", .057, mean(report.of("others/convex/shift_off")));
    for (const std::string kind : {"swept", "concave", "saddle"})
        report.words(padded(kind, 10) + "error band" + number(mean(report.of("others/" + kind + "/band_off"))) +
                     "   shift distance" + number(mean(report.of("others/" + kind + "/shift_off"))));
    report.holds("the prediction is worse for saddles",
                 mean(report.of("others/saddle/band_off")) > mean(report.of("others/convex/band_off")));
}

void waves(Report& report)
{
    report.words(
        "\nFigure 4-4: waviness of griddata through 30 scattered touches, rms height inside the anomaly of the waves");
    report.words(
        "shorter than 0.8 in, of the errors, in (median); the paper does not say which points make a wavy surface");
    for (const auto& [name, what] : {std::pair("4-4/", "scattered"), {"4-4/pairs/", "in pairs 0.05 in apart"}}) {
        const auto median = [&, name = std::string(name)](const std::string& of) {
            return quantile(report.of(name + of), 0.5);
        };
        report.words(padded(what, 24) + number(median("before")) + " interpolated once," + number(median("after")) +
                     " sampled again");
        report.holds("sampled again it is less wavy", median("ratio") < 1);
    }
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Wang's tables, measured and published.", [](cli::Tool& t) {
        const std::string& path = t.main_input("VALUES", "Lines NAME VALUE of the programs tables-*");
        t.reference("Wang 2007, chapter 4");
        t.parse();

        const Values values = read_values(path);
        Report report(t.output(), values);
        planes(report);
        line(report);
        searches(report);
        strategies(report);
        estimated(report);
        strips(report);
        regressions(report);
        waves(report);
        guesses(report);
        return report.missed() == 0 ? cli::Verdict::yes : cli::Verdict::no;
    });
}
