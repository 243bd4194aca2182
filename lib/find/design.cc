#include "find/design.h"

#include "core/constants.h"
#include "find/flat_top.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::find {
namespace {

// A boss by design has a flat top, and an outline that is a rectangle or an ellipse: shares of height and area.
constexpr double kFlatTop = 0.05, kRegularOutline = 0.06;
constexpr double kTopDepth = 3;           // cells inside of the region's outline
constexpr std::size_t kMinBossCells = 12; // of the top: fewer do not determine its form

// A flat top departs from a plane by this share of its height, or by noise, whose median is 0.67 of its spread.
constexpr double kFlatShare = 0.03, kFlatNoise = 1.05;
// The heights of two flat tops are equal if they differ by less than these shares of the height and of the noise.
// Regions lower than so many sigmas of the noise may be flat and of one height by chance. Pads, letters and digits of
// one height differ in area.
constexpr double kAlikeHeight = 0.02, kAlikeNoise = 0.5, kMinAlikeSigmas = 12;
constexpr double kAlikeAreas = 3; // ratio

double area_of(const Evidence& evidence) { return evidence.cells * evidence.cell * evidence.cell; }

/// Root mean square distance from their least squares plane of the cells of a region that lie farther than kTopDepth
/// from its outline, mm; infinite if they are few.
double departure_of_boss(const Verified& find)
{
    const Mask top = (depth_of(find.mask) > float(kTopDepth)) & finite(find.height);
    std::vector<cv::Point> cells;
    cv::findNonZero(top, cells);
    if (cells.size() < kMinBossCells) return core::kInfinity;
    const Eigen::VectorXd z = values_at(find.height, cells);
    return plane_residuals(cells, z, Eigen::VectorXd::Ones(z.size())).norm() / std::sqrt(double(cells.size()));
}

bool has_flat_top(const Evidence& e)
{
    return e.top_departure <= std::hypot(kFlatShare * e.height, kFlatNoise * e.noise);
}

} // namespace

bool looks_designed(const Verified& find)
{
    if (departure_of_boss(find) > kFlatTop * find.evidence.height) return false;
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
           has_flat_top(a.evidence) && has_flat_top(b.evidence);
}

} // namespace fettle::find
