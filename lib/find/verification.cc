#include "find/verification.h"

#include "find/ring_fit.h"

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fettle::find {
namespace {

constexpr int kMaxIterations = 6;
constexpr double kStableOverlap = 0.97; // intersection over union of two regions in a row
constexpr int kMinRegionCells = 12;
constexpr int kMinRing = 50; // cells

// The ring is 0.8 times as wide as the region is thick, within bounds, and begins beyond its rounded foot.
constexpr double kRingPerThickness = 0.8;
constexpr double kRingPerExtent = 0.35;                               // of a thin region
constexpr double kMinRingWidth = 6, kMaxRingWidth = 45, kRingGap = 2; // cells
constexpr int kMaxMargin = 60, kMarginBeyond = 8;                     // of the window, cells

// Hysteresis of the region over the surface: seeds stand over it by so many of its standard deviations and by this
// share of the height, the region is what hangs together with them down to the lower bounds.
constexpr double kSeedSds = 4.5, kSeedShare = 0.2;
constexpr double kRegionSds = 2.5, kRegionShare = 0.08;
constexpr double kRingVariance = 0.35; // share of the ring's variance in the smoothed residual
constexpr double kMinSds = 0.25;       // of the noise
constexpr double kHeightSmoothing = 0.8;

// A cell of the region belongs to its rim if its own height is below noise and this share of the region's, and its
// smoothed height below the other.
constexpr double kTrimShare = 0.04, kTrimSmoothShare = 0.25;

/// Thickness of a region: the diameter of its largest inscribed circle, cells.
double thickness_of(const Mask& mask)
{
    double max = 0;
    cv::minMaxLoc(depth_of(mask), nullptr, &max);
    return 2 * max;
}

struct Beneath {
    RingFit fit;
    Mask ring;
    Image distance; ///< from the region
    double width;   ///< of the ring
    Image residual; ///< over the surface
    Image smooth;   ///< the same, smoothed; very low where nothing is seen
    Image sd;       ///< of the surface
};

/// The refinement of one candidate within its window.
class Refinement {
  public:
    Refinement(const HeightMap& map, const Candidate& candidate, const Mask& others, const SearchBounds& bounds)
        : bounds_(bounds), cell_(map.cell), sigma_(map.sigma)
    {
        const double extent = std::max(candidate.box.width, candidate.box.height);
        const double width = kRingPerThickness * std::max(thickness_of(candidate.mask), extent / 2);
        window_ = grown_box(candidate.box, int(std::clamp(width, kMinRingWidth, double(kMaxMargin))) + kMarginBeyond,
                            map.z.size());
        z_ = map.z(window_);
        seen_ = map.seen(window_);
        others_ = others(window_);
        region_ = Mask(z_.size(), 0);
        candidate.mask.copyTo(region_(candidate.box - window_.tl()));
        core_ = dilated(region_, 1);
    }

    /// The region without the rim that only smoothing has raised.
    Mask trimmed() const
    {
        const double height = quantile_of(values_in(beneath_.smooth, region_ & seen_), 0.85);
        const Mask high = (beneath_.residual >= float(kTrimShare * height + sigma_)) |
                          (beneath_.smooth >= float(kTrimSmoothShare * height));
        const Mask trimmed = closed(region_ & high, 1) & region_;
        return cv::countNonZero(trimmed) >= kMinRegionCells ? largest(trimmed) : region_;
    }

    /// @return  false if no region remains
    bool run()
    {
        for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
            if (!fit_beneath()) return false;
            const Mask next = region_over_surface();
            const int count = cv::countNonZero(next);
            if (count < kMinRegionCells || count * cell_ * cell_ > bounds_.max_area) return false;
            const double overlap = double(cv::countNonZero(next & region_)) / cv::countNonZero(next | region_);
            region_ = next;
            if (overlap > kStableOverlap) break;
        }
        return true;
    }

    Verified result(double texture) const;

  private:
    Mask ring_of(const Image& distance, double width) const
    {
        const Mask ring = (distance > kRingGap) & (distance <= width + kRingGap) & seen_;
        const Mask free = ring & ~(dilated(others_, 1) & (distance > kRingGap + 1));
        const int count = cv::countNonZero(free);
        return 2 * count >= cv::countNonZero(ring) && count > kMinRing + 10 ? free : ring;
    }

    std::optional<RingFit> fit(const Mask& ring, const Image& distance, double width, int max_degree) const
    {
        const int count = cv::countNonZero(ring);
        if (count < kMinRing) return std::nullopt;
        RingPoints points{Eigen::Matrix2Xd(2, count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
        Eigen::Index k = 0;
        for (int y = 0; y < ring.rows; ++y)
            for (int x = 0; x < ring.cols; ++x)
                if (ring(y, x)) {
                    const double d = distance(y, x) / width;
                    points.xy.col(k) << x, y;
                    points.z[k] = z_(y, x);
                    points.weights[k++] = std::exp(-d * d / 2);
                }
        return fit_ring(points, sigma_, max_degree);
    }

    bool fit_beneath()
    {
        const cv::Rect box = cv::boundingRect(region_);
        const double width = std::clamp(
            kRingPerThickness * std::max(thickness_of(region_), kRingPerExtent * (std::max(box.width, box.height) - 1)),
            kMinRingWidth, kMaxRingWidth);
        const Image distance = distance_to(region_);
        const Mask ring = ring_of(distance, width);
        std::optional<RingFit> fitted = fit(ring, distance, width, 4);
        if (!fitted) return false;
        beneath_ = {std::move(*fitted), ring, distance, width, {}, {}, {}};
        evaluate();
        return true;
    }

    /// Heights over the surface, and its standard deviation, which is smooth: at every few cells it is computed.
    void evaluate()
    {
        const int step = std::max(1, std::max(z_.rows, z_.cols) / 24);
        Image coarse((z_.rows + step - 1) / step, (z_.cols + step - 1) / step);
        for (int y = 0; y < coarse.rows; ++y)
            for (int x = 0; x < coarse.cols; ++x)
                coarse(y, x) = float(beneath_.fit.at((x + 0.5) * step - 0.5, (y + 0.5) * step - 0.5).sd);
        beneath_.sd = refined(coarse, step, z_.size());
        beneath_.residual.create(z_.size());
        for (int y = 0; y < z_.rows; ++y)
            for (int x = 0; x < z_.cols; ++x) beneath_.residual(y, x) = float(z_(y, x) - beneath_.fit.z_at(x, y));
        beneath_.residual.setTo(std::numeric_limits<float>::quiet_NaN(), ~seen_);
        beneath_.smooth = smoothed(beneath_.residual, seen_, kHeightSmoothing);
        beneath_.smooth.setTo(-1e9, ~seen_);
    }

    Mask region_over_surface() const
    {
        const double height = quantile_of(values_in(beneath_.smooth, region_ & seen_), 0.85);
        Mask seeds(z_.size(), 0), low(z_.size(), 0);
        for (int y = 0; y < z_.rows; ++y)
            for (int x = 0; x < z_.cols; ++x) {
                const double sd = std::max(std::sqrt(kRingVariance * beneath_.fit.sd * beneath_.fit.sd +
                                                     beneath_.sd(y, x) * beneath_.sd(y, x)),
                                           kMinSds * sigma_);
                const double value = beneath_.smooth(y, x);
                if (value > std::max(kSeedSds * sd, kSeedShare * height) && core_(y, x)) seeds(y, x) = 255;
                if (value > std::max(kRegionSds * sd, kRegionShare * height) &&
                    beneath_.distance(y, x) < beneath_.width + kRingGap)
                    low(y, x) = 255;
            }
        return largest(opened(connected_to(low, seeds), cv::countNonZero(low) > 60 ? 3 : 2));
    }

    /// Components of a mask that hold a seed.
    static Mask connected_to(const Mask& mask, const Mask& seeds)
    {
        const Components parts = components(mask);
        std::vector<char> is_kept(std::size_t(parts.count) + 1, 0);
        for (int y = 0; y < mask.rows; ++y)
            for (int x = 0; x < mask.cols; ++x)
                if (seeds(y, x)) is_kept[std::size_t(parts.labels(y, x))] = 1;
        is_kept[0] = 0;
        Mask result(mask.size(), 0);
        for (int y = 0; y < mask.rows; ++y)
            for (int x = 0; x < mask.cols; ++x)
                if (is_kept[std::size_t(parts.labels(y, x))]) result(y, x) = 255;
        return result;
    }

    /// The component with the largest volume over the surface.
    Mask largest(const Mask& mask) const
    {
        const Components parts = components(mask, 8);
        if (parts.count <= 1) return mask;
        std::vector<double> volume(std::size_t(parts.count) + 1, 0);
        for (int y = 0; y < mask.rows; ++y)
            for (int x = 0; x < mask.cols; ++x)
                if (mask(y, x)) volume[std::size_t(parts.labels(y, x))] += std::max(0.F, beneath_.smooth(y, x));
        volume[0] = -1;
        return parts.labels == int(std::ranges::max_element(volume) - volume.begin());
    }

    void measure_shell(Evidence& evidence) const;
    void measure_stability(Evidence& evidence) const;
    int growth() const;

    SearchBounds bounds_;
    double cell_, sigma_;
    cv::Rect window_;
    Image z_;
    Mask seen_, others_, region_, core_;
    Beneath beneath_;
};

// The shell around a region in which the surface should lie open: from 1.5 to 4 cells off, and how far off the surface
// it may be: noise, or a share of the height, which a rounded foot reaches.
constexpr double kShellFrom = 1.5, kShellTo = 4;
constexpr double kShellSds = 4, kShellShare = 0.15;

void Refinement::measure_shell(Evidence& evidence) const
{
    const int margin = 6;
    Mask padded;
    cv::copyMakeBorder(region_, padded, margin, margin, margin, margin, cv::BORDER_CONSTANT, 0);
    const Image distance = distance_to(padded);
    int all = 0, level = 0, below = 0, above = 0, unseen = 0;
    for (int y = 0; y < padded.rows; ++y)
        for (int x = 0; x < padded.cols; ++x) {
            if (distance(y, x) <= kShellFrom || distance(y, x) > kShellTo) continue;
            ++all;
            const cv::Point place(x - margin, y - margin);
            if (!cv::Rect({0, 0}, seen_.size()).contains(place) || !seen_(place)) {
                ++unseen;
                continue;
            }
            const double sd = std::hypot(std::sqrt(kRingVariance) * beneath_.fit.sd, beneath_.sd(place));
            const double tolerance = std::max(kShellSds * sd, kShellShare * evidence.height);
            const double value = beneath_.smooth(place);
            level += std::abs(value) < tolerance;
            below += value < -2 * tolerance;
            above += value > tolerance;
        }
    evidence.enclosure = double(level) / all;
    evidence.drop = double(below) / all;
    evidence.rise = double(above) / all;
    evidence.unseen = double(unseen) / all;
}

/// Refits the surface with each quadrant of the ring left out, and measures how much it moves beneath the region.
void Refinement::measure_stability(Evidence& evidence) const
{
    const cv::Rect box = cv::boundingRect(region_);
    const double x0 = box.x + box.width / 2.0, y0 = box.y + box.height / 2.0;
    std::vector<cv::Point> places;
    cv::findNonZero(region_, places);
    std::vector<double> squares(places.size(), 0);
    int fits = 0;
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
        Mask partial = beneath_.ring.clone();
        for (int y = 0; y < partial.rows; ++y)
            for (int x = 0; x < partial.cols; ++x)
                if (((x - x0 > y - y0) ? 1 : 0) + ((x - x0 > -(y - y0)) ? 2 : 0) == quadrant) partial(y, x) = 0;
        const auto other = fit(partial, beneath_.distance, beneath_.width, 3);
        if (!other) continue;
        ++fits;
        for (std::size_t k = 0; k < places.size(); ++k) {
            const double d = other->z_at(places[k].x, places[k].y) - beneath_.fit.z_at(places[k].x, places[k].y);
            squares[k] += d * d;
        }
    }
    evidence.instability = fits == 0 ? evidence.height : std::sqrt(quantile_of(squares, 0.75) / fits);
    Eigen::MatrixXd A(Eigen::Index(places.size()), 3);
    Eigen::VectorXd z(A.rows());
    for (std::size_t k = 0; k < places.size(); ++k) {
        A.row(Eigen::Index(k)) << 1, places[k].x - x0, places[k].y - y0;
        z[Eigen::Index(k)] = beneath_.fit.z_at(places[k].x, places[k].y);
    }
    const Eigen::Vector3d plane = (A.transpose() * A).ldlt().solve(A.transpose() * z);
    evidence.sag = std::sqrt((z - A * plane).squaredNorm() / double(places.size()));
}

constexpr double kMinSignificance = 4;
constexpr int kMaxGrowth = 6;
constexpr double kCorrelatedShellCells = 6; // that stand for an independent one

/// Shells around the region whose mean stands over the surface by more than chance.
int Refinement::growth() const
{
    for (int k = 1; k <= kMaxGrowth; ++k) {
        const Mask shell = (beneath_.distance > float(k - 1)) & (beneath_.distance <= float(k)) & seen_ &
                           ~(others_ & (beneath_.distance > 3));
        const std::vector<double> values = values_in(beneath_.residual, shell);
        if (values.size() < 5) return k - 1;
        const double sd = beneath_.fit.sd;
        double sum = 0;
        for (const double value : values) sum += std::clamp(value, -3 * sd, 3 * sd);
        const auto count = double(values.size());
        if (sum / count <= std::max(0.5 * sd * std::sqrt(kCorrelatedShellCells / count), 0.25 * sd)) return k - 1;
    }
    return kMaxGrowth;
}

Verified Refinement::result(double texture) const
{
    Verified verified{window_, trimmed(), region_, beneath_.residual, {}, growth(), 0};
    Evidence& e = verified.evidence;
    const Mask inside = region_ & seen_;
    e.height = quantile_of(values_in(beneath_.residual, inside), 0.9);
    e.ring_sd = beneath_.fit.sd;
    e.prediction_sd = quantile_of(values_in(beneath_.sd, region_), 0.5);
    e.noise = sigma_;
    e.texture = texture;
    e.inliers = beneath_.fit.inliers;
    e.cell = cell_;
    double reach = 0;
    cv::minMaxLoc(beneath_.distance, nullptr, &reach, nullptr, nullptr, beneath_.ring);
    e.ring_width = reach - kRingGap;
    e.degree = beneath_.fit.degree;
    e.cells = cv::countNonZero(region_);
    e.thickness = thickness_of(region_);
    if (e.height < bounds_.min_height || e.significance() < kMinSignificance) return verified; // no evidence needed
    const Mask inner_ring = beneath_.ring & (beneath_.distance <= std::max(0.5 * beneath_.width, 4.0) + kRingGap);
    if (const auto inner = fit(inner_ring, beneath_.distance, 1e9, 3)) {
        std::vector<double> differences;
        for (int y = 0; y < region_.rows; ++y)
            for (int x = 0; x < region_.cols; ++x)
                if (region_(y, x)) differences.push_back(std::abs(inner->z_at(x, y) - beneath_.fit.z_at(x, y)));
        e.disagreement = quantile_of(differences, 0.75);
    }
    measure_stability(e);
    measure_shell(e);
    const Image depth = depth_of(region_);
    const std::vector<double> within = values_in(beneath_.residual, (depth > 1) & (depth <= 3) & seen_);
    const std::vector<double> without =
        values_in(beneath_.residual, (beneath_.distance > 1) & (beneath_.distance <= 3) & seen_);
    if (!within.empty() && !without.empty())
        e.sharpness = (quantile_of(within, 0.5) - quantile_of(without, 0.5)) / e.height;
    e.pits = double(cv::countNonZero(beneath_.ring & (beneath_.residual < float(-5 * e.ring_sd)))) /
             cv::countNonZero(beneath_.ring);
    verified.probability = probability_of(e);
    return verified;
}

} // namespace

std::optional<Verified> verify(const HeightMap& map, const Candidate& candidate, const Mask& others,
                               const SearchBounds& bounds)
{
    Refinement refinement(map, candidate, others, bounds);
    if (!refinement.run()) return std::nullopt;
    Verified verified = refinement.result(candidate.texture);
    if (!is_plausible(verified.evidence, bounds)) return std::nullopt;
    return verified;
}

namespace {

// Candidates larger than this share of the largest anomaly, or of a lower rank, do not keep cells out of others' rings.
constexpr double kMaxOtherArea = 0.3;
constexpr double kMinOtherRank = 3;

} // namespace

std::vector<Verified> verify_all(const HeightMap& map, const std::vector<Candidate>& candidates,
                                 const SearchBounds& bounds)
{
    Mask others(map.z.size(), 0);
    const double max_cells = kMaxOtherArea * bounds.max_area / (map.cell * map.cell);
    for (const Candidate& candidate : candidates)
        if (candidate.rank > kMinOtherRank && cv::countNonZero(candidate.mask) < max_cells)
            others(candidate.box) |= candidate.mask;
    std::vector<std::optional<Verified>> results(candidates.size());
    tbb::parallel_for(std::size_t{0}, candidates.size(),
                      [&](std::size_t i) { results[i] = verify(map, candidates[i], others, bounds); });
    std::vector<Verified> verified;
    for (auto& result : results)
        if (result) verified.push_back(std::move(*result));
    return verified;
}

} // namespace fettle::find
