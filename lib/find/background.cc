#include "find/background.h"

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fettle::find {
namespace {

constexpr std::size_t kTerms = 6;                            // of a quadratic
constexpr std::array<int, kTerms> kPowerX{0, 1, 0, 2, 1, 0}; // 1, x, y, x², x y, y²
constexpr std::array<int, kTerms> kPowerY{0, 0, 1, 0, 1, 2};
constexpr int kMaxPower = 4; // of the normal equations

constexpr double kWindowPerWidth = 0.75;  // standard deviation of the window over the width that it passes beneath
constexpr double kWindowReach = 2.6;      // standard deviations: 3 % of the weight lie beyond
constexpr double kCellsPerWidth = 5;      // of the coarse grid: its window then still has 3.75 cells of deviation
constexpr float kUntrustedWeight = 0.01F; // first weight of cells outside of sheets
// Tukey's cutoff in standard deviations, falling from one iteration to the next, so that the first surface, which
// anomalies pull up, excludes none of the good metal.
constexpr std::array<double, 6> kCutoffs{8, 6, 5, 4.5, 4, 4};
// Cells far beneath the surface are cut off later and keep a weight: they are more often the form of the part than
// outliers.
constexpr double kDeepCutoffs = 1.5;
constexpr double kMinDeepWeight = 0.02; // lower bound of their weight
// Ridge on all but the constant term, as a share of the weight in the window: it flattens quadratics that too few
// cells determine.
constexpr double kRidge = 1e-3;

struct Window {
    std::array<cv::Mat1f, kMaxPower + 1> kernel; ///< window times x^k
};

Window make_window(double deviation)
{
    const int radius = static_cast<int>(std::ceil(kWindowReach * deviation));
    Window window;
    for (int k = 0; k <= kMaxPower; ++k) window.kernel[std::size_t(k)].create(1, 2 * radius + 1);
    for (int i = -radius; i <= radius; ++i) {
        const double t = i / deviation;
        for (int k = 0; k <= kMaxPower; ++k)
            window.kernel[std::size_t(k)](0, i + radius) = static_cast<float>(std::exp(-t * t / 2) * std::pow(t, k));
    }
    return window;
}

/// Moments of the images w and w z under the window, by the powers of x and y.
struct Moments {
    std::array<std::array<Image, kMaxPower + 1>, kMaxPower + 1> of_weight;
    std::array<Image, kTerms> of_height;
};

Moments moments(const Image& weight, const Image& z, const Window& window)
{
    const auto filter = [&](const Image& image, int px, int py) {
        Image result;
        cv::sepFilter2D(image, result, CV_32F, window.kernel[std::size_t(px)], window.kernel[std::size_t(py)], {-1, -1},
                        0, cv::BORDER_CONSTANT);
        return result;
    };
    Moments result;
    tbb::parallel_for(0, kMaxPower + 1, [&](int px) {
        for (int py = 0; px + py <= kMaxPower; ++py)
            result.of_weight[std::size_t(px)][std::size_t(py)] = filter(weight, px, py);
    });
    const Image product = weight.mul(z);
    tbb::parallel_for(std::size_t{0}, kTerms,
                      [&](std::size_t k) { result.of_height[k] = filter(product, kPowerX[k], kPowerY[k]); });
    return result;
}

constexpr int kLanes = 8; // cells that are solved together
using Lanes = Eigen::Array<double, kLanes, 1>;

// Lower bound of pivots, which rounding may make 0 or negative in an empty window.
constexpr double kMinPivot = 1e-12;

/// The constant terms of the quadratics at cells in a row, by Cholesky's factors; the constant comes last, which is
/// then the first that back-substitution yields. Eigen's own factorization takes three times as long: it solves one
/// cell at a time.
/// @param count  of cells, up to kLanes
void solve(const Moments& moments, int y, int x, int count, float* constants)
{
    const auto load = [&](const Image& image) {
        Lanes lanes = Lanes::Zero();
        for (int k = 0; k < count; ++k) lanes[k] = image(y, x + k);
        return lanes;
    };
    const auto term = [](std::size_t i) { return (i + 1) % kTerms; };
    const Lanes ridge = kRidge * load(moments.of_weight[0][0]) + 1e-9; // an empty window yields 0
    std::array<std::array<Lanes, kTerms>, kTerms> L;
    std::array<Lanes, kTerms> solution;
    for (std::size_t i = 0; i < kTerms; ++i) {
        solution[i] = load(moments.of_height[term(i)]);
        for (std::size_t j = 0; j <= i; ++j) {
            Lanes sum = load(moments.of_weight[std::size_t(kPowerX[term(i)] + kPowerX[term(j)])]
                                              [std::size_t(kPowerY[term(i)] + kPowerY[term(j)])]);
            if (i == j) sum += (i + 1 == kTerms ? kRidge : 1) * ridge;
            for (std::size_t k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
            L[i][j] = i == j ? Lanes(sum.max(kMinPivot).sqrt()) : Lanes(sum / L[j][j]);
        }
        for (std::size_t k = 0; k < i; ++k) solution[i] -= L[i][k] * solution[k];
        solution[i] /= L[i][i];
    }
    const Lanes result = solution[kTerms - 1] / L[kTerms - 1][kTerms - 1];
    for (int k = 0; k < count; ++k) constants[k] = static_cast<float>(result[k]);
}

/// @param needed  elsewhere the surface is 0
Image solve(const Moments& moments, const Mask& needed)
{
    const cv::Size size = needed.size();
    Image surface(size, 0.F);
    tbb::parallel_for(tbb::blocked_range<int>(0, size.height), [&](const tbb::blocked_range<int>& rows) {
        for (int y = rows.begin(); y < rows.end(); ++y)
            for (int x = 0; x < size.width; x += kLanes) {
                const int count = std::min(kLanes, size.width - x);
                if (std::any_of(needed[y] + x, needed[y] + x + count, [](std::uint8_t cell) { return cell != 0; }))
                    solve(moments, y, x, count, surface[y] + x);
            }
    });
    surface.setTo(0, ~needed);
    return surface;
}

/// Tukey's weight, 1 at 0, 0 beyond the cutoff.
double biweight(double ratio)
{
    const double rest = 1 - ratio * ratio;
    return std::abs(ratio) < 1 ? rest * rest : 0;
}

constexpr std::size_t kSigmaCells = 20000; // from which a spread is known to 1 %

/// Standard deviation of the residuals of cells with a weight.
double residual_sigma(const Image& z, const Image& surface, const Image& weight, const Mask& seen)
{
    std::vector<double> residuals = values_in(z - surface, seen & (weight > 0.1F));
    if (const std::size_t step = residuals.size() / kSigmaCells; step > 1) {
        for (std::size_t i = 0; i < residuals.size() / step; ++i) residuals[i] = residuals[i * step];
        residuals.resize(residuals.size() / step);
    }
    return robust_sd(std::move(residuals));
}

} // namespace

Image regression_filter(const Image& z, const Mask& trusted, double sigma, double width)
{
    const int factor = std::max(1, static_cast<int>(std::lround(width / kCellsPerWidth)));
    Image coarse = coarsened(z, factor);
    const Mask seen = finite(coarse);
    const cv::Scalar mean = cv::mean(coarse, seen);
    coarse -= mean;
    coarse.setTo(0, ~seen);
    Image trust(z.size(), kUntrustedWeight);
    trust.setTo(1, trusted);
    Image full = coarsened(trust, factor);
    full.setTo(0, ~seen);
    const Window window = make_window(kWindowPerWidth * width / factor);
    Image weight = full.clone(), surface;
    const Mask needed =
        dilated(seen, 2); // what is seen is interpolated between cells up to one off, across corners, too
    for (const double cutoff : kCutoffs) {
        surface = solve(moments(weight, coarse, window), needed);
        const double limit =
            cutoff * std::max(sigma / std::sqrt(factor), residual_sigma(coarse, surface, weight, seen));
        for (int y = 0; y < coarse.rows; ++y)
            for (int x = 0; x < coarse.cols; ++x) {
                const double residual = coarse(y, x) - surface(y, x);
                weight(y, x) = full(y, x) *
                               static_cast<float>(residual > 0 ? biweight(residual / limit)
                                                               : std::max(kMinDeepWeight,
                                                                          biweight(residual / (kDeepCutoffs * limit))));
            }
    }
    surface += mean;
    return refined(surface, factor, z.size());
}

namespace {

constexpr double kBallCellsPerWidth = 16;
constexpr double kCapPerWidth = 0.75; // radius of the ball's cap over the width
constexpr double kBallRadii = 4;      // the ball's radius over the cap's: a flat ball, which form of a part lets in

/// A ball's cap: offsets of cells, and how far the ball's surface lies below its top there.
struct Cap {
    std::vector<cv::Point> offsets;
    std::vector<float> drop; // mm
};

Cap make_cap(int radius, double cell)
{
    Cap cap;
    const double ball = kBallRadii * radius;
    for (int v = -radius; v <= radius; ++v)
        for (int u = -radius; u <= radius; ++u)
            if (const double square = u * u + v * v; square <= radius * radius) {
                cap.offsets.emplace_back(u, v);
                cap.drop.push_back(static_cast<float>((ball - std::sqrt(ball * ball - square)) * cell));
            }
    return cap;
}

/// Erosion: the highest place of the ball's top beneath the surface, at each cell. Gaps are no obstacle.
Image eroded_by(const Image& z, const Cap& cap)
{
    Image result(z.size());
    tbb::parallel_for(0, z.rows, [&](int y) {
        for (int x = 0; x < z.cols; ++x) {
            float min = std::numeric_limits<float>::infinity();
            for (std::size_t k = 0; k < cap.offsets.size(); ++k) {
                const int u = x + cap.offsets[k].x, v = y + cap.offsets[k].y;
                if (u < 0 || v < 0 || u >= z.cols || v >= z.rows || !(z(v, u) == z(v, u))) continue;
                min = std::min(min, z(v, u) + cap.drop[k]);
            }
            result(y, x) = min;
        }
    });
    return result;
}

/// Dilation: the upper side of all balls whose tops are given.
Image dilated_by(const Image& tops, const Cap& cap)
{
    Image result(tops.size());
    tbb::parallel_for(0, tops.rows, [&](int y) {
        for (int x = 0; x < tops.cols; ++x) {
            float max = -std::numeric_limits<float>::infinity();
            for (std::size_t k = 0; k < cap.offsets.size(); ++k) {
                const int u = x + cap.offsets[k].x, v = y + cap.offsets[k].y;
                if (u < 0 || v < 0 || u >= tops.cols || v >= tops.rows || std::isinf(tops(v, u))) continue;
                max = std::max(max, tops(v, u) - cap.drop[k]);
            }
            result(y, x) = max;
        }
    });
    return result;
}

} // namespace

Image ball_opening(const Image& z, double cell, double width)
{
    const int factor = std::max(1, static_cast<int>(std::lround(width / kBallCellsPerWidth)));
    const Image coarse = coarsened(smoothed(z, finite(z), 1), factor);
    const Cap cap = make_cap(static_cast<int>(std::ceil(kCapPerWidth * width / factor)), factor * cell);
    Image opened = dilated_by(eroded_by(coarse, cap), cap);
    opened.setTo(std::numeric_limits<float>::quiet_NaN(), ~finite(coarse));
    return refined(filled(opened), factor, z.size());
}

} // namespace fettle::find
