#include "find/design.h"

#include "core/cholesky.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::find {
namespace {

using Eigen::Index;

// A boss by design has a flat top, and an outline that is a rectangle or an ellipse: shares of height and area.
constexpr double kFlatTop = 0.05, kRegularOutline = 0.06;
constexpr double kTopDepth = 3;           // cells inside of the region's outline
constexpr std::size_t kMinBossCells = 12; // of the top, to tell its form

// Of a pin a few cells across all but the outermost ones are its top.
constexpr double kPinRim = 1;
constexpr std::size_t kMinPinCells = 9; // three by three
constexpr double kFlatNoise = 1.2;      // a flat top shows the noise, of whose estimate that is the spread
// Heights of flat tops are those of their means: these shares of them, and of the noise, tell two apart. What is not so
// many times the noise high may be as flat and as high by chance. Areas of a few cells differ by the walls.
constexpr double kAlikeHeight = 0.02, kAlikeNoise = 0.5, kMinAlikeSigmas = 12;
constexpr double kAlikeAreas = 1.5; // ratio

double area_of(const Evidence& evidence) { return evidence.cells * evidence.cell * evidence.cell; }

/// Whether the cells of a region that lie farther than `rim` cells from its outline lie on a plane to within a standard
/// deviation, mm; false if they are fewer than `min_cells`.
bool has_flat_top(const Verified& find, double rim, std::size_t min_cells, double tolerance)
{
    const Mask top = (depth_of(find.mask) > float(rim)) & finite(find.height);
    std::vector<cv::Point> places;
    cv::findNonZero(top, places);
    if (places.size() < min_cells) return false;
    Eigen::MatrixXd A(Index(places.size()), 3);
    Eigen::VectorXd z(A.rows());
    for (std::size_t k = 0; k < places.size(); ++k) {
        A.row(Index(k)) << 1, places[k].x - places[0].x, places[k].y - places[0].y;
        z[Index(k)] = find.height(places[k]);
    }
    const Eigen::Vector3d plane = core::solve_ldlt(A.transpose() * A, A.transpose() * z); // definite: cells of an area
    return (z - A * plane).norm() <= tolerance * std::sqrt(double(places.size()));
}

bool is_pin(const Verified& find)
{
    const Evidence& e = find.evidence;
    return has_flat_top(find, kPinRim, kMinPinCells, std::hypot(kFlatTop * e.height, kFlatNoise * e.noise));
}

} // namespace

bool looks_designed(const Verified& find)
{
    if (!has_flat_top(find, kTopDepth, kMinBossCells, kFlatTop * find.evidence.height)) return false;
    std::vector<cv::Point> all;
    cv::findNonZero(find.mask, all);
    const cv::RotatedRect rectangle = cv::minAreaRect(all);
    const double width = rectangle.size.width + 1.0, height = rectangle.size.height + 1.0;
    const double filled = double(all.size()) / (width * height);
    return filled > 1 - kRegularOutline || std::abs(filled - CV_PI / 4) < kRegularOutline * CV_PI / 4;
}

bool are_alike(const Verified& a, const Verified& b)
{
    const double height = std::min(a.evidence.height, b.evidence.height), noise = a.evidence.noise;
    const auto [smaller, larger] = std::minmax({area_of(a.evidence), area_of(b.evidence)});
    return height > kMinAlikeSigmas * noise && larger <= kAlikeAreas * smaller &&
           std::abs(a.evidence.height - b.evidence.height) <= std::hypot(kAlikeHeight * height, kAlikeNoise * noise) &&
           is_pin(a) && is_pin(b);
}

} // namespace fettle::find
