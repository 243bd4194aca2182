#pragma once

#include "cloud/cloud.h"
#include "job/job.h"
#include "report/html.h"
#include "report/run_files.h"

#include <optional>
#include <string>

/// The charts of a page, as drawings in SVG.
namespace fettle {

/// Where the judged errors lie between the tolerances: the whole range, the middle 98 %, the mean.
Html error_gauge(const Figures& judged, double tolerance, const std::string& unit);

/// How many errors lie where. @param limit  the bins are of equal width from -limit to limit; no fewer than one bin
/// @param tolerance  0: none
Html error_histogram(const std::vector<double>& counts, double limit, double below, double above, double tolerance,
                     const std::string& unit);

/// Force, layer and feed of a trace against the time, with what happened besides. @param job  for the force's bounds
Html trace_chart(const Cloud& trace, const std::optional<Job>& job, const Units& units);

/// B, S, touches and passes, from above and to scale; the run has a job.
struct Sketch {
    Html drawing;
    bool narrow = false; ///< as wide as half of the page
};
Sketch job_sketch(const RunFiles& run);

} // namespace fettle
