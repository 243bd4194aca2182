#pragma once

#include "fit/dense.h"
#include "fit/fit.h"
#include "json/document.h"

namespace fettle {

/// Adds the numbers about a fit, lengths in the unit of its surface's file.
void report(json::Value& out, const Fit& fit);
void report(json::Value& out, const DenseFit& dense);

} // namespace fettle
