#pragma once

#include "part/profile.h"
#include "json/document.h"

namespace fettle {

/// One element of a part's "anomalies" (docs/formats.md). @param mm  in one unit of the file   @throws InputError
Anomaly read_anomaly(json::Reader reader, double mm);

} // namespace fettle
