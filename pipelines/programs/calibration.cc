// How near a fit comes to what statistics allow, and how honest its sigma and margin are: one kind of surface, many
// cells of the design of Wang's factorial experiment (2007, 4.5) with his layout of touches.
//
//     calibration KIND CELLS SEED METHOD...       a line a cell and method, CSV
//
// Inches, as in the paper. Methods are fettle-fit's; "gp": a Gaussian process on a quadratic, its hyperparameters
// by restricted likelihood, what a statistician would take; "auto+scan": auto, and its margin told a scan around the
// anomaly, as by fettle-margin --scan.
#include "cells.h"

#include "core/cholesky.h"
#include "fit/family.h"
#include "fit/fit.h"
#include "margin/error_band.h"
#include "margin/scan_waves.h"
#include "margin/shift.h"
#include "mesh/mesh.h"
#include "sampling/scan.h"
#include "surface/surface.h"

#include <cmath>
#include <iostream>
#include <random>

using namespace fettle;
using namespace cells;

namespace {

Eigen::MatrixXd quadratic_basis(const Eigen::Matrix2Xd& xy, double scale)
{
    const Eigen::ArrayXd u = xy.row(0).transpose() / scale, v = xy.row(1).transpose() / scale;
    Eigen::MatrixXd H(xy.cols(), 6);
    H << Eigen::VectorXd::Ones(xy.cols()), u, v, u * u, u * v, v * v;
    return H;
}

/// Squared-exponential process on a free quadratic, the best of a grid of amplitudes and lengths.
Eigen::VectorXd gaussian_process(const fit::FitInput& input, const Eigen::Matrix2Xd& grid, double sigma)
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
            const core::Cholesky c(C);
            const Eigen::MatrixXd CH = c.solve(H);
            const core::Cholesky f(H.transpose() * CH);
            const Eigen::VectorXd beta = f.solve(CH.transpose() * z);
            const Eigen::VectorXd alpha = c.solve(z - H * beta);
            const double score =
                2 * c.L().diagonal().array().log().sum() + 2 * f.L().diagonal().array().log().sum() + z.dot(alpha);
            if (!(score < best)) continue;
            best = score;
            result = Hg * beta + k(grid, xy) * alpha;
        }
    return result;
}

/// Median band of the best unbiased estimate: draws from the covariance of the truth's family.
double limit(const std::string& family, const fit::FitInput& exact, const Eigen::Matrix2Xd& grid,
             std::mt19937_64& random)
{
    surface::Surface surface = fit::begin_surface(exact, family, fit::kSampleRoles, 3);
    const fit::TouchSet touched = fit::make_touch_set(surface, exact.job);
    const std::optional<fit::FitCandidate> known = fit::fit_family(family, touched, fit::all_touches(touched));
    if (!known) return std::numeric_limits<double>::quiet_NaN();
    const Eigen::MatrixXd root = core::Cholesky(known->covariance).L();
    const Eigen::MatrixXd G = surface::height_gradients(known->shape, grid).transpose() * root;
    std::normal_distribution<double> normal;
    std::vector<double> bands;
    for (int draw = 0; draw < 200; ++draw) {
        Eigen::VectorXd unit(root.cols());
        for (double& u : unit) u = normal(random);
        bands.push_back(margin::error_band(G * unit));
    }
    std::nth_element(bands.begin(), bands.begin() + 100, bands.end());
    return bands[100];
}

