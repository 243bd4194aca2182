#pragma once

#include "compare/colours.h"
#include "compare/signed_distance.h"
#include "compare/statistics.h"
#include "compare/survey.h"
#include "compare/test_points.h"
#include "core/progress.h"
#include "job/job.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fettle {

struct ComparisonOptions {
    DistanceOptions distance;        ///< that the reference was made with
    std::optional<double> tolerance; ///< mm
    std::optional<Job> job;          ///< whose regions are told apart
    int bins = 50;                   ///< of the histogram
    bool reversed = false;           ///< is the reference's part compared to the test? Then + and - change places
    bool foot = false;               ///< fields foot_x foot_y foot_z
    bool facet = false;              ///< field facet: number in the reference's file, -1: none
    bool region = false;             ///< field region: as Region; needs a job
    bool sigma = false;              ///< field sigma: of the reference, if it is a cloud
    std::size_t memory = std::size_t{1} << 30; ///< bytes of points and errors that may be held
};

/// An error map in numbers.
struct Comparison {
    Statistics all;
    std::vector<std::pair<std::string, Statistics>> regions; ///< inside, around, outside; empty without a job
    Histogram histogram;
    double reference_sigma; ///< median, mm; NaN for a mesh
    double largest = 0;     ///< coordinate of the points, mm

    /// What a verdict rests on: inside the anomaly's boundary, if there is a job.
    const Statistics& judged() const { return regions.empty() ? all : regions.front().second; }
};

/// Begins to find out what compare() must know of all points. @param test  must outlive it
Survey survey(const TestPoints& test, const ComparisonOptions& options);

/// Compares points to a reference, block by block: neither points nor map are held.
/// @param survey  of the points, with the same options
/// @param use  gets the blocks in their order: the test's fields, the reference's normal, error, what else is wanted,
/// rgb
Comparison compare(const TestPoints& test, Survey& survey, const Reference& reference, const ComparisonOptions& options,
                   const std::function<void(const Cloud&)>& use, const Progress& progress = {});

} // namespace fettle
