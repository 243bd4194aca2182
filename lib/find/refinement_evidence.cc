#include "find/flat_top.h"
#include "find/refinement.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

/// The evidence of a region: what Refinement measures once the region is final.
namespace fettle::find {
namespace {

// The shell around a region in which the metal should lie on the surface beneath: its distances from the region, cells,
// and its tolerance, in standard deviations or as a share of the height, which a rounded foot reaches.
constexpr double kShellFrom = 1.5, kShellTo = 4;
constexpr double kShellSds = 4, kShellShare = 0.15;

} // namespace

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

/// Fits the surface without each quadrant of the ring in turn, and measures how much it changes beneath the region.
void Refinement::measure_stability(Evidence& evidence) const
{
    const cv::Rect box = cv::boundingRect(region_);
    const double x0 = box.x + box.width / 2.0, y0 = box.y + box.height / 2.0;
    std::vector<cv::Point> places;
    cv::findNonZero(region_, places);
    Eigen::VectorXd z(Eigen::Index(places.size()));
    for (std::size_t k = 0; k < places.size(); ++k) z[Eigen::Index(k)] = beneath_.fit.z_at(places[k].x, places[k].y);
    std::vector<double> squares(places.size(), 0);
    int fits = 0;
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
        Mask partial = beneath_.ring.clone();
        for (int y = 0; y < partial.rows; ++y)
            for (int x = 0; x < partial.cols; ++x)
                if (((x - x0 > y - y0) ? 1 : 0) + ((x - x0 > -(y - y0)) ? 2 : 0) == quadrant) partial(y, x) = 0;
        const auto other = fit(partial, beneath_.distance, beneath_.width, 3, creases(false));
        if (!other) continue;
        ++fits;
        for (std::size_t k = 0; k < places.size(); ++k) {
            const double d = other->z_at(places[k].x, places[k].y) - z[Eigen::Index(k)];
            squares[k] += d * d;
        }
    }
    evidence.instability = fits == 0 ? evidence.height : std::sqrt(quantile_of(squares, 0.75) / fits);
    evidence.sag =
        plane_residuals(places, z, Eigen::VectorXd::Ones(z.size())).norm() / std::sqrt(double(places.size()));
}

namespace {

constexpr double kMinSignificance = 4;
constexpr int kMaxGrowth = 6;
constexpr double kCorrelatedShellCells = 6; // as informative as one independent cell

} // namespace

/// Number of shells around the region whose mean is above the surface by more than chance.
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
    const cv::Rect all({0, 0}, window_.size());
    Verified verified{window_, trimmed(), region_, residual_in(all), {}};
    verified.growth = growth();
    verified.has_crease = crease_.has_value();
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
    e.thickness = thickness_;
    if (e.height < bounds_.min_height || e.significance() < kMinSignificance) return verified; // no evidence needed
    const Mask inner_ring = beneath_.ring & (beneath_.distance <= std::max(0.5 * beneath_.width, 4.0) + kRingGap);
    if (const auto inner = fit(inner_ring, beneath_.distance, 1e9, 3, creases(false))) {
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
    verified.score = score_of(e);
    if (verified.score >= kMinDoubtfulScore) {
        const Top top = measure_top(region_, beneath_.residual, z_);
        e.top_departure = top.departure;
        e.top_rise = top.slope * thickness_;
    }
    return verified;
}

} // namespace fettle::find
