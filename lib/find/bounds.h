#pragma once

namespace fettle::find {

/// Bounds on the anomalies that are searched for.
struct SearchBounds {
    double max_width = 45;   ///< of an anomaly, mm
    double max_area = 2500;  ///< mm²
    double max_height = 15;  ///< mm
    double min_height = 0.2; ///< mm: less is texture of castings, and no work for a wheel
};

/// The default bounds, scaled to anomalies up to another width, mm.
inline SearchBounds bounds_for_width(double width)
{
    SearchBounds bounds;
    const double ratio = width / bounds.max_width;
    return {ratio * bounds.max_width, ratio * ratio * bounds.max_area, ratio * bounds.max_height, bounds.min_height};
}

} // namespace fettle::find
