#pragma once

// The cells of the studies of auto and of its touches: surfaces of many kinds, sizes of anomalies and distances drawn
// from the design of Wang's factorial experiment (2007, 4.5), his layout of touches, their noise. Inches, as in the
// paper.

#include "fit/fit.h"
#include "sampling/estimate.h"

#include <Eigen/Core>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <random>
#include <string>
#include <utility>

namespace cells {

using namespace fettle;

constexpr double kInch = 25.4;

/// Heights in inches over inches.
using Truth = std::function<double(double, double)>;

struct Cell {
    double R;    ///< radius
    double side; ///< 1 or -1: upside down
    double a, b; ///< sides of the anomaly
    double d;    ///< from there to the farthest touches
};

inline Cell draw_cell(int number, std::mt19937_64& random)
{
    const double sides[] = {1, 3.25, 5.5, 7.75, 10};
    Cell cell;
    cell.R = 25 + 10.0 * static_cast<double>((static_cast<std::uint64_t>(number) * 8 + random() % 8) % 21);
    cell.a = sides[random() % 5];
    cell.b = sides[random() % 5];
    cell.d = sides[random() % 5];
    cell.side = number % 2 == 1 ? 1 : -1;
    return cell;
}

inline Truth turned(Truth truth)
{
    return [truth](double x, double y) {
        const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
        return truth(c * x + s * y, -s * x + c * y);
    };
}

/// The truth of a kind, and a family that contains it (or one that the touches cannot distinguish from it).
inline std::pair<Truth, std::string> truth_of(const std::string& kind, const Cell& cell)
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
    std::cerr << "no such kind of surface: " << kind << "\n";
    std::exit(2);
}

inline Eigen::VectorXd middles(int n, double side)
{
    Eigen::VectorXd t(n);
    for (int k = 0; k < n; ++k) t[k] = ((k + 0.5) / n - 0.5) * side;
    return t;
}

/// Wang's layout (eq. 4-5), inches.
inline Eigen::Matrix2Xd layout(double a, double b, double d, Eigen::VectorXi& curves)
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

inline Eigen::Matrix2Xd inside(double a, double b, int n)
{
    Eigen::Matrix2Xd xy(2, n * n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            xy.col(j * n + i) << (static_cast<double>(i) / (n - 1) - 0.5) * a,
                (static_cast<double>(j) / (n - 1) - 0.5) * b;
    return xy * (1 - 1e-9);
}

inline job::Job job_of(const Cell& cell)
{
    job::Job job;
    job.units.length = units::Units::Length::in;
    job.probe.accuracy = 0.005 * kInch;
    job.anomaly.resize(3, 4);
    const double x = cell.a / 2 * kInch, y = cell.b / 2 * kInch;
    job.anomaly << -x, x, x, -x, -y, -y, y, y, 0, 0, 0, 0;
    job.sampling = job.anomaly;
    job.sampling.row(0) *= (cell.a / 2 + cell.d) * kInch / x;
    job.sampling.row(1) *= (cell.b / 2 + cell.d) * kInch / y;
    return job;
}

/// The points that griddata needs beneath the anomaly.
inline void add_estimated(fit::FitInput& input)
{
    const Eigen::Matrix3Xd more = sampling::estimated_points(input.job, input.xyz, input.curves, input.roles);
    const Eigen::Index n = input.xyz.cols(), all = n + more.cols();
    input.xyz.conservativeResize(3, all);
    input.xyz.rightCols(more.cols()) = more;
    input.roles.conservativeResize(all);
    input.roles.tail(more.cols()).setConstant(3);
    input.curves.conservativeResize(all);
    input.curves.tail(more.cols()).setConstant(-1);
}

/// Heights of a truth over xy (2xN, inches), mm.
inline Eigen::VectorXd heights_of(const Truth& truth, const Eigen::Matrix2Xd& xy)
{
    Eigen::VectorXd z(xy.cols());
    for (Eigen::Index i = 0; i < xy.cols(); ++i) z[i] = truth(xy(0, i), xy(1, i)) * kInch;
    return z;
}

/// Wang's touches of a truth, without noise.
inline fit::FitInput wang_touches(const Cell& cell, const Truth& truth)
{
    fit::FitInput input;
    input.job = job_of(cell);
    const Eigen::Matrix2Xd xy = layout(cell.a, cell.b, cell.d, input.curves);
    input.xyz.resize(3, xy.cols());
    input.xyz << xy * kInch, heights_of(truth, xy).transpose();
    input.roles = Eigen::VectorXi::Ones(xy.cols());
    return input;
}

} // namespace cells
