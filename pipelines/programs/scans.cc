// How honest the margin is on real surfaces: cells cut from a scan where it is smooth, each at its own place and turn
// and of its own size, touched as fettle-sample does, fitted by `auto`, and compared with the scan inside B, which the
// fit has not seen.
//
//     scans FILE UNIT MIN MAX CELLS SEED [ACCURACY...]       a line a cell and strategy, CSV
//
// MIN and MAX bound the sides of B in mm; ACCURACY is that of the probe, mm: 99 % of the touches lie within it.
#include "core/decompositions.h"
#include "core/direction.h"
#include "fit/fit.h"
#include "gantry/touch_job.h"
#include "margin/error_band.h"
#include "margin/shift.h"
#include "mesh/shape_file.h"
#include "sampling/noise.h"
#include "sampling/probe.h"
#include "sampling/scan.h"
#include "surface/surface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

using namespace fettle;

namespace {

// A cell lies on one face of the part, as an operator would choose it: nowhere within S does it lean more than 30° from
// its mean normal, or turn by more than 17° from one step of the grid to the next.
constexpr int kFaceSteps = 24;
constexpr double kMaxSlope = 0.58;
constexpr double kMaxSlopeChange = 0.3;
constexpr int kInside = 31; // places along each side of B at which fit and scan are compared
// Steps between such places by which the smooth surface goes on beyond B, a sixth of its sides. At the border of what a
// polynomial is fitted to it follows the scanner's noise: there 0.8 of a place's weight is its own, inside 0.2 at most.
constexpr int kAround = 5;
constexpr int kMaxTries = 2000;
constexpr double kTolerance = 0.8; // of the job over the probe's accuracy, as in samples/jobs/hammer.json

struct Cell {
    double a, b;                              ///< sides of B, mm
    double d;                                 ///< from B to S, mm
    double accuracy;                          ///< of the probe, mm
    std::shared_ptr<const sampling::Scan> on; ///< the piece, its middle at the origin, its mean normal upwards
};

double uniform(std::mt19937_64& random, double low, double high)
{
    return low + (high - low) * (static_cast<double>(random() >> 11) / 9007199254740992.0);
}

/// The triangles with a corner within `radius` of a point.
mesh::Mesh crop(const mesh::Mesh& mesh, const Eigen::Vector3d& middle, double radius)
{
    const auto near = (mesh.vertices.colwise() - middle).colwise().norm().array() <= radius;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
        if (near[mesh.triangles(0, t)] || near[mesh.triangles(1, t)] || near[mesh.triangles(2, t)]) kept.push_back(t);
    std::map<int, int> number;
    mesh::Mesh piece;
    piece.triangles = mesh.triangles(Eigen::all, kept);
    std::vector<int> used;
    for (int& corner : piece.triangles.reshaped()) {
        const auto [at, is_new] = number.try_emplace(corner, static_cast<int>(used.size()));
        if (is_new) used.push_back(corner);
        corner = at->second;
    }
    piece.vertices = mesh.vertices(Eigen::all, used);
    return piece;
}

cloud::Cloud crop(const cloud::Cloud& cloud, const Eigen::Vector3d& middle, double radius)
{
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < cloud.size(); ++i)
        if ((cloud.xyz.col(i) - middle).norm() <= radius) kept.push_back(i);
    cloud::Cloud piece;
    piece.xyz = cloud.xyz(Eigen::all, kept);
    return piece;
}

Eigen::Vector3d mean_normal(const mesh::Mesh& mesh)
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const mesh::Triangle corner = mesh::triangle_of(mesh, t);
        const Eigen::Vector3d first = corner.col(1) - corner.col(0), second = corner.col(2) - corner.col(0);
        sum += first.cross(second);
    }
    return sum.normalized();
}

/// Normal of the least-squares plane, upwards: a cloud is seen from above.
Eigen::Vector3d mean_normal(const cloud::Cloud& cloud)
{
    const Eigen::Matrix3Xd about = cloud.xyz.colwise() - cloud.xyz.rowwise().mean().eval();
    const Eigen::Vector3d n = core::symmetric_eigen<3>(about * about.transpose()).vectors.col(0);
    return n.z() < 0 ? Eigen::Vector3d(-n) : n;
}

template <typename Shape>
Eigen::Matrix3Xd& coordinates(Shape& shape)
{
    if constexpr (std::is_same_v<Shape, mesh::Mesh>)
        return shape.vertices;
    else
        return shape.xyz;
}

/// Is the piece one face all over the rectangle of S?
bool is_one_face(const sampling::Scan& scan, double width, double length)
{
    Eigen::MatrixXd z(kFaceSteps + 1, kFaceSteps + 1);
    const double u = width / kFaceSteps, v = length / kFaceSteps;
    for (int j = 0; j <= kFaceSteps; ++j)
        for (int i = 0; i <= kFaceSteps; ++i) {
            const std::optional<double> height = scan.height({i * u - width / 2, j * v - length / 2});
            if (!height) return false;
            z(i, j) = *height;
        }
    const Eigen::MatrixXd along = (z.bottomRows(kFaceSteps) - z.topRows(kFaceSteps)) / u;
    const Eigen::MatrixXd across = (z.rightCols(kFaceSteps) - z.leftCols(kFaceSteps)) / v;
    if (std::max(along.cwiseAbs().maxCoeff(), across.cwiseAbs().maxCoeff()) > kMaxSlope) return false;
    const double change =
        std::max((along.bottomRows(kFaceSteps - 1) - along.topRows(kFaceSteps - 1)).cwiseAbs().maxCoeff(),
                 (across.rightCols(kFaceSteps - 1) - across.leftCols(kFaceSteps - 1)).cwiseAbs().maxCoeff());
    return change <= kMaxSlopeChange;
}

