// How near a fit comes to what statistics allow, and how honest its sigma and margin are: one kind of surface, many
// cells of the design of Wang's factorial experiment (2007, 4.5) with his layout of touches.
//
//     calibration KIND CELLS SEED METHOD...       a line a cell and method, CSV
//
// Inches, as in the paper. Methods are fettle-fit's, "gp" (a Gaussian process on a quadratic, its hyperparameters by
// restricted likelihood: what a statistician would take) and "limit": the family of the truth, known beforehand.
#include "fit/family.h"
#include "fit/fit.h"
#include "margin/error_band.h"
#include "margin/shift.h"
#include "sampling/estimate.h"
#include "surface/surface.h"

#include <Eigen/Cholesky>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <random>

using namespace fettle;

namespace {

constexpr double kInch = 25.4;

/// Heights in inches over inches.
using Truth = std::function<double(double, double)>;

struct Kind {
    Truth truth;        ///< of radius R and side s
    std::string family; ///< that holds it; "": none
    double turn = 0;
};

struct Cell {
    double R, side, a, b, d;
};

Truth turned(Truth truth)
{
    return [truth](double x, double y) {
        const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
        return truth(c * x + s * y, -s * x + c * y);
    };
}

/// The truth of a kind, and a family that holds it (or a stand-in that the touches cannot tell from it).
std::pair<Truth, std::string> truth_of(const std::string& kind, const Cell& cell)
{
    const double R = cell.R, s = cell.side;
    const double half = std::max(cell.a, cell.b) / 2 + cell.d; // of the touched square
    const auto round = [](double R2, double r2) { return std::sqrt(R2 - r2); };
    if (kind == "plane") return {[=](double x, double y) { return s * (0.1 * x + 0.05 * y); }, "plane"};
    if (kind == "sphere_convex") return {[=](double x, double y) { return round(R * R, x * x + y * y) - R; }, "sphere"};
    if (kind == "sphere_concave")
        return {[=](double x, double y) { return R - round(R * R, x * x + y * y); }, "sphere"};
    if (kind == "cylinder" || kind == "cylinder_turned") {
        const Truth f = [=](double x, double) { return s * (round(R * R, x * x) - R); };
        return {kind == "cylinder" ? f : turned(f), "cylinder"};
    }
    if (kind == "saddle" || kind == "saddle_turned") {
        const Truth f = [=](double x, double y) { return s * (y * y - x * x) / (2 * R); };
        return {kind == "saddle" ? f : turned(f), "quadratic"};
    }
    if (kind == "cone") // half-angle 30 degrees, its axis level, radius R over the middle
        return {turned([=](double x, double y) {
                    const double r = R + 0.5 * y;
                    return s * (std::sqrt(r * r - x * x) - R);
                }),
                "cone"};
    if (kind == "torus")
        return {turned([=](double x, double y) {
                    return s * (std::sqrt(std::pow(2 * R + std::sqrt(R * R - x * x), 2) - y * y) - 3 * R);
                }),
                "quadratic"}; // a stand-in: its curvatures do not change
    if (kind == "hull")
        return {turned([=](double x, double y) { return s * -(x * x + y * y / 3) / (2 * R) * (1 + x / 40); }), "cubic"};
    if (kind ==
        "bump") // a sphere with a swelling beside the middle, half as wide as the touched square, 5 % of it high
        return {[=](double x, double y) {
                    const double u = x / half - 0.5, v = y / half - 0.3;
                    return round(R * R, x * x + y * y) - R + s * 0.05 * half * std::exp(-2 * (u * u + v * v));
                },
                ""};
    if (kind == "wave") // a cylinder with a wave as long as twice the touched square, 1 % of it high
        return {turned([=](double x, double y) {
                    return s * (round(R * R, x * x) - R) + 0.01 * half * std::sin(M_PI * (x + 0.4 * y) / (2 * half));
                }),
                ""};
    if (kind == "franke1" || kind == "franke3") { // Franke (1979), tests 1 and 3, over the touched square, height by R
        const bool first = kind == "franke1";
        return {[=](double x, double y) {
                    const double u = (x / half + 1) / 2, v = (y / half + 1) / 2;
                    const double p = 9 * u, q = 9 * v;
                    const double f = first ? .75 * std::exp(-((p - 2) * (p - 2) + (q - 2) * (q - 2)) / 4) +
                                                 .75 * std::exp(-(p + 1) * (p + 1) / 49 - (q + 1) / 10) +
                                                 .5 * std::exp(-((p - 7) * (p - 7) + (q - 3) * (q - 3)) / 4) -
                                                 .2 * std::exp(-(p - 4) * (p - 4) - (q - 7) * (q - 7))
                                           : (1.25 + std::cos(5.4 * v)) / (6 * (1 + (3 * u - 1) * (3 * u - 1)));
                    return s * f * half * half / (2 * R);
                },
                ""};
    }
    std::cerr << "calibration: no such kind: " << kind << "\n";
    std::exit(2);
}

Eigen::VectorXd middles(int n, double side)
{
    Eigen::VectorXd t(n);
    for (int k = 0; k < n; ++k) t[k] = ((k + 0.5) / n - 0.5) * side;
    return t;
}

/// Wang's layout (eq. 4-5), inches.
Eigen::Matrix2Xd layout(double a, double b, double d, Eigen::VectorXi& curves)
{
    const int na = static_cast<int>(std::ceil(std::sqrt(0.22 * a * a + a / b) - 1e-9));
    const int nb = static_cast<int>(std::ceil(na * b / a - 1e-9));
    Eigen::Matrix2Xd xy(2, 4 * (na + nb));
    curves.resize(xy.cols());
    for (Eigen::Index k = 0; k < xy.cols(); ++k) curves[k] = static_cast<int>(k / 4);
    int i = 0;
    for (const double x : middles(na, a))
        for (const double y : {-b / 2 - d, -b / 2, b / 2, b / 2 + d}) xy.col(i++) << x, y;
    for (const double y : middles(nb, b))
        for (const double x : {-a / 2 - d, -a / 2, a / 2, a / 2 + d}) xy.col(i++) << x, y;
    return xy;
}

Eigen::Matrix2Xd inside(double a, double b, int n)
{
    Eigen::Matrix2Xd xy(2, n * n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            xy.col(j * n + i) << (static_cast<double>(i) / (n - 1) - 0.5) * a,
                (static_cast<double>(j) / (n - 1) - 0.5) * b;
    return xy * (1 - 1e-9);
}

Job job_of(const Cell& cell)
{
    Job job;
    job.units.length = Units::Length::in;
    job.probe.accuracy = 0.005 * kInch;
    job.anomaly.resize(3, 4);
    const double x = cell.a / 2 * kInch, y = cell.b / 2 * kInch;
    job.anomaly << -x, x, x, -x, -y, -y, y, y, 0, 0, 0, 0;
    job.sampling = job.anomaly;
    job.sampling.row(0) *= (cell.a / 2 + cell.d) * kInch / x;
    job.sampling.row(1) *= (cell.b / 2 + cell.d) * kInch / y;
    return job;
}

Eigen::MatrixXd quadratic_basis(const Eigen::Matrix2Xd& xy, double scale)
{
    const Eigen::ArrayXd u = xy.row(0).transpose() / scale, v = xy.row(1).transpose() / scale;
    Eigen::MatrixXd H(xy.cols(), 6);
    H << Eigen::VectorXd::Ones(xy.cols()), u, v, u * u, u * v, v * v;
    return H;
}

/// Squared-exponential process on a free quadratic, the best of a grid of amplitudes and lengths.
Eigen::VectorXd gaussian_process(const FitInput& input, const Eigen::Matrix2Xd& grid, double sigma)
{
    const Eigen::Matrix2Xd xy = input.xyz.topRows(2);
    const Eigen::VectorXd z = input.xyz.row(2).transpose();
    const double scale = xy.cwiseAbs().maxCoeff();
    const Eigen::MatrixXd H = quadratic_basis(xy, scale), Hg = quadratic_basis(grid, scale);
    double best = std::numeric_limits<double>::infinity();
    Eigen::VectorXd result;
    for (double length = 0.2; length < 4.1; length *= 1.35)
        for (double ratio = 0.05; ratio < 2e5; ratio *= 3) {
            const double t2 = std::pow(ratio * sigma, 2), l2 = 2 * std::pow(length * scale, 2);
            const auto k = [&](const Eigen::Matrix2Xd& p, const Eigen::Matrix2Xd& q) {
                Eigen::MatrixXd K(p.cols(), q.cols());
                for (Eigen::Index j = 0; j < q.cols(); ++j)
                    K.col(j) = (-(p.colwise() - q.col(j)).colwise().squaredNorm().array() / l2).exp() * t2;
                return K;
            };
            Eigen::MatrixXd C = k(xy, xy);
            C.diagonal().array() += sigma * sigma;
            const Eigen::LLT<Eigen::MatrixXd> c(C);
            const Eigen::MatrixXd CH = c.solve(H);
            const Eigen::LLT<Eigen::MatrixXd> f(H.transpose() * CH);
            const Eigen::VectorXd beta = f.solve(CH.transpose() * z);
            const Eigen::VectorXd alpha = c.solve(z - H * beta);
            const double score = 2 * Eigen::MatrixXd(c.matrixL()).diagonal().array().log().sum() +
                                 2 * Eigen::MatrixXd(f.matrixL()).diagonal().array().log().sum() + z.dot(alpha);
            if (!(score < best)) continue;
            best = score;
            result = Hg * beta + k(grid, xy) * alpha;
        }
    return result;
}

void add_estimated(FitInput& input)
{
    const Eigen::Matrix3Xd more = estimated_points(input.job, input.xyz, input.curves, input.roles);
    const Eigen::Index n = input.xyz.cols(), all = n + more.cols();
    input.xyz.conservativeResize(3, all);
    input.xyz.rightCols(more.cols()) = more;
    input.roles.conservativeResize(all);
    input.roles.tail(more.cols()).setConstant(3);
    input.curves.conservativeResize(all);
    input.curves.tail(more.cols()).setConstant(-1);
}

/// Median band of the best unbiased estimate: draws from the covariance of the truth's family.
double limit(const std::string& family, const FitInput& exact, const Eigen::Matrix2Xd& grid, std::mt19937_64& random)
{
    Surface surface = begin_surface(exact, family, kSampleRoles, 3);
    const Touched touched = touched_of(surface, exact.job);
    const std::optional<Candidate> known = fit_family(family, touched, all_touches(touched));
    if (!known) return std::numeric_limits<double>::quiet_NaN();
    const Eigen::MatrixXd root = Eigen::LLT<Eigen::MatrixXd>(known->covariance).matrixL();
    const Eigen::MatrixXd G = height_gradients(known->shape, grid).transpose() * root;
    std::normal_distribution<double> normal;
    std::vector<double> bands;
    for (int draw = 0; draw < 200; ++draw) {
        Eigen::VectorXd unit(root.cols());
        for (double& u : unit) u = normal(random);
        bands.push_back(error_band(G * unit));
    }
    std::nth_element(bands.begin(), bands.begin() + 100, bands.end());
    return bands[100];
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 5) {
        std::cerr << "usage: calibration KIND CELLS SEED METHOD...\n";
        return 2;
    }
    const std::string kind = argv[1];
    const int cells = std::atoi(argv[2]);
    const std::uint64_t seed = std::strtoull(argv[3], nullptr, 10);
    const double sides[] = {1, 3.25, 5.5, 7.75, 10};
    std::cout << "kind,cell,touches,R,a,b,d,method,chosen,weight,band,limit,below,predicted,covered,z2\n";
    for (int number = 0; number < cells; ++number) {
        std::mt19937_64 random(seed * 1000003 + static_cast<std::uint64_t>(number));
        Cell cell;
        cell.R = 25 + 10.0 * static_cast<double>((static_cast<std::uint64_t>(number) * 8 + random() % 8) % 21);
        cell.a = sides[random() % 5];
        cell.b = sides[random() % 5];
        cell.d = sides[random() % 5];
        cell.side = number % 2 == 1 ? 1 : -1;
        const auto [truth, family] = truth_of(kind, cell);
        const auto heights_of = [&](const Eigen::Matrix2Xd& xy) {
            Eigen::VectorXd z(xy.cols());
            for (Eigen::Index i = 0; i < xy.cols(); ++i) z[i] = truth(xy(0, i), xy(1, i)) * kInch;
            return z;
        };
        FitInput input;
        input.job = job_of(cell);
        const Eigen::Matrix2Xd xy = layout(cell.a, cell.b, cell.d, input.curves);
        input.xyz.resize(3, xy.cols());
        input.xyz << xy * kInch, heights_of(xy).transpose();
        input.roles = Eigen::VectorXi::Ones(xy.cols());
        const Eigen::Matrix2Xd grid = inside(cell.a, cell.b, 31);
        const Eigen::VectorXd exact = heights_of(grid);
        const double best =
            family.empty() ? std::numeric_limits<double>::quiet_NaN() : limit(family, input, grid * kInch, random);
        std::normal_distribution<double> noise(0, touch_sigma(input.job.probe));
        for (Eigen::Index i = 0; i < xy.cols(); ++i) input.xyz(2, i) += noise(random);

        for (int m = 4; m < argc; ++m) {
            const std::string method = argv[m];
            Surface surface;
            Eigen::VectorXd z;
            if (method == "limit" && family.empty()) continue;
            double shift = NAN, predicted = NAN, covered = NAN, z2 = NAN;
            if (method == "gp") {
                z = gaussian_process(input, grid * kInch, noise.stddev());
            } else {
                FitInput mine = input;
                if (method == "griddata" || method == "bspline-wang") add_estimated(mine);
                surface = fit_surface(mine, method == "limit" ? family : method).surface;
                z = heights(surface, grid * kInch);
                if (surface.covariance.size() > 0) {
                    const Prediction foreseen = predict_by_posterior(surface, input.job, 0.99, 1);
                    shift = foreseen.shift;
                    predicted = predict_by_posterior(surface, input.job, 0.95, 1).band;
                    const Eigen::Index one =
                        static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(grid.cols()));
                    const double error = (z[one] - exact[one]) / sigma(surface, grid.col(one) * kInch);
                    covered = std::abs(error) <= 1.959964;
                    z2 = error * error;
                }
            }
            const Eigen::VectorXd errors = z - exact;
            const double band = error_band(errors);
            std::cout << kind << ',' << number << ',' << xy.cols() << ',' << cell.R << ',' << cell.a << ',' << cell.b
                      << ',' << cell.d << ',' << method << ',' << (surface.method.empty() ? method : surface.method)
                      << ',' << surface.weight << ',' << band / kInch << ',' << best / kInch << ','
                      << (std::isnan(shift) ? NAN : -(errors.minCoeff() + shift) / kInch) << ',' << predicted / kInch
                      << ',' << covered << ',' << z2 << "\n";
        }
    }
}
