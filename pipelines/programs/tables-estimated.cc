// What the estimated points bring (Wang 2007, Table 4-3 and figure 4-8) and the simple strategy (right half of Table
// 4-5).

#include "cli/tool.h"
#include "core/decompositions.h"
#include "core/error.h"
#include "job/boundary.h"
#include "sampling/estimate.h"
#include "sampling/freeform.h"
#include "tables-griddata.h"

#include <unsupported/Eigen/Splines>

#include <algorithm>
#include <array>
#include <cmath>

#include <optional>
#include <ostream>
#include <sstream>
#include <vector>

using namespace fettle;
using namespace fettle::study;

namespace {

double griddata_size(const Variant& variant, const job::Job& job, const Height& truth, const Eigen::Matrix3Xd& touches,
                     const Eigen::Matrix3Xd& estimated, std::uint64_t seed)
{
    return size_of(variant, griddata_errors(variant, job, truth, touches, estimated, seed));
}

/// The simple strategy with this number of lines in each direction.
/// @param bare  without the estimated points
double simple_band(const Variant& variant, const job::Job& job, const Height& truth, const sampling::LineCount& lines,
                   std::uint64_t seed, bool bare = false)
{
    const sampling::TouchPlan plan = sampling::plan_freeform(job, lines);
    const Eigen::Matrix3Xd touches = touch(variant, truth, plan.xy, seed);
    const Eigen::Matrix3Xd estimated = sampling::estimated_points(job, touches, plan.curve, plan.role);
    return griddata_size(variant, job, truth, touches, bare ? Eigen::Matrix3Xd(3, 0) : estimated, seed);
}

// --- Table 4-3: any number of points on each curve, drawn on either side of the anomaly ---

struct Curve {
    Eigen::VectorXd along, z; ///< ascending
};

/// The interpolating cubic spline, at t.
double spline_at(const Curve& curve, double t)
{
    using Spline = Eigen::Spline<double, 1>;
    const double first = curve.along[0], length = curve.along[curve.along.size() - 1] - first;
    const Eigen::RowVectorXd parameters = (curve.along.array() - first).transpose() / length;
    return Eigen::SplineFitting<Spline>::Interpolate(curve.z.transpose(), 3, parameters)((t - first) / length)[0];
}

/// The cubic of least squares, at t.
double cubic_at(const Curve& curve, double t)
{
    constexpr int kCoefficients = 4;
    const double middle = curve.along.mean(), half = (curve.along.maxCoeff() - curve.along.minCoeff()) / 2;
    const auto powers = [&](double x) {
        const double u = (x - middle) / half;
        return Eigen::RowVector4d(1, u, u * u, u * u * u);
    };
    Eigen::MatrixXd model(curve.along.size(), kCoefficients);
    for (Eigen::Index i = 0; i < model.rows(); ++i) model.row(i) = powers(curve.along[i]);
    return powers(t).dot(core::least_squares_by_qr(model, curve.z).x);
}

/// @param across  number of curves in each set   @param points  on each curve
double drawn_band(const Variant& variant, const job::Job& job, const Height& truth, int across, int points,
                  std::uint64_t seed)
{
    Random random(seed);
    const job::Boundaries both = job::working_boundaries(job);
    const Eigen::Vector2d min = both.anomaly.rowwise().minCoeff(), max = both.anomaly.rowwise().maxCoeff();
    std::vector<Eigen::Vector3d> touches;
    std::array<std::vector<Curve>, 2> sets; // set k: curves along axis k
    const auto offset = [&](int axis, int i) { return std::lerp(min[axis], max[axis], (i + 1) / (across + 1.0)); };
    for (int axis = 0; axis < 2; ++axis)
        for (int i = 0; i < across; ++i) {
            Eigen::Vector2d origin = Eigen::Vector2d::Zero();
            origin[1 - axis] = offset(1 - axis, i);
            const sampling::Crossings t = *sampling::crossings_around(both, origin, Eigen::Vector2d::Unit(axis), 0);
            Curve curve{Eigen::VectorXd(points), Eigen::VectorXd(points)};
            // One in each of equal parts of a side: two that lie next to each other make a wild cubic.
            const int half = points / 2;
            for (int k = 0; k < points; ++k) {
                const double from = k < half ? t[0] : t[2], to = k < half ? t[1] : t[3];
                const double share = random.uniform(0, 1);
                curve.along[k] = from + (to - from) * (variant.anywhere ? share : (k % half + share) / half);
            }
            std::ranges::sort(curve.along);
            Eigen::Matrix2Xd xy = origin.replicate(1, points);
            xy.row(axis) = curve.along.transpose();
            const Eigen::Matrix3Xd touched = touch(variant, truth, xy, seed_of(seed, touches.size() + 1));
            curve.z = touched.row(2);
            for (const Eigen::Vector3d& point : touched.colwise()) touches.push_back(point);
            sets[static_cast<std::size_t>(axis)].push_back(std::move(curve));
        }
    Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(touches.size())), estimated(3, across * across);
    for (std::size_t i = 0; i < touches.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = touches[i];
    Eigen::Index next = 0;
    for (int i = 0; i < across; ++i)
        for (int k = 0; k < across; ++k) {
            const double x = offset(0, i), y = offset(1, k);
            const auto at = variant.one_cubic ? cubic_at : spline_at;
            const double z =
                (at(sets[1][static_cast<std::size_t>(i)], y) + at(sets[0][static_cast<std::size_t>(k)], x)) / 2;
            estimated.col(next++) << x, y, z;
        }
    return griddata_size(variant, job, truth, all, estimated, seed);
}

// --- figure 4-8: the minimum number of estimated points within the tolerance ---

constexpr double kTolerance = 0.1;                                 // in
constexpr int kMaxCurves = 15;                                     // 60 touches
constexpr std::array<double, 5> kSides = {1, 3.25, 5.5, 7.75, 10}; // in

/// Hollow along x, arched along y, with the same curvature at the middle, 1/in.
Height saddle(double curvature)
{
    return [=](const Eigen::Vector2d& xy) { return curvature / kInch * (xy.x() * xy.x() - xy.y() * xy.y()) / 2; };
}

/// Wang 2007, eq. 4-4: the curves for n estimated points.
sampling::LineCount lines_for(int n, double a, double b)
{
    constexpr double kBeforeCeiling = 1e-9;
    const auto up = [](double x) { return static_cast<int>(std::ceil(x - kBeforeCeiling)); };
    const int n_a = std::max(1, up(std::sqrt(n * a / b)));
    return {n_a, std::max(1, up(n_a * b / a))};
}

/// Nothing if no number of curves that may be touched suffices.
std::optional<int> min_point_count(double a, double b, double distance, const Height& surface, std::uint64_t seed)
{
    job::Job job;
    const Eigen::Vector2d half = Eigen::Vector2d(a, b) * kInch / 2;
    const Eigen::Vector2d outer = half.array() + distance * kInch;
    job.anomaly = rectangle(-half, half);
    job.sampling = rectangle(-outer, outer);
    int tried = 0;
    for (int n = 1; n <= kMaxCurves * kMaxCurves / 4; ++n) {
        const sampling::LineCount lines = lines_for(n, a, b);
        const int number = lines.across_a * lines.across_b;
        if (number == tried) continue;
        if (lines.across_a + lines.across_b > kMaxCurves) continue;
        tried = number;
        if (simple_band({}, job, surface, lines, seed) <= kTolerance) return number;
    }
    return {};
}

/// One line of the figure: a radius of curvature, in.
void figure_4_8(std::ostream& out, double radius, std::uint64_t seed)
{
    std::uint64_t trial = 0;
    for (const double a : kSides)
        for (const double b : kSides)
            for (const double distance : kSides) {
                const std::optional<int> number =
                    min_point_count(a, b, distance, saddle(1 / radius), seed_of(seed, ++trial));
                std::ostringstream name;
                name << "4-8/" << radius << '/' << a * b;
                if (!number) name << "/none";
                write(out, name.str(), number.value_or(1));
            }
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "What the estimated points bring.", [](cli::Tool& t) {
        const std::string& what = t.positional_choice("WHAT", {"4-3", "4-5", "4-8", "gain"}, "Table or figure");
        const std::string& job_file = t.text("--job", "", "JOB", "Job, JSON");
        const std::string& patch = t.text("--patch", "", "PATCH", "The surface, JSON");
        const std::string& name = t.text("--name", "", "NAME", "Before each value of Table 4-5");
        const int& lines = t.count("--lines", 2, "Each way, Table 4-5", 1, sampling::kMaxProbingLines);
        const int& trials = t.count("--trials", 100, "Draws of touches and noise", 1, 1000000);
        const VariantOptions options(t);
        const double& radius =
            t.number("--radius", 25, "LENGTH", "Figure 4-8: of the saddles' curvature, in", core::Range::positive());
        t.parse();

        std::ostream& out = t.output();
        const Variant variant = options.variant();
        if (what == "4-8") {
            figure_4_8(out, radius, t.seed());
            return cli::Verdict::yes;
        }
        const job::Job job = job::read_job(job_file);
        const Height truth = patch_height(patch);
        for (int trial = 1; trial <= trials; ++trial) {
            const std::uint64_t seed = seed_of(t.seed(), static_cast<std::uint64_t>(trial));
            if (what == "4-5") {
                write(out, name, simple_band(variant, job, truth, {lines, lines}, seed));
                continue;
            }
            if (what == "gain") {
                write(out, "gain",
                      simple_band(variant, job, truth, {lines, lines}, seed, true) /
                          simple_band(variant, job, truth, {lines, lines}, seed));
                continue;
            }
            for (const int across : {3, 2})
                for (const int points : {6, 4})
                    write(out, "4-3/" + std::to_string(across) + "x" + std::to_string(points),
                          drawn_band(variant, job, truth, across, points, seed));
        }
        return cli::Verdict::yes;
    });
}
