// One batch of the factorial experiment of Wang 2007, 4.5: one surface of one curvature, 125 cells, every method of
// fit. A cell's touch noise is drawn by its number, so that it is the same in every batch and on every machine.

#include "cli/tool.h"
#include "core/text.h"
#include "fit/fit.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "margin/regression.h"
#include "sampling/estimate.h"
#include "sampling/noise.h"
#include "sampling/touch_plan.h"
#include "surface/shapes.h"

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <ostream>

using namespace fettle;

namespace {

constexpr double kInch = 25.4;
// Anomaly widths and lengths, and farthest sampling distances, in.
constexpr std::array kLevels = {1.0, 3.25, 5.5, 7.75, 10.0};
constexpr int kLevelCount = std::ssize(kLevels);
// Radii, in.
constexpr int kMinRadius = 25, kMaxRadius = 225, kRadiusStep = 10;
constexpr int kRadiusCount = (kMaxRadius - kMinRadius) / kRadiusStep + 1;
constexpr int kBatch = kLevelCount * kLevelCount * kLevelCount;

// 99 % of the touch errors lie within, mm.
constexpr double kAccuracy = 0.005 * kInch;
// The errors are evaluated on a grid of that many points over the longer side of the anomaly, and along its edge:
// cubic pieces between touches bend over a fifth of the side or more.
constexpr int kAcross = 40;
// Seeds of the corners' noise begin beyond those of the cells' touches.
constexpr std::uint64_t kCornerSeeds = std::uint64_t{1} << 32;
// Draws of the touch noise for the limit: the median of so many bands scatters by 4 % of itself.
constexpr int kLimitDraws = 199;

struct Kind {
    std::string name;
    job::SurfaceType type;
    margin::RegressionKind regression;
    std::function<double(double x, double y, double radius)> height; ///< highest, lowest or saddle point at 0
};

double arc(double distance2, double radius) { return std::sqrt(radius * radius - distance2) - radius; }

const std::vector<Kind>& kinds()
{
    // The cylinder's axis runs along X: the swept jobs' rulings.
    static const std::vector<Kind> all = {
        {"cylinder", job::SurfaceType::swept, margin::RegressionKind::swept,
         [](double, double y, double r) { return arc(y * y, r); }},
        {"sphere-convex", job::SurfaceType::freeform, margin::RegressionKind::convex,
         [](double x, double y, double r) { return arc(x * x + y * y, r); }},
        {"sphere-concave", job::SurfaceType::freeform, margin::RegressionKind::concave,
         [](double x, double y, double r) { return -arc(x * x + y * y, r); }},
        {"saddle", job::SurfaceType::freeform, margin::RegressionKind::saddle,
         [](double x, double y, double r) { return (y * y - x * x) / (2 * r); }},
    };
    return all;
}

/// One combination of the factors; lengths in mm.
struct Cell {
    int number;
    const Kind* kind;
    double radius, width, length, distance;
};

/// @param place  of the cell within its batch
Cell cell_at(int kind, int radius, int place)
{
    const auto level = [](int index) { return kInch * kLevels[static_cast<std::size_t>(index % kLevelCount)]; };
    const int batch = kind * kRadiusCount + (radius - kMinRadius) / kRadiusStep;
    return {batch * kBatch + place,
            &kinds()[static_cast<std::size_t>(kind)],
            kInch * radius,
            level(place / (kLevelCount * kLevelCount)),
            level(place / kLevelCount),
            level(place)};
}

Eigen::Matrix3Xd rectangle(double width, double length)
{
    Eigen::Matrix3Xd corners = Eigen::Matrix3Xd::Constant(3, 4, std::numeric_limits<double>::quiet_NaN());
    corners.row(0) << -width / 2, width / 2, width / 2, -width / 2;
    corners.row(1) << -length / 2, -length / 2, length / 2, length / 2;
    return corners;
}

job::Job job_of(const Cell& cell)
{
    job::Job job;
    job.units.length = units::Units::Length::in;
    job.surface = cell.kind->type;
    job.anomaly = rectangle(cell.width, cell.length);
    job.sampling = rectangle(cell.width + 2 * cell.distance, cell.length + 2 * cell.distance);
    job.probe.accuracy = kAccuracy;
    return job;
}

Eigen::VectorXd true_heights(const Cell& cell, const Eigen::Matrix2Xd& xy)
{
    Eigen::VectorXd z(xy.cols());
    for (Eigen::Index i = 0; i < xy.cols(); ++i) z[i] = cell.kind->height(xy(0, i), xy(1, i), cell.radius);
    return z;
}

fit::FitInput touch(const Cell& cell, std::uint64_t seed)
{
    fit::FitInput input;
    input.job = job_of(cell);
    const sampling::TouchPlan plan = sampling::plan_touches(input.job);
    input.curves = plan.curve;
    input.roles = plan.role;
    input.xyz.resize(3, plan.size());
    input.xyz << plan.xy, true_heights(cell, plan.xy).transpose();
    input.xyz.row(2) +=
        sampling::draw_noise({sampling::TouchNoise::Kind::normal, kAccuracy}, plan.size(), seed).transpose();
    return input;
}

void add_estimated(fit::FitInput& input)
{
    if (input.job.surface != job::SurfaceType::freeform) return;
    const Eigen::Matrix3Xd points = sampling::estimated_points(input.job, input.xyz, input.curves, input.roles);
    const Eigen::Index touches = input.xyz.cols(), count = points.cols();
    input.xyz.conservativeResize(3, touches + count);
    input.roles.conservativeResize(touches + count);
    input.curves.conservativeResize(touches + count);
    input.xyz.rightCols(count) = points;
    input.roles.tail(count).setConstant(static_cast<int>(sampling::Role::estimated));
    input.curves.tail(count).setConstant(-1); // of no line
}

/// ∂z/∂θ of the family that the surface is of; the direction of a swept job's rulings is given.
Eigen::MatrixXd family_gradients(const Cell& cell, const Eigen::Matrix2Xd& xy)
{
    const bool convex = cell.kind->regression != margin::RegressionKind::concave;
    const Eigen::Vector3d centre(0, 0, convex ? -cell.radius : cell.radius);
    if (cell.kind->regression == margin::RegressionKind::saddle) {
        Eigen::MatrixXd quadratic(6, xy.cols());
        quadratic << Eigen::RowVectorXd::Ones(xy.cols()), xy, xy.cwiseAbs2(), xy.row(0).cwiseProduct(xy.row(1));
        return quadratic;
    }
    if (cell.kind->regression != margin::RegressionKind::swept)
        return surface::height_gradients(surface::sphere_from_centre(centre, cell.radius, convex), xy);
    const std::vector<int> all_but_turn = {0, 1, 2, 4};
    return surface::height_gradients(surface::cylinder_from_axis(centre, Eigen::Vector3d::UnitX(), cell.radius, convex),
                                     xy)(all_but_turn, Eigen::all);
}

/// The operator has touched the corners of the sampling boundary, too (Wang 2007, 4.4.4, step 1 of the free-form
/// surfaces). Griddata alone uses them.
void touch_sampling_boundary(const Cell& cell, std::uint64_t seed, job::Job& job)
{
    const Eigen::Index count = job.sampling.cols();
    job.sampling.row(2) = (true_heights(cell, job.sampling.topRows<2>()) +
                           sampling::draw_noise({sampling::TouchNoise::Kind::normal, kAccuracy}, count, seed))
                              .transpose();
}

/// What statistics allow: the median error band of the least squares fit of the true family (Cramér and Rao), mm.
double limit(const Cell& cell, const Eigen::Matrix2Xd& touched, const Eigen::Matrix2Xd& grid, std::uint64_t seed)
{
    // QR: the columns are as different as an offset in mm and a curvature in 1/mm.
    const Eigen::MatrixXd model = family_gradients(cell, touched).transpose();
    const Eigen::MatrixXd influence =
        family_gradients(cell, grid).transpose() *
        model.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(model.rows(), model.rows()));
    const Eigen::VectorXd noise =
        sampling::draw_noise({sampling::TouchNoise::Kind::normal, kAccuracy}, kLimitDraws * touched.cols(), seed);
    std::vector<double> bands;
    for (int draw = 0; draw < kLimitDraws; ++draw)
        bands.push_back(margin::error_band(influence * noise.segment(draw * touched.cols(), touched.cols())));
    std::nth_element(bands.begin(), bands.begin() + kLimitDraws / 2, bands.end());
    return bands[kLimitDraws / 2];
}

