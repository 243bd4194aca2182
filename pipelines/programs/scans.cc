// How honest the margin is on real surfaces: cells cut from a scan where it is smooth, each at its own place and turn
// and of its own size, touched as fettle-sample does, fitted by `auto`, and compared with the scan inside B, which the
// fit has not seen.
//
//     scans FILE UNIT MIN MAX CELLS SEED STRATEGIES [ACCURACY...]       a line a cell and strategy, CSV
//
// MIN and MAX bound the sides of B in mm; STRATEGIES: some of "wang extended wang+scan extended+scan", with the margin
// told the scan of the metal around B or not; ACCURACY is that of the probe, mm: 99 % of the touches lie within it. The
// part's skin and the scanner's noise come on top of it in every touch: the job's accuracy allows for their usual size,
// that of cells which are not judged.
#include "scan-cells.h"

#include "fit/fit.h"
#include "gantry/touch_job.h"
#include "margin/error_band.h"
#include "margin/scan_waves.h"
#include "margin/shift.h"
#include "mesh/shape_file.h"
#include "sampling/noise.h"
#include "sampling/probe.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace fettle;
using namespace scan_cells;

namespace {

constexpr double kTolerance = 0.8; // of the job over the probe's accuracy, as in samples/jobs/hammer.json

/// @param accuracy  of the probe, mm   @param skin  standard deviation of what comes on top of it in a touch, mm
job::Job job_of(const Cell& cell, double accuracy, double skin)
{
    job::Job job;
    job.probe.accuracy = accuracy;
    job.probe.accuracy *= std::hypot(1, skin / fit::touch_sigma(job.probe));
    job.tolerance = kTolerance * accuracy;
    job.anomaly.resize(3, 4);
    const double x = cell.a / 2, y = cell.b / 2;
    job.anomaly << -x, x, x, -x, -y, -y, y, y, 0, 0, 0, 0;
    job.sampling = job.anomaly;
    job.sampling.row(0) *= (x + cell.d) / x;
    job.sampling.row(1) *= (y + cell.d) / y;
    job.is_safe_height_known = false;
    return job;
}

/// The scan's heights at the places inside B and `around` steps beyond it.
Eigen::MatrixXd heights(const Cell& cell, int around)
{
    const int n = kInside + 2 * around;
    Eigen::MatrixXd z(n, n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) z(i, j) = cell.on->height(place(cell, i - around, j - around)).value_or(NAN);
    return z;
}

/// The scan without its skin inside B: products of Legendre polynomials up to the eighth degree, fitted to B and a
/// sixth of its sides around it, so that they follow waves of a sixth of B and longer.
Eigen::VectorXd smooth_heights(const Cell& cell)
{
    constexpr int kDegree = 8;
    constexpr int kPlaces = kInside + 2 * kAround;
    Eigen::MatrixXd P(kPlaces, kDegree + 1);
    for (int i = 0; i < kPlaces; ++i)
        for (int k = 0; k <= kDegree; ++k)
            P(i, k) = std::legendre(static_cast<unsigned>(k), 2.0 * i / (kPlaces - 1) - 1);
    const Eigen::MatrixXd Q = core::householder_qr(P, kDegree + 1).Q;
    const Eigen::MatrixXd inside = Q.middleRows(kAround, kInside);
    return (inside * (Q.transpose() * heights(cell, kAround) * Q) * inside.transpose()).reshaped();
}

/// Root mean square of what the smooth surface leaves out.
double skin_of(const Cell& cell)
{
    return std::sqrt((heights(cell, 0).reshaped() - smooth_heights(cell)).array().square().mean());
}

/// @param around  heights of the scan that the margin is told; none: it goes by the touches alone
void compare(const Cell& cell, int number, double accuracy, double usual_skin, const std::string& name,
             const gantry::JobTouches& touched, const job::Job& job, const Eigen::Matrix3Xd& around, std::ostream& out)
{
    fit::FitInput input;
    input.job = job;
    input.xyz = touched.touches;
    input.roles = touched.plan.role;
    const surface::Surface surface = fit::fit_surface(input, "auto").surface;
    const auto predict = [&](double confidence) {
        return margin::predict_by_posterior(surface, job, confidence, 1, "surface", margin::Tails::student, around);
    };
    Eigen::Matrix2Xd xy(2, kInside * kInside);
    for (int j = 0, k = 0; j < kInside; ++j)
        for (int i = 0; i < kInside; ++i, ++k) xy.col(k) = place(cell, i, j);
    const Eigen::VectorXd truth = heights(cell, 0).reshaped();
    const Eigen::VectorXd error = surface::heights(surface, xy) - truth, sigma = surface::sigmas(surface, xy);
    const double covered = (error.array().abs() <= 1.959964 * sigma.array()).cast<double>().mean();
    // What a wheel rests on: without the skin, which is finer than a sixth of B.
    const Eigen::VectorXd smooth_error = error + truth - smooth_heights(cell);
    const auto percentile = [](Eigen::VectorXd values, double share) {
        std::sort(values.begin(), values.end());
        return values[static_cast<Eigen::Index>(share * (values.size() - 1))];
    };
    const surface::Prediction at90 = predict(0.9), at99 = predict(0.99);
    const double points = ((error.array() + at99.shift) < 0).cast<double>().mean();
    out << number << ',' << name << ',' << touched.plan.size() << ',' << accuracy << ',' << cell.a << ',' << cell.b
        << ',' << cell.d << ',' << surface.method << ',' << surface.weight << ',' << surface.goodness << ','
        << margin::error_band(error) << ',' << at90.shift << ',' << at99.shift << ','
        << -(error.minCoeff() + at90.shift) << ',' << -(error.minCoeff() + at99.shift) << ',' << predict(0.95).band
        << ',' << covered << ',' << points << ',' << -(percentile(error, 0.01) + at99.shift) << ','
        << -(smooth_error.minCoeff() + at99.shift) << ',' << -(smooth_error.minCoeff() + at90.shift) << ','
        << std::sqrt((smooth_error - error).squaredNorm() / error.size()) << ',' << usual_skin << "\n";
}

/// The generator of a cell's numbers, so that a cell is the same in every batch.
std::mt19937_64 numbers_of(std::uint64_t seed, int number)
{
    return std::mt19937_64(seed * 1000003 + static_cast<std::uint64_t>(number));
}

template <typename Shape>
Cell cut(const Shape& all, const std::vector<double>& sides, std::mt19937_64& random)
{
    constexpr int kMaxTries = 20000; // one in hundreds succeeds where a scan is resolved in few places
    for (int tried = 0; tried < kMaxTries; ++tried)
        if (std::optional<Cell> cell = try_cell(all, sides[0], sides[1], random)) return std::move(*cell);
    std::cerr << "no face of this size\n";
    std::exit(1);
}

/// The usual skin of a part: the median over cells that are not judged, their numbers beyond those of any batch.
template <typename Shape>
double usual_skin(const Shape& all, const std::vector<double>& sides, std::uint64_t seed)
{
    constexpr int kCells = 9, kFirst = 500000;
    std::vector<double> skins;
    for (int k = 0; k < kCells; ++k) {
        std::mt19937_64 random = numbers_of(seed, kFirst + k);
        skins.push_back(skin_of(cut(all, sides, random)));
    }
    std::nth_element(skins.begin(), skins.begin() + kCells / 2, skins.end());
    return skins[kCells / 2];
}

template <typename Shape>
void run(const Shape& all, const std::vector<double>& sides, int cells, std::uint64_t seed,
         const std::set<std::string>& strategies, const std::vector<double>& accuracies)
{
    const double skin = usual_skin(all, sides, seed);
    for (int number = 0; number < cells; ++number) {
        std::mt19937_64 random = numbers_of(seed, number);
        const Cell cell = cut(all, sides, random);
        const double accuracy = accuracies[random() % accuracies.size()];
        const job::Job job = job_of(cell, accuracy, skin);
        const std::uint64_t noise = random();
        gantry::TouchedPart part;
        part.name = "scan";
        part.touch = [&](const sampling::TouchPlan& plan) {
            return sampling::probe(*cell.on, job, plan, {sampling::TouchNoise::Kind::normal, accuracy}, noise);
        };
        for (const auto& [name, strategy] :
             {std::pair{"wang", gantry::TouchStrategy::wang}, std::pair{"extended", gantry::TouchStrategy::extended}}) {
            const std::string with_scan = std::string(name) + "+scan";
            if (!strategies.contains(name) && !strategies.contains(with_scan)) continue;
            gantry::TouchRequest request;
            request.strategy = strategy;
            const gantry::JobTouches touched = touch_job(job, &part, request);
            if (strategies.contains(name)) compare(cell, number, accuracy, skin, name, touched, job, {}, std::cout);
            if (strategies.contains(with_scan))
                compare(cell, number, accuracy, skin, with_scan, touched, job,
                        margin::heights_around_anomaly(*cell.on, job, "scan"), std::cout);
        }
    }
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 8) {
        std::cerr << "usage: scans FILE UNIT MIN MAX CELLS SEED STRATEGIES [ACCURACY...]\n";
        return 2;
    }
    std::vector<double> accuracies;
    for (int i = 8; i < argc; ++i) accuracies.push_back(std::atof(argv[i]));
    if (accuracies.empty()) accuracies = {0.127};
    units::Units units;
    units.length = units::parse_length_unit(argv[2]);
    const mesh::ShapeFile file = mesh::read_shape(argv[1], units);
    const std::vector<double> sides = {std::atof(argv[3]), std::atof(argv[4])};
    std::istringstream words(argv[7]);
    const std::set<std::string> strategies{std::istream_iterator<std::string>(words), {}};
    std::cout
        << "cell,strategy,touches,accuracy,a,b,d,method,weight,goodness,band,shift90,shift99,below90,below99,predicted,"
           "covered,points,p99,smooth99,smooth90,skin,usual_skin\n";
    std::visit(
        [&](const auto& all) {
            run(all, sides, std::atoi(argv[5]), std::strtoull(argv[6], nullptr, 10), strategies, accuracies);
        },
        file.shape);
}
