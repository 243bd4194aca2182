#include "find/refinement.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::find {
namespace {

constexpr int kMinRegionCells = 12;
constexpr int kMinRing = 50; // cells

// The ring is 0.8 times as wide as the region is thick, within bounds, and begins beyond its rounded foot.
constexpr double kRingPerThickness = 0.8;
constexpr double kRingPerExtent = 0.35;                 // of a thin region
constexpr double kMinRingWidth = 6, kMaxRingWidth = 45; // cells
constexpr int kMaxMargin = 60, kMarginBeyond = 8;       // of the window, cells

// Hysteresis thresholds of the region, in standard deviations of the surface beneath and as shares of the height: cells
// above the upper ones are seeds, connected cells above the lower ones belong to the region.
constexpr double kSeedSds = 4.5, kSeedShare = 0.2;
constexpr double kRegionSds = 2.5, kRegionShare = 0.08;
constexpr double kMinSds = 0.25; // lower bound of that standard deviation, in sigmas of the noise
constexpr double kHeightSmoothing = 0.8;
// Cells around the ring that are evaluated, too: the shell around a region that has grown to the ring's edge, and the
// kernel of the smoothing.
constexpr int kReachBeyondRing = 8;
constexpr float kVeryLow = -1e9; // mm: no region

// A crease beneath the region is found in the first step, or in the second, when the region has been segmented again.
constexpr int kMaxCreaseSearches = 2;
// Cells. A thinner region on a crease may be the crease itself, as ridges are rounded and curved.
constexpr double kMinCreaseThickness = 7;
// Slopes on both sides differ by more than where a sheet ends (15 degrees), and less than beside a wall (60).
constexpr double kMinBend = 0.27, kMaxBend = 1.7;

// A cell of the region belongs to its rim if its own height is below noise and this share of the region's, and its
// smoothed height below the other.
constexpr double kTrimShare = 0.04, kTrimSmoothShare = 0.25;

} // namespace

double thickness_of(const Mask& mask)
{
    double max = 0;
    if (const cv::Rect box = cv::boundingRect(mask); !box.empty())
        cv::minMaxLoc(depth_of(mask(box)), nullptr, &max); // beyond its box the mask has no cell
    return 2 * max;
}

Refinement::Refinement(const HeightMap& map, const Candidate& candidate, const Mask& others, const SearchBounds& bounds)
    : bounds_(bounds), cell_(map.cell), sigma_(map.sigma), thickness_(thickness_of(candidate.mask))
{
    set_window(map, others, candidate.box);
    region_ = Mask(z_.size(), 0);
    candidate.mask.copyTo(region_(candidate.box - window_.tl()));
    core_ = dilated(region_, 1);
}

void Refinement::set_window(const HeightMap& map, const Mask& others, const cv::Rect& box)
{
    const double width = kRingPerThickness * std::max(thickness_, std::max(box.width, box.height) / 2.0);
    window_ = grown_box(box, int(std::clamp(width, kMinRingWidth, double(kMaxMargin))) + kMarginBeyond, map.z.size());
    z_ = map.z(window_);
    seen_ = map.seen(window_);
    seen_weight_ = smoothing_weight(seen_, kHeightSmoothing);
    others_ = others(window_);
}

bool Refinement::widen(const HeightMap& map, const Mask& others)
{
    const cv::Rect before = window_, box = cv::boundingRect(region_) + window_.tl();
    const cv::Rect needed = grown_box(box, kMarginBeyond, map.z.size());
    if ((needed & window_) == needed) return false;
    set_window(map, others, box | before);
    for (Mask* mask : {&region_, &core_}) {
        Mask wide(z_.size(), 0);
        mask->copyTo(wide(before - window_.tl()));
        *mask = wide;
    }
    crease_.reset(); // it lay in the window before
    crease_searches_ = 0;
    return true;
}

Mask Refinement::trimmed() const
{
    const double height = quantile_of(values_in(beneath_.smooth, region_ & seen_), 0.85);
    const Mask high = (beneath_.residual >= float(kTrimShare * height + sigma_)) |
                      (beneath_.smooth >= float(kTrimSmoothShare * height));
    const Mask trimmed = closed(region_ & high, 1) & region_;
    return cv::countNonZero(trimmed) >= kMinRegionCells ? largest(trimmed) : region_;
}

