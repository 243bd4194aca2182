#pragma once

#include "belt/surfel.h"
#include "cloud/cloud.h"
#include "geometry/statistics.h"
#include "json/document.h"

#include <Eigen/Core>

namespace fettle::belt {

/// Displacements from `lower` to `upper` are in tolerance, mm (Ren et al. 2006, "Grinding error assessment").
struct ToleranceRange {
    double lower, upper;
};

enum class Assessment { gouge = -1, within = 0, undercut = 1 };
/// @param displacement  mm; not NaN
Assessment assess(double displacement, const ToleranceRange& range);

/// Surfels by class; `undefined` counts those without a displacement (NaN), which belong to no class.
struct AssessmentCounts {
    Eigen::Index gouge = 0, within = 0, undercut = 0, undefined = 0;

    Eigen::Index& operator[](Assessment found)
    {
        return found == Assessment::gouge ? gouge : found == Assessment::undercut ? undercut : within;
    }
};
AssessmentCounts count_assessments(const Eigen::VectorXd& displacement, const ToleranceRange& range);

/// Adds the fields error (the displacement), class (-1 gouge, 0 within, 1 undercut; NaN without displacement) and rgb:
/// pale green within the range, bright red or violet outside it by up to its width, dark red or dark blue further out.
void set_assessment(cloud::Cloud& cloud, const Eigen::VectorXd& displacement, const ToleranceRange& range);

/// Statistics of the displacements taken as errors, mm. Volumes are sums of displacement · area, which is exact on a
/// flat design. Areas and volumes are NaN if the surfels have no areas.
geometry::Statistics displacement_statistics(const Surfels& surfels);

/// JSON report of the statistics, with "within" the share inside the range, and the counts by class.
json::Value to_json(const Surfels& surfels, const ToleranceRange& range);

} // namespace fettle::belt
