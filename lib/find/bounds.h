#pragma once

namespace fettle::find {

/// Bounds of what is looked for.
struct SearchBounds {
    double max_width = 45;  ///< of an anomaly, mm
    double max_area = 2500; ///< mm²
    double max_height = 15; ///< mm
};

/// The same in proportion, for anomalies up to another width, mm.
inline SearchBounds bounds_for_width(double width)
{
    SearchBounds bounds;
    const double ratio = width / bounds.max_width;
    return {ratio * bounds.max_width, ratio * ratio * bounds.max_area, ratio * bounds.max_height};
}

} // namespace fettle::find
