#pragma once

#include "cloud/cloud.h"
#include "compare/form.h"
#include "job/job.h"
#include "units/units.h"
#include "json/document.h"

#include <cstddef>
#include <optional>

namespace fettle::compare {

/// Sections in which straightness is measured; see vertical_sections().
struct SectionGrid {
    double spacing, width; ///< mm
    double direction;      ///< rad
};

struct FormRequest {
    FormKind kind = FormKind::flatness;
    std::optional<job::Job> job;         ///< only points inside its anomaly's boundary
    std::optional<double> outlier_limit; ///< as without_outliers(), robust standard deviations; nothing: all points
    std::optional<SectionGrid> sections; ///< straightness; nothing: of all points as one line
};

struct FormRun {
    json::Value report;      ///< that of the form; of sections: that of the worst one, and a row for each of them
    std::size_t dropped = 0; ///< points with NaN coordinates
};

/// Measures the form of points.
/// @param units  of the report
/// @throws InputError as evaluate_form(), or if no section has three points
FormRun measure_form(const cloud::Cloud& points, const FormRequest& request, const units::Units& units);

} // namespace fettle::compare
