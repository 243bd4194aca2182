#pragma once

#include "job/job.h"
#include "json/document.h"

#include <string>
#include <vector>

namespace fettle::fit {

struct DenseFit;
struct Fit;

/// Adds a fit's statistics to a JSON report, lengths in the unit of the surface's file.
void report(json::Value& out, const Fit& fit);
void report(json::Value& out, const DenseFit& dense);

/// A warning if the points of a scan scatter about the surface by more than the probe's accuracy, as those of two
/// layers do: the surface then lies somewhere between them.
std::vector<std::string> warnings(const DenseFit& dense, const job::Job& job, const std::string& source);

/// Warnings for the operator: one for each touch that was left out as an outlier, and one if the touches lie farther
/// off the surface than the probe's accuracy explains although no touch is an outlier. Lengths in the job's unit.
/// @param source  name of the touches
std::vector<std::string> warnings(const Fit& fit, const std::string& source);

} // namespace fettle::fit
