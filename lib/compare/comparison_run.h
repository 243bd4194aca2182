#pragma once

#include "cloud/cloud_writer.h"
#include "compare/comparison.h"
#include "core/progress.h"
#include "units/units.h"
#include "json/document.h"

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace fettle::compare {

/// A comparison of two files, each a mesh or a cloud. Lengths are in the unit of the run: the job's, without a job that
/// of the test's file.
struct ComparisonRequest {
    std::string test, reference;                                 ///< paths; "-": stdin
    std::optional<units::Units::Length> test_unit;               ///< nothing: the job's, else as the file says
    std::optional<units::Units::Length> reference_unit;          ///< nothing: the same
    std::optional<double> tolerance;                             ///< nothing: the job's
    std::optional<double> max_distance;                          ///< beyond it the error is undefined
    cloud::CloudFormat format = cloud::CloudFormat::pcd;         ///< of the error map
    cloud::CloudFormat reverse_format = cloud::CloudFormat::pcd; ///< of the reverse one
    std::optional<units::Units::Length> output_unit;             ///< of maps and report, instead of the job's
    ComparisonOptions options;                                   ///< except for the tolerance and the maximum distance
};

struct ComparisonRun {
    std::vector<Comparison> comparisons; ///< of the test's points, then the reverse one
    units::Units units;                  ///< of the run
    json::Value report;
    std::vector<std::string> warnings;
    bool conforms = true; ///< false: out of tolerance, or no point has an error
};

/// Compares a test to its reference. A binary PCD of test points is streamed.
/// @param out  receives the error map
/// @param reverse_out  receives that of the reference's points against the test; null: it is not made
/// @param progress  makes a display for each of the two
/// @throws InputError as read_shape() and open_test_points()
ComparisonRun compare_files(const ComparisonRequest& request, std::ostream& out, std::ostream* reverse_out,
                            const std::function<core::Progress()>& progress);

} // namespace fettle::compare
