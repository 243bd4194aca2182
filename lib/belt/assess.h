#pragma once

#include "belt/surfel.h"
#include "cloud/cloud.h"
#include "compare/statistics.h"
#include "json/document.h"

#include <Eigen/Core>

namespace fettle {

/// Displacements from `lower` to `upper` are right, mm (Ren et al. 2006, "Grinding error assessment").
struct ToleranceRange {
    double lower, upper;
};

enum class Assessment { gouge = -1, within = 0, undercut = 1 };
/// NaN must not be asked about.
Assessment assess(double displacement, const ToleranceRange& range);

/// What an assessment counts; surfels without displacement are in none of the classes.
struct AssessmentCounts {
    Eigen::Index gouge = 0, within = 0, undercut = 0, undefined = 0;
};
AssessmentCounts count(const Eigen::VectorXd& displacement, const ToleranceRange& range);

/// Adds error (the displacement), class (-1 gouge, 0 within, 1 undercut; NaN) and rgb: pale green within; beyond by up
/// to the range's width bright red or violet, further dark red or dark blue.
void set_assessment(Cloud& cloud, const Eigen::VectorXd& displacement, const ToleranceRange& range);

/// Of displacements as of errors, mm. Volumes are sums of displacement · area, as on a flat design; NaN, as areas,
/// where the surfels do not know their areas.
Statistics displacement_statistics(const Surfels& surfels);

/// The statistics, with "within" the share inside the range, and the counts.
json::Value to_json(const Surfels& surfels, const ToleranceRange& range);

} // namespace fettle
