#pragma once

namespace fettle::find {

/// Bounds of what is looked for.
struct SearchBounds {
    double max_width = 45;   ///< of an anomaly, mm
    double max_area = 2500;  ///< mm²
    double max_height = 15;  ///< mm
};

} // namespace fettle::find
