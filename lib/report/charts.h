#pragma once

#include "cloud/cloud.h"
#include "draw/html.h"
#include "job/job.h"
#include "report/run_files.h"

#include <optional>
#include <string>

/// Charts of a report page, as SVG drawings.
namespace fettle::report {

/// Range, 1st to 99th percentile and mean of the judged errors relative to the tolerance. @param unit  for the labels
draw::Html error_gauge(const NamedNumbers& judged, double tolerance, const std::string& unit);

/// Histogram of the errors.
/// @param counts  of bins of equal width from -limit to limit, at least one   @param below, above  counts beyond them
/// @param tolerance  0: none
draw::Html error_histogram(const std::vector<double>& counts, double limit, double below, double above,
                           double tolerance, const std::string& unit);

/// Force, layer and feed of a trace over time, with the events. @param job  gives the force limits
draw::Html trace_chart(const cloud::Cloud& trace, const std::optional<job::Job>& job, const units::Units& units);

struct Sketch {
    draw::Html drawing;
    bool narrow = false; ///< half as wide as the page
};
/// The boundaries B and S, the touches and the passes in plan view, to scale. The run must have a job.
Sketch job_sketch(const RunFiles& run);

} // namespace fettle::report