template <typename Shape>
std::optional<Cell> try_cell(const Shape& all, double min, double max, std::mt19937_64& random)
{
    const double a = min * std::pow(max / min, uniform(random, 0, 1));
    const double b = std::clamp(a * std::exp(uniform(random, -0.7, 0.7)), min, max);
    const double d = std::max(a, b) * uniform(random, 0.2, 0.6);
    const Eigen::Vector2d S(a + 2 * d, b + 2 * d);
    const Eigen::Matrix3Xd& points = coordinates(const_cast<Shape&>(all));
    const Eigen::Vector3d middle =
        points.col(static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(points.cols())));
    const double turn = uniform(random, 0, 2 * std::numbers::pi);
    Shape piece = crop(all, middle, 0.6 * S.norm());
    if (coordinates(piece).cols() < 50) return std::nullopt;
    const Eigen::Vector3d normal = mean_normal(piece);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * core::rotation_between(normal, Eigen::Vector3d::UnitZ());
    coordinates(piece) = R * (coordinates(piece).colwise() - middle);
    Cell cell{a, b, d, 0, std::make_shared<sampling::Scan>(std::move(piece))};
    if (!is_one_face(*cell.on, S.x(), S.y())) return std::nullopt;
    return cell;
}

/// A place inside B, or beyond it for a number below 0 or above kInside - 1.
Eigen::Vector2d place(const Cell& cell, int i, int j)
{
    constexpr double kWithin = 1 - 1e-9; // of rounding at the edge of B
    return kWithin * Eigen::Vector2d((i / (kInside - 1.0) - 0.5) * cell.a, (j / (kInside - 1.0) - 0.5) * cell.b);
}

job::Job job_of(const Cell& cell)
{
    job::Job job;
    job.probe.accuracy = cell.accuracy;
    job.tolerance = kTolerance * cell.accuracy;
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

void compare(const Cell& cell, const std::string& name, const gantry::JobTouches& touched, const job::Job& job,
             std::ostream& out)
{
    fit::FitInput input;
    input.job = job;
    input.xyz = touched.touches;
    input.roles = touched.plan.role;
    const surface::Surface surface = fit::fit_surface(input, "auto").surface;
    const auto predict = [&](double confidence) { return margin::predict_by_posterior(surface, job, confidence, 1); };
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
    out << name << ',' << touched.plan.size() << ',' << cell.accuracy << ',' << cell.a << ',' << cell.b << ',' << cell.d
        << ',' << surface.method << ',' << surface.weight << ',' << surface.goodness << ',' << margin::error_band(error)
        << ',' << at90.shift << ',' << at99.shift << ',' << -(error.minCoeff() + at90.shift) << ','
        << -(error.minCoeff() + at99.shift) << ',' << predict(0.95).band << ',' << covered << ',' << points << ','
        << -(percentile(error, 0.01) + at99.shift) << ',' << -(smooth_error.minCoeff() + at99.shift) << ','
        << -(smooth_error.minCoeff() + at90.shift) << ','
        << std::sqrt((smooth_error - error).squaredNorm() / error.size()) << "\n";
}

template <typename Shape>
void run(const Shape& all, const std::vector<double>& numbers, int cells, std::uint64_t seed,
         const std::vector<double>& accuracies)
{
    for (int number = 0; number < cells; ++number) {
        std::mt19937_64 random(seed * 1000003 + static_cast<std::uint64_t>(number));
        std::optional<Cell> cell;
        for (int tried = 0; !cell && tried < kMaxTries; ++tried) cell = try_cell(all, numbers[0], numbers[1], random);
        if (!cell) {
            std::cerr << "no face of this size\n";
            std::exit(1);
        }
        cell->accuracy = accuracies[random() % accuracies.size()];
        const job::Job job = job_of(*cell);
        const std::uint64_t noise = random();
        gantry::TouchedPart part;
        part.name = "scan";
        part.touch = [&](const sampling::TouchPlan& plan) {
            return sampling::probe(*cell->on, job, plan, {sampling::TouchNoise::Kind::normal, cell->accuracy}, noise);
        };
        for (const gantry::TouchStrategy strategy : {gantry::TouchStrategy::wang, gantry::TouchStrategy::extended}) {
            gantry::TouchRequest request;
            request.strategy = strategy;
            std::cout << number << ',';
            compare(*cell, strategy == gantry::TouchStrategy::wang ? "wang" : "extended",
                    touch_job(job, &part, request), job, std::cout);
        }
    }
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 7) {
        std::cerr << "usage: scans FILE UNIT MIN MAX CELLS SEED [ACCURACY...]\n";
        return 2;
    }
    std::vector<double> accuracies;
    for (int i = 7; i < argc; ++i) accuracies.push_back(std::atof(argv[i]));
    if (accuracies.empty()) accuracies = {0.127};
    units::Units units;
    units.length = units::parse_length_unit(argv[2]);
    const mesh::ShapeFile file = mesh::read_shape(argv[1], units);
    const std::vector<double> sides = {std::atof(argv[3]), std::atof(argv[4])};
    std::cout
        << "cell,strategy,touches,accuracy,a,b,d,method,weight,goodness,band,shift90,shift99,below90,below99,predicted,"
           "covered,points,p99,smooth99,smooth90,skin\n";
    std::visit(
        [&](const auto& all) { run(all, sides, std::atoi(argv[5]), std::strtoull(argv[6], nullptr, 10), accuracies); },
        file.shape);
}
