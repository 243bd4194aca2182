#include "align/align.h"
#include "core/constants.h"
#include "core/text.h"
#include "geometry/quantiles.h"
#include "json/units.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace fettle::align {

namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
// Mean square distances of two poses whose ratio is below this may differ by chance alone: the distances of one scan
// are correlated over patches.
constexpr double kMaxAmbiguousMisfitRatio = 1.25;
// An undetermined mode whose component along an axis is below this does not affect the axis: it is rounding.
constexpr double kMinModeComponent = 1e-3;

// Standard deviation along one axis of M, from all modes; infinite if an undetermined mode moves it.
double axis_sd(const Alignment& alignment, Eigen::Index axis)
{
    double variance = 0;
    for (const MotionMode& mode : alignment.modes) {
        const double component = mode.motion[axis];
        if (mode.held) continue;
        if (mode.determined)
            variance += std::pow(component * mode.sd, 2);
        else if (std::abs(component) > kMinModeComponent)
            return std::numeric_limits<double>::infinity();
    }
    return std::sqrt(variance);
}

json::Value sd_json(const Alignment& alignment, double mm)
{
    json::Value sd;
    for (const Eigen::Index k : {0, 1, 2}) sd.set(std::string(1, "xyz"[k]), axis_sd(alignment, k) / mm);
    for (const Eigen::Index k : {0, 1, 2})
        sd.set(std::string("r") + "xyz"[k] + "_deg",
               axis_sd(alignment, 3 + k) / alignment.frame.radius * kDegreesPerRadian);
    return sd;
}

json::Value modes_json(const Alignment& alignment, double mm)
{
    std::vector<json::Value> modes;
    for (const MotionMode& mode : alignment.modes) {
        json::Value value;
        value.set("shift", Eigen::VectorXd(mode.motion.head<3>()));
        value.set("turn", Eigen::VectorXd(mode.motion.tail<3>()));
        if (mode.held)
            value.set("held", true);
        else
            value.set("determined", mode.determined).set("sd", mode.sd / mm);
        modes.push_back(value);
    }
    return modes;
}

void set_residuals(json::Value& report, const IcpFit& fit, const Eigen::Matrix3Xd& points,
                   const AlignReference& reference, double mm)
{
    const FootDistances d = foot_distances(points, reference);
    std::vector<double> sizes;
    double sum = 0, square = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (!(d.absolute[i] <= fit.cutoff)) continue;
        const double residual = d.along_normal[i];
        sizes.push_back(std::abs(residual));
        sum += residual;
        square += residual * residual;
    }
    const double n = sizes.size();
    const auto quantile = [&](double p) { return sizes.empty() ? core::kNaN : geometry::quantile(sizes, p) / mm; };
    report.set("count", points.cols());
    report.set("overlap", n / points.cols()).set("max_distance", fit.cutoff / mm);
    report.set("mean", sum / n / mm).set("rms", std::sqrt(square / n) / mm).set("sigma", fit.sigma / mm);
    report.set("median", quantile(0.5)).set("p90", quantile(0.9)).set("p95", quantile(0.95)).set("max", quantile(1));
}

json::Value next_json(const Alignment& alignment, double mm)
{
    const IcpFit &best = alignment.fit, &next = *alignment.second_best;
    const Eigen::Isometry3d between = next.T_reference_scan * best.T_reference_scan.inverse();
    json::Value value;
    Eigen::Matrix4d transform = next.T_reference_scan.matrix();
    transform.topRightCorner<3, 1>() /= mm;
    value.set("transform", Eigen::MatrixXd(transform)); // --start of an alignment that shall end there
    value.set("turn_deg", Eigen::AngleAxisd(between.linear()).angle() * kDegreesPerRadian);
    value.set("shift", (between * alignment.frame.centre - alignment.frame.centre).norm() / mm);
    value.set("overlap", next.overlap).set("misfit", std::sqrt(next.misfit) / mm);
    return value.set("nearly_as_good", is_ambiguous(alignment));
}

} // namespace

bool is_ambiguous(const Alignment& alignment)
{
    if (!alignment.second_best) return false;
    const IcpFit &best = alignment.fit, &next = *alignment.second_best;
    // With a maximum distance most of the misfit is that of the points beyond it, in whichever pose: fewer points
    // within it are a worse fit, too.
    const bool overlaps_less = next.cutoff == best.cutoff && kMaxAmbiguousMisfitRatio * next.overlap < best.overlap;
    return next.misfit < kMaxAmbiguousMisfitRatio * best.misfit && !overlaps_less;
}

std::vector<std::string> doubts(const Alignment& alignment, const IcpOptions& options)
{
    // With fewer points a chance plane would fit; from here on the search finds the place.
    constexpr double kMinSureOverlap = 1.0 / 3;
    const bool applied = options.max_iterations == 0; // a given transform is not to converge
    std::vector<std::string> list;
    if (!alignment.fit.converged && !applied)
        list.emplace_back("the steps did not converge on a place where the scan lies on the reference");
    if (is_ambiguous(alignment)) list.emplace_back("another place fits nearly as well: see \"next\" in the report");
    const auto is_free = [](const MotionMode& mode) { return !mode.determined && !mode.held; };
    if (std::ranges::any_of(alignment.modes, is_free))
        list.emplace_back("not all of its motions are determined: see \"degrees_of_freedom\"");
    if (!options.overlap && alignment.fit.overlap < kMinSureOverlap)
        list.push_back("only " + core::to_short_text(std::round(1000 * alignment.fit.overlap) / 10) +
                       " % of its points lie on the reference");
    return list;
}

json::Value to_json(const Alignment& alignment, const Eigen::Matrix4d& matrix, const Eigen::Matrix3Xd& points,
                    const AlignReference& reference, const units::Units& units)
{
    const double mm = units.mm();
    json::Value report;
    report.set("kind", "alignment").set("units", json::to_json(units.length)).set("transform", Eigen::MatrixXd(matrix));
    report.set("converged", alignment.fit.converged).set("iterations", alignment.fit.iterations);
    set_residuals(report, alignment.fit, points, reference, mm);
    report.set("misfit", std::sqrt(alignment.fit.misfit) / mm);
    report.set("sd", sd_json(alignment, mm));
    const auto determined = std::count_if(alignment.modes.begin(), alignment.modes.end(),
                                          [](const MotionMode& mode) { return mode.determined && !mode.held; });
    report.set("determined", static_cast<int>(determined));
    report.set("centre", Eigen::VectorXd(alignment.frame.centre / mm)).set("radius", alignment.frame.radius / mm);
    report.set("degrees_of_freedom", modes_json(alignment, mm));
    if (alignment.second_best) report.set("next", next_json(alignment, mm));
    return report;
}

} // namespace fettle::align
