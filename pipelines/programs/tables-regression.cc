// Wang's factorial experiment (2007, 4.5) on spheres, with what the paper leaves open: the area term of the regression,
// and by what factors the error grows in figure 4-14 (a) and (b).

#include "cli/tool.h"
#include "core/decompositions.h"
#include "core/error.h"
#include "margin/regression.h"
#include "sampling/estimate.h"
#include "sampling/freeform.h"
#include "tables-griddata.h"
#include "tables-values.h"

#include <array>
#include <cmath>
#include <ostream>
#include <vector>

using namespace fettle;
using namespace fettle::study;

namespace {

constexpr std::array<double, 5> kLevels = {1, 3.25, 5.5, 7.75, 10}; // in

struct Cell {
    double radius, width, length, distance; ///< in
    double size = 0;                        ///< of the error, in
    Eigen::VectorXd terms;
};

Height concave_sphere(double radius)
{
    const double r = radius * kInch;
    return [=](const Eigen::Vector2d& xy) { return r - std::sqrt(r * r - xy.squaredNorm()); };
}

/// How many lines cross the anomaly in each direction.
enum class Lines { by_equation, swapped, one, two };

sampling::TouchPlan plan_lines(const job::Job& job, Lines lines, const sampling::LineCount& by_equation)
{
    switch (lines) {
    case Lines::swapped:
        return sampling::plan_freeform(job, sampling::LineCount{by_equation.across_b, by_equation.across_a});
    case Lines::one:
        return sampling::plan_freeform(job, sampling::LineCount{1, 1});
    case Lines::two:
        return sampling::plan_freeform(job, sampling::LineCount{2, 2});
    case Lines::by_equation:
        break;
    }
    return sampling::plan_freeform(job, by_equation);
}

void run(const Variant& variant, Lines lines, std::uint64_t seed, Cell& cell)
{
    job::Job job;
    const Eigen::Vector2d half = Eigen::Vector2d(cell.width, cell.length) * kInch / 2;
    const Eigen::Vector2d outer = half.array() + cell.distance * kInch;
    job.anomaly = rectangle(-half, half);
    job.sampling = rectangle(-outer, outer);
    const Height truth = concave_sphere(cell.radius);
    const sampling::TouchPlan plan =
        plan_lines(job, lines, sampling::line_count(cell.width * kInch, cell.length * kInch));
    const Eigen::Matrix3Xd touches = touch(variant, truth, plan.xy, seed);
    const Eigen::Matrix3Xd estimated = sampling::estimated_points(job, touches, plan.curve, plan.role);
    cell.size = size_of(variant, griddata_errors(variant, job, truth, touches, estimated, seed));
    cell.terms = margin::regression_values(margin::RegressionKind::concave, touches, job);
}

/// Coefficient of the area, by least squares over the cells.
double area_term(const std::vector<Cell>& cells)
{
    const auto count = static_cast<Eigen::Index>(cells.size());
    Eigen::MatrixXd model(count, cells.front().terms.size());
    Eigen::VectorXd sizes(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        model.row(i) = cells[static_cast<std::size_t>(i)].terms.transpose();
        sizes[i] = cells[static_cast<std::size_t>(i)].size;
    }
    constexpr Eigen::Index kArea = 1; // after the curvature
    return core::least_squares_by_qr(model, sizes).x[kArea];
}

/// Median ratio of the second cell's error to the first's over the pairs.
template <typename Pair>
double growth(const std::vector<Cell>& cells, const Pair& is_pair)
{
    std::vector<double> ratios;
    for (const Cell& less : cells)
        for (const Cell& more : cells)
            if (less.radius == more.radius && is_pair(less, more)) ratios.push_back(more.size / less.size);
    return quantile(ratios, 0.5);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "The factorial experiment on spheres, with what the paper leaves open.", [](cli::Tool& t) {
            const VariantOptions options(t);
            const int& every = t.count("--every", 4, "Of the 21 radii, take every Nth", 1, 21);
            const Lines& lines =
                t.choice<Lines>("--lines",
                                {{"equation", Lines::by_equation},
                                 {"swapped", Lines::swapped},
                                 {"one", Lines::one},
                                 {"two", Lines::two}},
                                "Across the anomaly: eq. 4-5, its two numbers swapped, one, two each way");
            t.parse();

            const Variant variant = options.variant();
            std::vector<Cell> cells;
            for (double radius = 25; radius <= 225; radius += 10 * every)
                for (const double width : kLevels)
                    for (const double length : kLevels)
                        for (const double distance : kLevels) {
                            cells.push_back({radius, width, length, distance, 0, {}});
                            run(variant, lines, seed_of(t.seed(), cells.size()), cells.back());
                        }
            std::ostream& out = t.output();
            write(out, "area", area_term(cells));
            write(out, "slimmer", growth(cells, [](const Cell& less, const Cell& more) {
                      // 3.25 x 3.25 in and 1 x 10 in: the same area within 6 %
                      return less.distance == more.distance && less.width == 3.25 && less.length == 3.25 &&
                             std::min(more.width, more.length) == 1 && std::max(more.width, more.length) == 10;
                  }));
            write(out, "farther", growth(cells, [](const Cell& less, const Cell& more) {
                      return less.width == more.width && less.length == more.length && less.distance == 1 &&
                             more.distance == 10;
                  }));
            return cli::Verdict::yes;
        });
}
