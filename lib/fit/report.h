#pragma once

namespace fettle::json {
class Value;
}

namespace fettle {

struct DenseFit;
struct Fit;

/// Adds the numbers about a fit, lengths in the unit of its surface's file.
void report(json::Value& out, const Fit& fit);
void report(json::Value& out, const DenseFit& dense);

} // namespace fettle