Refinement::Progress Refinement::step()
{
    if (!fit_beneath()) return Progress::none;
    const Mask next = region_over_surface();
    const int count = cv::countNonZero(next);
    if (count < kMinRegionCells || count * cell_ * cell_ > bounds_.max_area) return Progress::none;
    const double overlap = double(cv::countNonZero(next & region_)) / cv::countNonZero(next | region_);
    region_ = next;
    thickness_ = thickness_of(region_);
    return overlap > kStableOverlap ? Progress::converged : Progress::changed;
}

Candidate Refinement::region() const
{
    const cv::Rect box = cv::boundingRect(region_);
    return {box + window_.tl(), region_(box).clone(), 0, cv::countNonZero(region_), 0};
}

Mask Refinement::ring_of(const Image& distance, double width) const
{
    const Mask ring = (distance > kRingGap) & (distance <= width + kRingGap) & seen_;
    const Mask free = ring & ~(dilated(others_, 1) & (distance > kRingGap + 1));
    const int count = cv::countNonZero(free);
    return 2 * count >= cv::countNonZero(ring) && count > kMinRing + 10 ? free : ring;
}

std::optional<RingFit> Refinement::fit(const Mask& ring, const Image& distance, double width, int max_degree,
                                       const CreaseSearch& creases) const
{
    const int count = cv::countNonZero(ring);
    if (count < kMinRing) return std::nullopt;
    RingPoints points{Eigen::Matrix2Xd(2, count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
    Eigen::Index k = 0;
    const cv::Rect box = cv::boundingRect(ring);
    for (int y = box.y; y < box.y + box.height; ++y)
        for (int x = box.x; x < box.x + box.width; ++x)
            if (ring(y, x)) {
                points.xy.col(k) << x, y;
                points.z[k] = z_(y, x);
                points.weights[k++] = -0.5 * distance(y, x) * distance(y, x) / (width * width);
            }
    points.weights = points.weights.array().exp();
    return fit_ring(points, sigma_, max_degree, creases);
}

CreaseSearch Refinement::creases(bool is_sought) const
{
    return {is_sought, crease_, kMinBend * cell_, kMaxBend * cell_};
}

bool Refinement::fit_beneath()
{
    const cv::Rect box = cv::boundingRect(region_);
    const double width =
        std::clamp(kRingPerThickness * std::max(thickness_, kRingPerExtent * (std::max(box.width, box.height) - 1)),
                   kMinRingWidth, kMaxRingWidth);
    const cv::Rect reach = grown_box(box, int(std::ceil(width + kRingGap)) + kReachBeyondRing, z_.size());
    Image distance(z_.size(), float(z_.rows + z_.cols));
    distance_to(region_(reach)).copyTo(distance(reach));
    const Mask ring = ring_of(distance, width);
    if (thickness_ < kMinCreaseThickness) crease_.reset();
    const bool is_sought = thickness_ >= kMinCreaseThickness && (crease_ || crease_searches_ < kMaxCreaseSearches);
    std::optional<RingFit> fitted = fit(ring, distance, width, 4, creases(is_sought));
    if (!fitted) return false;
    crease_searches_ += is_sought;
    crease_ = fitted->crease_in_place();
    beneath_ = {std::move(*fitted), ring, reach, distance, width, {}, {}, {}};
    evaluate();
    return true;
}

void Refinement::evaluate()
{
    const int step = std::max(1, std::max(z_.rows, z_.cols) / 24);
    Image coarse((z_.rows + step - 1) / step, (z_.cols + step - 1) / step);
    for (int y = 0; y < coarse.rows; ++y)
        beneath_.fit.sd_row(0.5 * step - 0.5, (y + 0.5) * step - 0.5, step, {coarse[y], std::size_t(coarse.cols)});
    beneath_.sd = refined(coarse, step, z_.size());
    const cv::Rect& reach = beneath_.reach;
    beneath_.residual = Image(z_.size(), std::numeric_limits<float>::quiet_NaN());
    residual_in(reach).copyTo(beneath_.residual(reach));
    Image smooth = smoothed(beneath_.residual(reach), seen_(reach), kHeightSmoothing, seen_weight_(reach));
    smooth.setTo(kVeryLow, ~seen_(reach));
    beneath_.smooth = Image(z_.size(), kVeryLow);
    smooth.copyTo(beneath_.smooth(reach));
}

Image Refinement::residual_in(const cv::Rect& box) const
{
    Image residual = z_(box).clone();
    for (int y = 0; y < box.height; ++y)
        beneath_.fit.add_row(box.x, box.y + y, -1, {residual[y], std::size_t(box.width)});
    residual.setTo(std::numeric_limits<float>::quiet_NaN(), ~seen_(box));
    return residual;
}

Image Refinement::surface() const
{
    Image surface(z_.size(), 0.F);
    for (int y = 0; y < z_.rows; ++y) beneath_.fit.add_row(0, y, 1, {surface[y], std::size_t(z_.cols)});
    return surface;
}

Mask Refinement::region_over_surface() const
{
    const double height = quantile_of(values_in(beneath_.smooth, region_ & seen_), 0.85);
    const double ring_variance = kRingVariance * beneath_.fit.sd * beneath_.fit.sd;
    const double min_height = std::max(kRegionSds * kMinSds * sigma_, kRegionShare * height);
    const cv::Rect& reach = beneath_.reach;
    Mask seeds(z_.size(), 0), low(z_.size(), 0);
    for (int y = reach.y; y < reach.y + reach.height; ++y)
        for (int x = reach.x; x < reach.x + reach.width; ++x) {
            const double value = beneath_.smooth(y, x);
            if (!(value > min_height)) continue; // true for most cells, which need no square root
            const double sd =
                std::max(std::sqrt(ring_variance + beneath_.sd(y, x) * beneath_.sd(y, x)), kMinSds * sigma_);
            if (value > std::max(kSeedSds * sd, kSeedShare * height) && core_(y, x)) seeds(y, x) = 255;
            if (value > kRegionSds * sd && beneath_.distance(y, x) < beneath_.width + kRingGap) low(y, x) = 255;
        }
    // Steep sides hide cells: a few unseen cells do not divide a region.
    low |= closed(low, 1) & ~seen_;
    return largest(opened(connected_to(low, seeds), cv::countNonZero(low) > 60 ? 3 : 2));
}

Mask Refinement::connected_to(const Mask& mask, const Mask& seeds)
{
    Mask result(mask.size(), 0);
    const cv::Rect box = cv::boundingRect(mask);
    if (box.empty()) return result;
    const Components parts = components(mask(box));
    std::vector<std::uint8_t> kept(std::size_t(parts.count) + 1, 0);
    for (int y = 0; y < box.height; ++y)
        for (int x = 0; x < box.width; ++x)
            if (seeds(y + box.y, x + box.x)) kept[std::size_t(parts.labels(y, x))] = 255;
    kept[0] = 0;
    for (int y = 0; y < box.height; ++y)
        for (int x = 0; x < box.width; ++x) result(y + box.y, x + box.x) = kept[std::size_t(parts.labels(y, x))];
    return result;
}

Mask Refinement::largest(const Mask& mask) const
{
    const cv::Rect box = cv::boundingRect(mask);
    if (box.empty()) return mask;
    const Components parts = components(mask(box), 8);
    if (parts.count <= 1) return mask;
    std::vector<double> volume(std::size_t(parts.count) + 1, 0);
    const Image heights = beneath_.smooth(box);
    for (int y = 0; y < box.height; ++y)
        for (int x = 0; x < box.width; ++x) volume[std::size_t(parts.labels(y, x))] += std::max(0.F, heights(y, x));
    volume[0] = -1;
    Mask result(mask.size(), 0);
    result(box).setTo(255, parts.labels == int(std::ranges::max_element(volume) - volume.begin()));
    return result;
}

} // namespace fettle::find