/// Heights around the anomaly by a mesh of the truth with independent errors of a scanner.
Eigen::Matrix3Xd scan_around(const job::Job& job, const Cell& cell, const Truth& truth, double sigma,
                             std::mt19937_64& random)
{
    constexpr int kAlong = 81; // vertices along a side: a few for each of the places that the margin takes
    mesh::Mesh scan;
    const Eigen::Matrix2Xd xy = inside(cell.a + 2 * cell.d, cell.b + 2 * cell.d, kAlong);
    scan.vertices.resize(3, xy.cols());
    scan.vertices << xy * kInch, heights_of(truth, xy).transpose();
    std::normal_distribution<double> noise(0, sigma);
    for (double& z : scan.vertices.row(2)) z += noise(random);
    scan.triangles.resize(3, 2 * (kAlong - 1) * (kAlong - 1));
    for (int j = 0, k = 0; j + 1 < kAlong; ++j)
        for (int i = 0; i + 1 < kAlong; ++i, k += 2) {
            const int corner = j * kAlong + i;
            scan.triangles.col(k) << corner, corner + 1, corner + kAlong + 1;
            scan.triangles.col(k + 1) << corner, corner + kAlong + 1, corner + kAlong;
        }
    return margin::heights_around_anomaly(sampling::Scan(std::move(scan)), job, "scan");
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 5) {
        std::cerr << "usage: calibration KIND CELLS SEED METHOD...\n";
        return 2;
    }
    const std::string kind = argv[1];
    const int count = std::atoi(argv[2]);
    const std::uint64_t seed = std::strtoull(argv[3], nullptr, 10);
    std::cout << "kind,cell,touches,R,a,b,d,method,chosen,weight,band,limit,below,predicted,covered,z2,"
                 "without_waves\n";
    for (int number = 0; number < count; ++number) {
        std::mt19937_64 random(seed * 1000003 + static_cast<std::uint64_t>(number));
        const Cell cell = draw_cell(number, random);
        const auto [truth, family] = truth_of(kind, cell);
        fit::FitInput input = wang_touches(cell, truth);
        const Eigen::Matrix2Xd grid = inside(cell.a, cell.b, 31);
        const Eigen::VectorXd exact = heights_of(truth, grid);
        const double best =
            family.empty() ? std::numeric_limits<double>::quiet_NaN() : limit(family, input, grid * kInch, random);
        std::normal_distribution<double> noise(0, fit::touch_sigma(input.job.probe));
        for (Eigen::Index i = 0; i < input.xyz.cols(); ++i) input.xyz(2, i) += noise(random);

        for (int m = 4; m < argc; ++m) {
            const std::string method = argv[m];
            surface::Surface surface;
            Eigen::VectorXd z;
            double shift = NAN, predicted = NAN, covered = NAN, z2 = NAN, without_waves = NAN;
            if (method == "gp") {
                z = gaussian_process(input, grid * kInch, noise.stddev());
            } else {
                const bool is_told_scan = method == "auto+scan";
                fit::FitInput mine = input;
                if (method == "griddata" || method == "bspline-wang") add_estimated(mine);
                surface = fit::fit_surface(mine, is_told_scan ? "auto" : method).surface;
                z = surface::heights(surface, grid * kInch);
                if (surface::has_sigma(surface)) {
                    const Eigen::Matrix3Xd around =
                        is_told_scan ? scan_around(input.job, cell, truth, noise.stddev() / 2, random)
                                     : Eigen::Matrix3Xd();
                    const auto predict = [&](double confidence, margin::Tails tails) {
                        const bool has_waves = tails == margin::Tails::student;
                        return margin::predict_by_posterior(surface, input.job, confidence, 1, "surface", tails,
                                                            has_waves ? around : Eigen::Matrix3Xd());
                    };
                    shift = predict(0.99, margin::Tails::student).shift;
                    predicted = predict(0.95, margin::Tails::student).band;
                    without_waves = predict(0.95, margin::Tails::normal).band;
                    const Eigen::Index one =
                        static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(grid.cols()));
                    const double error = (z[one] - exact[one]) / surface::sigma(surface, grid.col(one) * kInch);
                    covered = std::abs(error) <= 1.959964;
                    z2 = error * error;
                }
            }
            const Eigen::VectorXd errors = z - exact;
            const double band = margin::error_band(errors);
            std::cout << kind << ',' << number << ',' << input.xyz.cols() << ',' << cell.R << ',' << cell.a << ','
                      << cell.b << ',' << cell.d << ',' << method << ','
                      << (surface.method.empty() ? method : surface.method) << ',' << surface.weight << ','
                      << band / kInch << ',' << best / kInch << ','
                      << (std::isnan(shift) ? NAN : -(errors.minCoeff() + shift) / kInch) << ',' << predicted / kInch
                      << ',' << covered << ',' << z2 << ',' << without_waves / kInch << "\n";
        }
    }
}
