#include "find/sheets.h"

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace fettle::find {
namespace {

constexpr double kSmoothing = 1.2; // cells, before normals are taken
constexpr int kNormalStep = 2;     // normals this far before and behind a cell are compared, cells

// A crease is where they differ by more than this angle, and by more than this multiple of their median difference,
// which the noise and the form of the part make.
constexpr double kMinCreaseAngle = 15 * std::numbers::pi / 180;
constexpr double kCreaseMedians = 3.5;

constexpr int kMaxSheets = 10;
constexpr int kMinSheetCells = 300;
constexpr double kMinSheetShare = 0.004; // of the part
constexpr int kClosedGap = 4;            // a crease around an anomaly is closed, cells

cv::Mat3f normals_of(const HeightMap& map)
{
    const Image z = filled(smoothed(map.z, map.seen, kSmoothing));
    cv::Mat3f normals(z.size());
    tbb::parallel_for(0, z.rows, [&](int y) {
        for (int x = 0; x < z.cols; ++x) {
            const int x0 = std::max(0, x - 1), x1 = std::min(z.cols - 1, x + 1);
            const int y0 = std::max(0, y - 1), y1 = std::min(z.rows - 1, y + 1);
            const double dx = (z(y, x1) - z(y, x0)) / (std::max(1, x1 - x0) * map.cell);
            const double dy = (z(y1, x) - z(y0, x)) / (std::max(1, y1 - y0) * map.cell);
            const double scale = 1 / std::sqrt(1 + dx * dx + dy * dy);
            normals(y, x) = {float(-dx * scale), float(-dy * scale), float(scale)};
        }
    });
    return normals;
}

/// The larger of the angles between normals along x and y.
Image turn_of(const cv::Mat3f& normals)
{
    Image turn(normals.size());
    tbb::parallel_for(0, normals.rows, [&](int y) {
        for (int x = 0; x < normals.cols; ++x) {
            const auto clamp_x = [&](int u) { return std::clamp(u, 0, normals.cols - 1); };
            const auto clamp_y = [&](int v) { return std::clamp(v, 0, normals.rows - 1); };
            const float along_x = normals(y, clamp_x(x - kNormalStep)).dot(normals(y, clamp_x(x + kNormalStep)));
            const float along_y = normals(clamp_y(y - kNormalStep), x).dot(normals(clamp_y(y + kNormalStep), x));
            turn(y, x) = std::acos(std::clamp(std::min(along_x, along_y), -1.F, 1.F));
        }
    });
    return turn;
}

} // namespace

std::vector<Sheet> find_sheets(const HeightMap& map, double reach)
{
    const Image turn = turn_of(normals_of(map));
    const double median = quantile_of(values_in(turn, map.seen), 0.5);
    const Mask smooth = opened(map.seen & (turn < std::max(kMinCreaseAngle, kCreaseMedians * median)), 3);
    const Components pieces = components(smooth);
    std::vector<int> order(pieces.count);
    std::iota(order.begin(), order.end(), 1);
    std::ranges::stable_sort(order, std::greater{}, [&](int k) { return pieces.area(k); });
    const double min_cells = std::max(double(kMinSheetCells), kMinSheetShare * cv::countNonZero(map.seen));
    std::erase_if(order, [&](int k) { return pieces.area(k) <= min_cells; });
    if (order.size() > kMaxSheets) order.resize(kMaxSheets);
    Mask main(map.z.size(), 0);
    for (const int k : order) main |= pieces.labels == k;
    std::vector<Sheet> sheets;
    for (const int k : order) {
        const Mask own = pieces.labels == k;
        const Mask enclosed = with_holes_filled(closed(own, kClosedGap)) | own;
        const Mask beside = (distance_to(enclosed) < reach) & (~main | own);
        sheets.push_back({own & map.seen, (enclosed | beside) & map.seen});
    }
    return sheets;
}

} // namespace fettle::find
