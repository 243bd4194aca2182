// The factorial experiment of Wang 2007, 4.5, as a whole: bands by method, the regressions fitted again beside the
// published ones, Wang's observations, and what must be reached.

#include "factorial.h"

#include "cli/tool.h"
#include "core/decompositions.h"
#include "core/text.h"

#include <cstdio>
#include <functional>
#include <ostream>

using namespace fettle;
using namespace factorial;

namespace {

constexpr double kMil = 1e-3; // in

std::string number(double value, int width, int decimals)
{
    char text[64];
    if (std::isnan(value))
        std::snprintf(text, sizeof text, "%*s", width, "-");
    else
        std::snprintf(text, sizeof text, "%*.*f", width, decimals, value);
    return text;
}

std::string left(const std::string& word, std::size_t width)
{
    return word + std::string(width - std::min(width, word.size()), ' ');
}
std::string right(const std::string& word, std::size_t width)
{
    return std::string(width - std::min(width, word.size()), ' ') + word;
}

/// A method's band over another number of the cell.
template <typename Number>
std::vector<double> to(const Cells& cells, const std::string& method, const Number& other)
{
    return each(cells, [&](const Cell& cell) { return cell.error(method, band) / other(cell); });
}

double mean_covered(const Cells& cells, const std::string& method)
{
    double sum = 0;
    int count = 0;
    for (const Cell& cell : cells)
        if (const double share = cell.error(method, covered); !std::isnan(share)) sum += share, ++count;
    return sum / count;
}

void print_methods(std::ostream& out, const Study& study)
{
    out << "Error bands (Wang 2007, eq. 4-1) in mil, 0.001 in.   none: cells without a surface; covered: mean share of "
           "the\n"
           "anomaly over which there is one, which the band is about; limit: the band that the least squares fit of "
           "the\n"
           "true family has, the median over its noise\n\n"
           "surface         method              none covered   median    90 % / Wang's  / limit    90 %   worst\n";
    for (const auto& [surface, cells] : study.surfaces) {
        const std::string& own = kinds().at(surface).method;
        for (const std::string& method : study.methods) {
            const auto bands = each(cells, [&](const Cell& cell) { return cell.error(method, band) / kMil; });
            const auto none = std::count_if(bands.begin(), bands.end(), [](double value) { return std::isnan(value); });
            const auto to_limit = to(cells, method, [](const Cell& cell) { return cell.limit; });
            const auto to_own = to(cells, method, [&](const Cell& cell) { return cell.error(own, band); });
            out << left(surface, 16) << left(method + (method == own ? " (Wang's)" : ""), 18)
                << number(static_cast<double>(none), 6, 0) << number(100 * mean_covered(cells, method), 6, 0) << " %"
                << number(median(bands), 9, 2) << number(quantile(bands, 0.9), 8, 2) << number(median(to_own), 9, 2)
                << number(median(to_limit), 9, 2) << number(quantile(to_limit, 0.9), 8, 2)
                << number(quantile(to_limit, 1), 8, 1) << "\n";
        }
    }
}

struct Refit {
    Eigen::VectorXd coefficients;
    double explained = kNaN; ///< R²
    double rms = kNaN;       ///< of the residuals, in
};

/// Least squares of a quantity over the terms; nothing where the cells do not determine it.
Refit refit(const Cells& cells, const std::string& method, Quantity quantity)
{
    std::vector<const Cell*> used;
    for (const Cell& cell : cells)
        if (std::isfinite(cell.error(method, quantity))) used.push_back(&cell);
    const Eigen::Index count = std::ssize(used), terms = cells.front().terms.size();
    Eigen::MatrixXd model(count, terms);
    Eigen::VectorXd measured(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const Cell& cell = *used[static_cast<std::size_t>(i)];
        model.row(i) = cell.terms.transpose();
        measured[i] = cell.error(method, quantity);
    }
    Refit result{Eigen::VectorXd::Constant(terms, kNaN)};
    if (count <= terms) return result;
    const core::LeastSquaresSolution fit = core::least_squares_by_qr(model, measured);
    if (fit.rank < terms) return result; // the terms are not independent
    result.coefficients = fit.x;
    const double residual = (measured - model * result.coefficients).squaredNorm();
    result.explained = 1 - residual / (measured.array() - measured.mean()).matrix().squaredNorm();
    result.rms = std::sqrt(residual / static_cast<double>(count));
    return result;
}

void print_row(std::ostream& out, const std::string& name, const Eigen::VectorXd& coefficients)
{
    out << left(name, 24);
    for (const double coefficient : coefficients) out << number(coefficient, 12, 4);
}

void print_regressions(std::ostream& out, const Study& study)
{
    out << "\nRegressions (Wang 2007, 4.5; inches), published and fitted anew to the bands and shifts of these cells. "
           "R2: share of\n"
           "the variance explained; rms of the residuals, mil; predicted and measured: medians, mil; negative: share "
           "of the\n"
           "cells where the published prediction is below 0.\n";
    for (const auto& [surface, cells] : study.surfaces) {
        const Kind& kind = kinds().at(surface);
        const margin::Regression& published = margin::published_regression(kind.regression);
        for (const Quantity quantity : {band, shift}) {
            const auto predicted = each(cells, [&](const Cell& cell) { return cell.published(kind, quantity); });
            const auto negative = std::count_if(predicted.begin(), predicted.end(), [](double p) { return p < 0; });
            out << "\n" << left(surface + (quantity == band ? ", band" : ", shift"), 24);
            for (const std::string& term : margin::regression_terms(kind.regression)) out << right(term, 12);
            out << "      R2   rms   predicted  measured  negative\n";
            print_row(out, "published", quantity == band ? published.band : published.shift);
            out << right("-", 8) << right("-", 6) << number(median(predicted) / kMil, 12, 2) << right("-", 10)
                << number(100.0 * static_cast<double>(negative) / static_cast<double>(cells.size()), 8, 1) << " %\n";
            for (const std::string& method : {kind.method, std::string("auto")}) {
                const Refit fit = refit(cells, method, quantity);
                print_row(out, method, fit.coefficients);
                const auto errors = each(cells, [&](const Cell& cell) { return cell.error(method, quantity); });
                out << number(fit.explained, 8, 2) << number(fit.rms / kMil, 6, 1) << right("-", 12)
                    << number(median(errors) / kMil, 10, 2) << "\n";
            }
        }
    }
}

using Pairs = std::vector<std::pair<const Cell*, const Cell*>>;

Pairs pairs(const Cells& cells, const std::function<bool(const Cell&, const Cell&)>& differ)
{
    Pairs found;
    for (const Cell& less : cells)
        for (const Cell& more : cells)
            if (differ(less, more)) found.emplace_back(&less, &more);
    return found;
}

/// How a quantity changes from the first to the second cell: the median ratio.
double influence(const Pairs& pairs, const std::string& method, Quantity quantity)
{
    std::vector<double> changes;
    for (const auto& [less, more] : pairs)
        changes.push_back(more->error(method, quantity) / less->error(method, quantity));
    return median(changes);
}

void print_observations(std::ostream& out, const Study& study)
{
    struct Observation {
        std::string name;
        std::function<bool(const Cell&, const Cell&)> differ;
    };
    // Areas of the experiment that differ by less than this are the same: 1 x 10 and 3.25 x 3.25, for one.
    constexpr double kMaxAreaRatio = 1.1;
    const auto same_sides = [](const Cell& a, const Cell& b) { return a.width == b.width && a.length == b.length; };
    const auto ends = [](double a, double b, double min, double max) { return a == min && b == max; };
    const std::vector<Observation> observations = {
        {"(a) slimmer, same area",
         [](const Cell& a, const Cell& b) {
             return a.radius == b.radius && a.distance == b.distance && a.slimness() == 1 && b.slimness() > 1 &&
                    std::max(a.area(), b.area()) <= kMaxAreaRatio * std::min(a.area(), b.area());
         }},
        {"(b) distance 1 to 10 in",
         [&](const Cell& a, const Cell& b) {
             return ends(a.distance, b.distance, 1, 10) && a.radius == b.radius && same_sides(a, b);
         }},
        {"(c) area 1 to 100 in2",
         [&](const Cell& a, const Cell& b) {
             return ends(a.area(), b.area(), 1, 100) && a.radius == b.radius && a.distance == b.distance;
         }},
        {"(d) curvature 1/225 to 1/25",
         [&](const Cell& a, const Cell& b) {
             return ends(b.radius, a.radius, 25, 225) && a.distance == b.distance && same_sides(a, b);
         }},
    };
    out << "\nFigure 4-14: by what factor band and shift change (median over all pairs of cells). Wang saw each of "
           "them grow.\n\n"
        << left("surface         method", 29);
    for (const Observation& observation : observations) out << right(observation.name, 29);
    out << "\n";
    for (const auto& [surface, cells] : study.surfaces) {
        std::vector<Pairs> compared;
        for (const Observation& observation : observations) compared.push_back(pairs(cells, observation.differ));
        for (const std::string& method : {kinds().at(surface).method, std::string("auto")}) {
            out << left(surface, 16) << left(method, 13);
            for (const Pairs& found : compared)
                out << number(influence(found, method, band), 20, 2) << number(influence(found, method, shift), 9, 2);
            out << "\n";
        }
    }
}

/// The figures that must be reached, over all the cells.
class Bars {
  public:
    explicit Bars(std::ostream& out) : out_(out) { out_ << "\nMust be reached\n"; }

