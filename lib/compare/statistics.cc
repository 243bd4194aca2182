#include "compare/statistics.h"

#include "job/boundary.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double percentile(const std::vector<double>& ascending, double p)
{
    const double place = static_cast<double>(ascending.size() - 1) * p;
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, ascending.size() - 1);
    return ascending[below] + (place - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

void set_moments(Statistics& s, const std::vector<double>& ascending)
{
    const auto n = static_cast<double>(ascending.size());
    double sum = 0, sum_abs = 0, sum_square = 0, sum_deviation = 0;
    for (const double error : ascending) {
        sum += error;
        sum_abs += std::abs(error);
        sum_square += error * error;
    }
    s.mean = sum / n;
    for (const double error : ascending) sum_deviation += (error - s.mean) * (error - s.mean);
    s.mean_abs = sum_abs / n;
    s.rms = std::sqrt(sum_square / n);
    s.sd = std::sqrt(sum_deviation / n);
}

void set_order(Statistics& s, const std::vector<double>& ascending)
{
    s.min = ascending.front();
    s.max = ascending.back();
    s.band = s.min < 0 && s.max > 0 ? s.max - s.min : std::max(std::abs(s.min), std::abs(s.max));
    s.p01 = percentile(ascending, 0.01);
    s.p05 = percentile(ascending, 0.05);
    s.p50 = percentile(ascending, 0.50);
    s.p95 = percentile(ascending, 0.95);
    s.p99 = percentile(ascending, 0.99);
}

// Sorted, the sums come in one order whatever the order of the points: a region turned or shuffled tells the same.
std::vector<double> defined_ascending(const Eigen::VectorXd& errors)
{
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(errors.size()));
    for (const double error : errors)
        if (!std::isnan(error)) values.push_back(error);
    std::sort(values.begin(), values.end());
    return values;
}

} // namespace

Statistics statistics(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, std::optional<double> tolerance)
{
    Statistics s;
    const std::vector<double> ascending = defined_ascending(errors);
    s.count = static_cast<Eigen::Index>(ascending.size());
    s.undefined = errors.size() - s.count;
    s.mean = s.mean_abs = s.rms = s.sd = s.min = s.max = s.band = kNaN;
    s.p01 = s.p05 = s.p50 = s.p95 = s.p99 = s.within = kNaN;
    s.over_cut_volume = s.under_cut_volume = 0;
    if (ascending.empty()) return s;
    set_moments(s, ascending);
    set_order(s, ascending);
    if (tolerance) {
        const auto first = std::lower_bound(ascending.begin(), ascending.end(), -*tolerance);
        const auto last = std::upper_bound(ascending.begin(), ascending.end(), *tolerance);
        s.within = static_cast<double>(last - first) / static_cast<double>(ascending.size());
    }
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
        const double volume = errors[i] * areas[i];
        if (volume < 0) s.over_cut_volume -= volume;
        if (volume > 0) s.under_cut_volume += volume;
    }
    return s;
}

std::vector<Region> regions(const Job& job, const Eigen::Matrix3Xd& xyz)
{
    const Boundaries polygons = boundaries(job);
    const Eigen::Matrix2d R_working_machine = rotation_working_machine(job.theta);
    std::vector<Region> regions(static_cast<std::size_t>(xyz.cols()), Region::outside);
    tbb::parallel_for(Eigen::Index{0}, xyz.cols(), [&](Eigen::Index i) {
        if (!xyz.col(i).allFinite()) return;
        const Eigen::Vector2d point = R_working_machine * xyz.col(i).head<2>();
        Region& region = regions[static_cast<std::size_t>(i)];
        if (contains(polygons.anomaly, point))
            region = Region::inside;
        else if (polygons.sampling.cols() > 0 && contains(polygons.sampling, point))
            region = Region::around;
    });
    return regions;
}

Statistics statistics(const Eigen::VectorXd& errors, const Eigen::VectorXd& areas, std::optional<double> tolerance,
                      const std::vector<Region>& regions, Region which)
{
    std::vector<Eigen::Index> chosen;
    for (std::size_t i = 0; i < regions.size(); ++i)
        if (regions[i] == which) chosen.push_back(static_cast<Eigen::Index>(i));
    return statistics(errors(chosen), areas(chosen), tolerance);
}

Judgement judge(const Statistics& judged, double tolerance, const Eigen::Matrix3Xd& xyz)
{
    if (judged.count == 0) return {false, kNaN};
    const double largest = (xyz.array().isFinite()).select(xyz.array().abs(), 0).maxCoeff();
    const double rounding = static_cast<double>(std::numeric_limits<float>::epsilon()) * largest; // half of it a file
    const double worst = std::max(std::abs(judged.min), std::abs(judged.max));
    return {worst <= tolerance + rounding, worst};
}

double median(const Eigen::VectorXd& values)
{
    const std::vector<double> ascending = defined_ascending(values);
    return ascending.empty() ? kNaN : percentile(ascending, 0.5);
}

json::Value to_json(const Statistics& s, const Units& units)
{
    const double mm = units.mm();
    const double mm3 = mm * mm * mm;
    json::Value value;
    value.set("count", static_cast<std::size_t>(s.count)).set("undefined", static_cast<std::size_t>(s.undefined));
    value.set("mean", s.mean / mm).set("mean_abs", s.mean_abs / mm).set("rms", s.rms / mm).set("sd", s.sd / mm);
    value.set("min", s.min / mm).set("max", s.max / mm).set("band", s.band / mm);
    value.set("p01", s.p01 / mm).set("p05", s.p05 / mm).set("p50", s.p50 / mm);
    value.set("p95", s.p95 / mm).set("p99", s.p99 / mm).set("within", s.within);
    value.set("over_cut_volume", s.over_cut_volume / mm3).set("under_cut_volume", s.under_cut_volume / mm3);
    return value;
}

} // namespace fettle