/// Band and shift by one method over the part of the anomaly where it has a surface, in, and the share of that part;
/// nothing where it has none at all.
std::optional<Eigen::Vector3d> errors_of(const fit::FitInput& input, const std::string& method,
                                         const Eigen::Matrix2Xd& grid, const Eigen::VectorXd& truth)
{
    try {
        const fit::Fit fit = fit::fit_surface(input, method);
        if (!fit.converged) return std::nullopt;
        const Eigen::VectorXd errors = surface::heights(fit.surface, grid) - truth;
        std::vector<double> defined;
        std::copy_if(errors.begin(), errors.end(), std::back_inserter(defined),
                     [](double e) { return !std::isnan(e); });
        if (defined.empty()) return std::nullopt;
        const Eigen::Map<const Eigen::VectorXd> known(defined.data(), std::ssize(defined));
        return Eigen::Vector3d(margin::error_band(known) / kInch, margin::shift_distance(known) / kInch,
                               static_cast<double>(known.size()) / static_cast<double>(errors.size()));
    } catch (const core::InputError&) { // the touches do not determine such a surface: an answer, too
        return std::nullopt;
    }
}

json::Value run(const Cell& cell, const std::vector<std::string>& methods, std::uint64_t seed)
{
    fit::FitInput input = touch(cell, seed);
    const Eigen::Matrix3Xd touches = input.xyz;
    const Eigen::Matrix2Xd grid = margin::anomaly_grid(input.job, kAcross);
    const Eigen::VectorXd truth = true_heights(cell, grid);
    add_estimated(input);
    touch_sampling_boundary(cell, seed + kCornerSeeds, input.job);
    json::Value errors;
    for (const std::string& method : methods)
        if (const auto found = errors_of(input, method, grid, truth)) errors.set(method, Eigen::VectorXd(*found));
    json::Value result;
    result.set("cell", cell.number)
        .set("surface", cell.kind->name)
        .set("radius", cell.radius / kInch)
        .set("width", cell.width / kInch)
        .set("length", cell.length / kInch)
        .set("distance", cell.distance / kInch)
        .set("touches", static_cast<int>(touches.cols()))
        .set("terms", margin::regression_values(cell.kind->regression, touches, input.job))
        .set("limit", limit(cell, touches.topRows<2>(), grid, seed) / kInch)
        .set("errors", errors);
    return result;
}

