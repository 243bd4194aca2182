#pragma once

#include "part/profile.h"
#include "json/document.h"

namespace fettle::part {

/// Reads one element of a part's "anomalies" (docs/formats.md). @param mm  mm per unit of the file
/// @throws InputError with the key's path
Anomaly read_anomaly(json::Reader reader, double mm);

} // namespace fettle::part
