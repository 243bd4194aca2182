#pragma once

#include "belt/contact_path.h"
#include "cloud/cloud.h"
#include "json/document.h"

namespace fettle::belt {

/// A point with pose and field pass for each contact point; part frame.
cloud::Cloud to_cloud(const ContactPath& path);

/// The report of fettle-path: numbers of points and passes; length, longest step and largest turn within passes.
/// @param path  with poses; all points are of one pass if there is no field pass
json::Value report_path(const cloud::Cloud& path);

} // namespace fettle::belt
