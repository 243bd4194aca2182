#pragma once

#include "compare/signed_distance.h"
#include "compare/survey.h"
#include "compare/test_points.h"
#include "core/progress.h"
#include "draw/colours.h"
#include "geometry/statistics.h"
#include "job/job.h"
#include "job/region.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fettle::compare {

struct ComparisonOptions {
    DistanceOptions distance;        ///< with which the reference was made
    std::optional<double> tolerance; ///< mm
    std::optional<job::Job> job;     ///< whose regions get statistics of their own
    int bins = 50;                   ///< of the histogram
    bool reversed = false;           ///< the test is the reference of the part: the sign of the error is reversed
    bool with_foot = false;          ///< adds fields foot_x foot_y foot_z
    bool with_facet = false;         ///< adds field facet: number in the reference's file, -1: none
    bool with_region = false;        ///< adds field region: as Region; needs a job
    bool with_sigma = false;         ///< adds field sigma: of the reference, if it is a cloud
    std::size_t max_memory = std::size_t{1} << 30; ///< bytes of points and errors to hold in memory
};

/// Statistics of an error map.
struct Comparison {
    geometry::Statistics all;
    std::vector<std::pair<std::string, geometry::Statistics>> regions; ///< inside, around, outside; empty without a job
    geometry::Histogram histogram;
    double reference_sigma;  ///< median, mm; NaN for a mesh
    Eigen::AlignedBox3d box; ///< around the finite points, mm

    /// Largest |coordinate| of the points, mm, if there are any.
    double max_coordinate() const { return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff(); }

    /// Statistics for the verdict: of the points inside the anomaly's boundary, or of all points without a job.
    const geometry::Statistics& verdict_statistics() const { return regions.empty() ? all : regions.front().second; }
};

/// Starts the survey of all points that compare() needs. @param test  must outlive the survey
Survey start_survey(const TestPoints& test, const ComparisonOptions& options);

/// Compares points to a reference block by block, so that neither points nor error map are held in memory.
/// @param survey  started with the same points and options
/// @param use  receives the blocks in order, as clouds of the test's fields, the reference's normal, error, the fields
/// that the options add, and rgb
Comparison compare(const TestPoints& test, Survey& survey, const Reference& reference, const ComparisonOptions& options,
                   const std::function<void(const cloud::Cloud&)>& use, const core::Progress& progress = {});

} // namespace fettle::compare