std::vector<std::string> names_of_kinds()
{
    std::vector<std::string> names;
    for (const Kind& kind : kinds()) names.push_back(kind.name);
    return names;
}

std::string words(const std::vector<std::string>& names)
{
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
    return text;
}

std::vector<std::string> radii()
{
    std::vector<std::string> names;
    for (int radius = kMinRadius; radius <= kMaxRadius; radius += kRadiusStep) names.push_back(std::to_string(radius));
    return names;
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "One batch of Wang's factorial experiment: one surface of one radius.", [](cli::Tool& t) {
            const std::string& surface = t.positional_choice("SURFACE", names_of_kinds(), "Kind of surface");
            const std::string& radius = t.positional_choice("RADIUS", radii(), "Its radius of curvature, in");
            const int& every = t.count("--every", 1, "Take every Nth cell only, from the batch's first", 1, kBatch);
            std::vector<std::string> methods = {"auto"};
            methods.insert(methods.end(), fit::fit_methods().begin(), fit::fit_methods().end());
            std::vector<std::string> choices = methods;
            choices.insert(choices.begin(), "all");
            const std::string& method = t.choice("--method", "all", choices, "Of fit");
            t.example("factorial saddle 125 --every 25", "five cells of the saddles of 125 in");
            t.reference("Wang 2007, 4.5; eq. 4-1 (band), 4-6 (shift)");
            t.parse();

            const auto& names = kinds();
            const auto kind =
                std::find_if(names.begin(), names.end(), [&](const Kind& k) { return k.name == surface; });
            if (method != "all") methods = {method};
            const std::uint64_t first_seed = t.seed() * kBatch * kRadiusCount * names.size();
            std::vector<json::Value> cells;
            for (int place = 0; place < kBatch; place += every) {
                const Cell cell = cell_at(static_cast<int>(kind - names.begin()), std::stoi(radius), place);
                cells.push_back(run(cell, methods, first_seed + static_cast<std::uint64_t>(cell.number)));
            }
            t.output() << json::Value()
                              .set("kind", "factorial")
                              .set("units", json::Value().set("length", "in"))
                              .set("methods", words(methods))
                              .set("cells", cells);
            return cli::Verdict::yes;
        });
}
