#include "report/verdict.h"

#include "job/region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle::report {

OverCut split_over_cut(const Eigen::VectorXd& errors, const Eigen::VectorXd& removed, double rounding)
{
    OverCut result;
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
        if (!std::isfinite(errors[i])) continue;
        ++result.points;
        result.left = std::max(result.left, errors[i]);
        if (errors[i] >= 0) continue;
        const double depth = -errors[i], cut = std::isfinite(removed[i]) ? std::max(removed[i], 0.0) : depth;
        result.by_wheel = std::max(result.by_wheel, std::min(depth, cut));
        if (depth <= cut + rounding) continue;
        result.lacked = std::max(result.lacked, depth - cut);
        ++result.lacking_points;
    }
    return result;
}

namespace {

/// Rounding of an error between two files, whose coordinates are floats: half a unit in the last place for each.
double file_rounding(const cloud::Cloud& errors, const units::Units& units)
{
    double max_coordinate = 0;
    for (const double x : errors.xyz.reshaped())
        if (std::isfinite(x)) max_coordinate = std::max(max_coordinate, std::abs(x) / units.mm());
    return double(std::numeric_limits<float>::epsilon()) * max_coordinate;
}

/// That of the judged region; nothing if the error map does not know what was removed.
std::optional<OverCut> over_cut_of(const RunFiles& run)
{
    if (!run.errors || !run.comparison || !cloud::has_field(*run.errors, "removed")) return std::nullopt;
    Eigen::VectorXd errors = cloud::field(*run.errors, "error");
    if (run.comparison->judged == "inside") {
        if (!run.job) return std::nullopt;
        const std::vector<job::Region> regions = job::classify_regions(*run.job, run.errors->xyz);
        for (Eigen::Index i = 0; i < errors.size(); ++i)
            if (regions[std::size_t(i)] != job::Region::inside) errors[i] = std::nan("");
    }
    const double mm = run.units.mm();
    return split_over_cut(errors / mm, cloud::field(*run.errors, "removed") / mm,
                          file_rounding(*run.errors, run.units));
}

} // namespace

PageVerdict judge_page(const RunFiles& run)
{
    PageVerdict verdict;
    if (!run.comparison) return verdict;
    verdict.over_cut = over_cut_of(run);
    const ComparisonReport& c = *run.comparison;
    if (c.judged.empty()) return verdict;
    verdict.is_judged = true;
    verdict.tolerance = c.tolerance;
    verdict.worst = c.worst;
    verdict.within = c.within && std::isfinite(c.worst) && c.region(c.judged).at("count") > 0;
    // The errors of the reversed comparison are not in the error map.
    verdict.by_wheel = !run.judges_all && !c.reversed && verdict.over_cut && verdict.over_cut->lacking_points > 0;
    if (!verdict.by_wheel) return verdict;
    verdict.worst = std::max(verdict.over_cut->by_wheel, verdict.over_cut->left);
    verdict.within = verdict.worst <= c.tolerance + file_rounding(*run.errors, run.units); // as fettle-compare judges
    return verdict;
}

} // namespace fettle::report
