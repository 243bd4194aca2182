// Waviness of griddata before and after it is sampled uniformly and interpolated again (Wang 2007, figure 4-4).

#include "cli/tool.h"
#include "cloud/pcd.h"
#include "core/constants.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "surface/griddata.h"
#include "tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>

using namespace fettle;
using namespace fettle::study;

namespace {

constexpr int kPoints = 30; // scattered over S
// Touches side by side, as an operator makes them who repeats one.
constexpr double kPairDistance = 0.05 * kInch;

/// Places inside S, a square grid, row by row.
struct Sheet {
    Eigen::Matrix2Xd xy;
    Eigen::Index columns = 0;
    double step = 0;
};

Sheet sheet_over(const job::Polygon& outline, double step)
{
    const Eigen::Vector2d min = outline.rowwise().minCoeff(), size = outline.rowwise().maxCoeff() - min;
    const auto columns = static_cast<Eigen::Index>(size.x() / step), rows = static_cast<Eigen::Index>(size.y() / step);
    Sheet sheet{Eigen::Matrix2Xd(2, (columns + 1) * (rows + 1)), columns + 1, step};
    for (Eigen::Index i = 0; i < sheet.xy.cols(); ++i)
        sheet.xy.col(i) = min + step * Eigen::Vector2d(static_cast<double>(i % sheet.columns),
                                                       static_cast<double>(i / sheet.columns));
    return sheet;
}

/// The waves inside B that are shorter than the cut-off: what is left of the errors when their mean under the weight of
/// the Gaussian profile filter (ISO 16610-21, -61) is taken away. mm; NaN elsewhere
Eigen::VectorXd waves(const Sheet& sheet, const Eigen::VectorXd& errors, const job::Polygon& anomaly, double cut_off)
{
    const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
    const auto reach = static_cast<Eigen::Index>(cut_off / sheet.step); // the weight there is 6e-7
    const Eigen::Index rows = errors.size() / sheet.columns;
    Eigen::VectorXd heights = Eigen::VectorXd::Constant(errors.size(), core::kNaN);
    for (Eigen::Index row = 0; row < rows; ++row)
        for (Eigen::Index column = 0; column < sheet.columns; ++column) {
            const Eigen::Index here = row * sheet.columns + column;
            if (!job::contains(anomaly, sheet.xy.col(here)) || std::isnan(errors[here])) continue;
            double sum = 0, weights = 0;
            for (Eigen::Index r = std::max<Eigen::Index>(0, row - reach); r <= std::min(rows - 1, row + reach); ++r)
                for (Eigen::Index c = std::max<Eigen::Index>(0, column - reach);
                     c <= std::min(sheet.columns - 1, column + reach); ++c) {
                    const Eigen::Index there = r * sheet.columns + c;
                    if (std::isnan(errors[there])) continue;
                    const double distance = (sheet.xy.col(there) - sheet.xy.col(here)).norm() / (alpha * cut_off);
                    const double weight = std::exp(-std::numbers::pi * distance * distance);
                    sum += weight * errors[there];
                    weights += weight;
                }
            heights[here] = errors[here] - sum / weights;
        }
    return heights;
}

double rms(const Eigen::VectorXd& heights)
{
    const auto defined = (heights.array() == heights.array()).eval();
    return std::sqrt(defined.select(heights, 0).squaredNorm() / double(defined.count()));
}

/// The surface with its waves as errors.
void draw_surface(std::ostream& out, const Sheet& sheet, const Eigen::VectorXd& z, const Eigen::VectorXd& heights,
                  const units::Units& units)
{
    cloud::Cloud cloud;
    cloud.xyz.resize(3, sheet.xy.cols());
    cloud.xyz << sheet.xy, z.transpose();
    cloud::set_field(cloud, "error", heights);
    cloud::write_pcd(out, cloud, units, cloud::PcdEncoding::binary);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Waviness of griddata before and after resampling.", [](cli::Tool& t) {
        const std::string& job_file = t.positional_file("JOB", "Job, JSON");
        const std::string& patch = t.positional_file("PATCH", "The surface, JSON");
        const int& trials = t.count("--trials", 50, "Scatterings of the points", 1, 100000);
        const double& wavelength = t.number(
            "--wavelength", 1, "LENGTH", "The shortest that is kept: twice the spacing, in", core::Range::positive());
        const bool& pairs = t.flag("--pairs", "The points come in pairs, 0.05 in apart");
        const std::string& name = t.text("--name", "4-4", "NAME", "Before each value");
        const std::string& before_file = t.text("--before", "", "FILE", "The first surface as it was, PCD");
        const std::string& after_file = t.text("--after", "", "FILE", "The first surface sampled again, PCD");
        t.parse();

        const job::Job job = job::read_job(job_file);
        const job::Boundaries both = job::working_boundaries(job);
        const Height truth = patch_height(patch);
        const double spacing = wavelength * kInch / 2, cut_off = 2 * spacing;
        const Sheet sheet = sheet_over(both.sampling, cut_off / 10);
        const Eigen::VectorXd true_z = study::heights(truth, sheet.xy);
        for (int trial = 1; trial <= trials; ++trial) {
            const std::uint64_t seed = seed_of(t.seed(), static_cast<std::uint64_t>(trial));
            Random random(seed);
            const Eigen::Vector2d min = both.sampling.rowwise().minCoeff(), max = both.sampling.rowwise().maxCoeff();
            Eigen::Matrix2Xd xy(2, kPoints);
            for (int i = 0; i < kPoints;) {
                xy.col(i) = pairs && i % 2 == 1 ? Eigen::Vector2d(xy.col(i - 1) + Eigen::Vector2d(kPairDistance, 0))
                                                : random.in_box(min, max);
                if (!job::contains(both.anomaly, xy.col(i)))
                    ++i;
                else
                    i -= pairs ? i % 2 : 0;
            }
            const Eigen::Matrix3Xd touches = touch(truth, xy, seed_of(seed, 1));
            const Eigen::VectorXd once = surface::griddata_heights(touches, 0, job.theta, sheet.xy);
            const Eigen::VectorXd twice = surface::griddata_heights(touches, spacing, job.theta, sheet.xy);
            const Eigen::VectorXd waves_before = waves(sheet, once - true_z, both.anomaly, cut_off),
                                  waves_after = waves(sheet, twice - true_z, both.anomaly, cut_off);
            const double before = rms(waves_before), after = rms(waves_after);
            write(t.output(), name + "/before", before / kInch);
            write(t.output(), name + "/after", after / kInch);
            write(t.output(), name + "/ratio", after / before);
            if (trial > 1) continue;
            if (!before_file.empty()) draw_surface(t.output_file(before_file), sheet, once, waves_before, job.units);
            if (!after_file.empty()) draw_surface(t.output_file(after_file), sheet, twice, waves_after, job.units);
        }
        return cli::Verdict::yes;
    });
}