    void between(const std::string& name, double value, double min, double max)
    {
        const bool good = value >= min && value <= max;
        reached_ = reached_ && good;
        out_ << left(name, 72) << number(value, 8, 3) << "   " << core::to_short_text(min) << " to "
             << core::to_short_text(max) << (good ? "" : "   MISSED") << "\n";
    }
    void at_most(const std::string& name, double value, double max) { between(name, value, 0, max); }
    bool reached() const { return reached_; }

  private:
    std::ostream& out_;
    bool reached_ = true;
};

bool check_claims(std::ostream& out, const Study& study)
{
    Bars bars(out);
    Cells all;
    int without = 0;
    for (const auto& [surface, cells] : study.surfaces) {
        all.insert(all.end(), cells.begin(), cells.end());
        for (const Cell& cell : cells)
            if (cell.error("auto", covered) != 1 || cell.error(kinds().at(surface).method, covered) != 1) ++without;
    }
    bars.at_most("cells without a surface over all of the anomaly, by Wang's method or by auto", without, 0);
    const auto to_limit = to(all, "auto", [](const Cell& cell) { return cell.limit; });
    bars.at_most("auto, band / limit, all cells: median", median(to_limit), 1.05);
    bars.at_most("auto, band / limit, all cells: 90 %", quantile(to_limit, 0.9), 1.9);
    bars.at_most("auto, band / limit, all cells: worst", quantile(to_limit, 1), 6);
    for (const auto& [surface, cells] : study.surfaces) {
        const std::string& own = kinds().at(surface).method;
        const auto ratio = to(cells, "auto", [&](const Cell& cell) { return cell.error(own, band); });
        bars.at_most("auto, band / Wang's " + own + ", " + surface + ": median", median(ratio),
                     own == "swept" ? 1 : 0.25);
    }
    if (!study.surfaces.contains("cylinder")) return bars.reached();
    const Cells& swept = study.surfaces.at("cylinder");
    const Kind& kind = kinds().at("cylinder");
    const auto negative = std::count_if(swept.begin(), swept.end(), [&](const Cell& cell) {
        return std::min(cell.published(kind, band), cell.published(kind, shift)) < 0;
    });
    bars.between("published regressions, swept: share of the cells below 0 (a third)",
                 static_cast<double>(negative) / static_cast<double>(swept.size()), 0.28, 0.39);
    return bars.reached();
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Tables of Wang's factorial experiment, and what must be reached.", [](cli::Tool& t) {
            const std::string& path = t.main_input("CELLS", "Batches of the program factorial, merged");
            t.reference("Wang 2007, 4.5");
            t.parse();
            const Study study = read_study(path);
            print_methods(t.output(), study);
            print_regressions(t.output(), study);
            print_observations(t.output(), study);
            return check_claims(t.output(), study) ? cli::Verdict::yes : cli::Verdict::no;
        });
}
