#include "align/align.h"
#include "json/units.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace fettle {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
// Distances of one scan go together over patches, so that a mean square may be off by so much by chance.
constexpr double kNearlyAsGood = 1.25;
// A mode that is not determined moves an axis if it has more than this share of it; less is rounding.
constexpr double kSomeShare = 1e-3;

// Standard deviation along one axis of M, from all modes; infinite if one that moves it is not determined.
double axis_sd(const Alignment& alignment, Eigen::Index axis)
{
    double variance = 0;
    for (const Freedom& freedom : alignment.freedoms) {
        const double share = freedom.motion[axis];
        if (freedom.held) continue;
        if (freedom.determined)
            variance += std::pow(share * freedom.sd, 2);
        else if (std::abs(share) > kSomeShare)
            return std::numeric_limits<double>::infinity();
    }
    return std::sqrt(variance);
}

json::Value sd_json(const Alignment& alignment, double mm)
{
    json::Value sd;
    for (const Eigen::Index k : {0, 1, 2}) sd.set(std::string(1, "xyz"[k]), axis_sd(alignment, k) / mm);
    for (const Eigen::Index k : {0, 1, 2})
        sd.set(std::string("r") + "xyz"[k] + "_deg", axis_sd(alignment, 3 + k) / alignment.frame.radius * kDegrees);
    return sd;
}

json::Value freedoms_json(const Alignment& alignment, double mm)
{
    std::vector<json::Value> modes;
    for (const Freedom& freedom : alignment.freedoms) {
        json::Value mode;
        mode.set("shift", Eigen::VectorXd(freedom.motion.head<3>()));
        mode.set("turn", Eigen::VectorXd(freedom.motion.tail<3>()));
        if (freedom.held)
            mode.set("held", true);
        else
            mode.set("determined", freedom.determined).set("sd", freedom.sd / mm);
        modes.push_back(mode);
    }
    return modes;
}

void set_residuals(json::Value& report, const IcpFit& fit, const Eigen::Matrix3Xd& points,
                   const AlignReference& reference, double mm)
{
    const Distances d = distances(points, reference);
    std::vector<double> size;
    double sum = 0, square = 0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (!(d.closest[i] <= fit.cut)) continue;
        size.push_back(std::abs(d.across[i]));
        sum += d.across[i];
        square += d.across[i] * d.across[i];
    }
    std::sort(size.begin(), size.end());
    const auto n = static_cast<double>(size.size());
    const auto part = [&](double share) {
        return size.empty() ? std::numeric_limits<double>::quiet_NaN()
                            : size[static_cast<std::size_t>(share * (n - 1))] / mm;
    };
    report.set("count", static_cast<std::size_t>(points.cols()));
    report.set("overlap", n / static_cast<double>(points.cols())).set("max_distance", fit.cut / mm);
    report.set("mean", sum / n / mm).set("rms", std::sqrt(square / n) / mm).set("sigma", fit.sigma / mm);
    report.set("median", part(0.5)).set("p90", part(0.9)).set("p95", part(0.95)).set("max", part(1));
}

json::Value next_json(const Alignment& alignment, double mm)
{
    const IcpFit &best = alignment.fit, &next = *alignment.next;
    const Eigen::Isometry3d between = next.T_reference_scan * best.T_reference_scan.inverse();
    json::Value value;
    value.set("turn_deg", Eigen::AngleAxisd(between.linear()).angle() * kDegrees);
    value.set("shift", (between * alignment.frame.centre - alignment.frame.centre).norm() / mm);
    value.set("overlap", next.overlap).set("misfit", std::sqrt(next.misfit) / mm);
    return value.set("nearly_as_good", ambiguous(alignment));
}

} // namespace

bool ambiguous(const Alignment& alignment)
{
    return alignment.next && alignment.next->misfit < kNearlyAsGood * alignment.fit.misfit;
}

json::Value to_json(const Alignment& alignment, const Eigen::Matrix4d& matrix, const Eigen::Matrix3Xd& points,
                    const AlignReference& reference, const Units& units)
{
    const double mm = units.mm();
    json::Value report;
    report.set("kind", "alignment").set("units", json::to_json(units.length)).set("transform", Eigen::MatrixXd(matrix));
    report.set("converged", alignment.fit.converged).set("iterations", alignment.fit.iterations);
    set_residuals(report, alignment.fit, points, reference, mm);
    report.set("misfit", std::sqrt(alignment.fit.misfit) / mm);
    report.set("sd", sd_json(alignment, mm));
    const auto sure = std::count_if(alignment.freedoms.begin(), alignment.freedoms.end(),
                                    [](const Freedom& freedom) { return freedom.determined && !freedom.held; });
    report.set("determined", static_cast<int>(sure));
    report.set("centre", Eigen::VectorXd(alignment.frame.centre / mm)).set("radius", alignment.frame.radius / mm);
    report.set("degrees_of_freedom", freedoms_json(alignment, mm));
    if (alignment.next) report.set("next", next_json(alignment, mm));
    return report;
}

} // namespace fettle
