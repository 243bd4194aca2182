#pragma once

#include "find/ring_fit.h"
#include "find/verification.h"

#include <optional>

namespace fettle::find {

// Share of the ring's variance in the smoothed residual.
inline constexpr double kRingVariance = 0.35;
inline constexpr double kRingGap = 2; ///< the ring begins beyond the region's rounded foot, cells

inline constexpr double kStableOverlap = 0.97; ///< intersection over union of two regions that count as the same

/// Thickness of a region: the diameter of its largest inscribed circle, cells.
double thickness_of(const Mask& mask);

/// The surface beneath a region, from the ring around it.
struct Beneath {
    RingFit fit;
    Mask ring;
    cv::Rect reach; ///< the ring and the cells around it that smoothing needs: the images are valid in it
    Image distance; ///< from the region; large beyond the ring's reach
    double width;   ///< of the ring
    Image residual; ///< over the surface; NaN beyond
    Image smooth;   ///< smoothed residual; very low beyond, and where nothing is seen
    Image sd;       ///< of the surface
};

/// Refines one candidate within its window: fits the surface beneath, and segments the region that rises above it.
class Refinement {
  public:
    Refinement(const HeightMap& map, const Candidate& candidate, const Mask& others, const SearchBounds& bounds);

    /// The region without the rim that only smoothing has raised.
    Mask trimmed() const;

    /// Outcome of a step.
    enum class Progress {
        none,     ///< no region remains
        changed,  ///< it differs from the region before the step
        converged ///< it hardly differs from it
    };
    /// Fits the surface beneath the region, and segments the region again where the heights rise above it.
    Progress step();

    /// Widens the window if the region has grown to its edge. @return  whether it has
    bool widen(const HeightMap& map, const Mask& others);

    /// The region as a candidate in the map.
    Candidate region() const;
    /// Thickness of the region, cells.
    double thickness() const { return thickness_; }

    /// The verified candidate with the region of the last step.
    Verified result(double texture) const;

    /// Frees the memory of what step() computes again.
    void release() { beneath_ = {}; }

    /// The surface beneath, in the whole window.
    Image surface() const;

  private:
    /// @param box  around which the window has room for the ring
    void set_window(const HeightMap& map, const Mask& others, const cv::Rect& box);

    Mask ring_of(const Image& distance, double width) const;

    std::optional<RingFit> fit(const Mask& ring, const Image& distance, double width, int max_degree,
                               const CreaseSearch& creases) const;

    CreaseSearch creases(bool is_sought) const;

    bool fit_beneath();

    /// Sets the heights over the surface, and its standard deviation, which is smooth: it is computed at every few
    /// cells and interpolated.
    void evaluate();

    /// Heights over the surface in a box of the window; NaN where nothing is seen.
    Image residual_in(const cv::Rect& box) const;

    Mask region_over_surface() const;

    /// Components of a mask that hold a seed.
    static Mask connected_to(const Mask& mask, const Mask& seeds);

    /// The component with the largest volume over the surface.
    Mask largest(const Mask& mask) const;

    void measure_shell(Evidence& evidence) const;
    void measure_stability(Evidence& evidence) const;
    int growth() const;

    SearchBounds bounds_;
    double cell_, sigma_;
    cv::Rect window_;
    Image z_;
    Mask seen_, others_, region_, core_;
    Image seen_weight_; ///< smoothing_weight() of the seen cells
    double thickness_;
    Beneath beneath_;
    std::optional<Crease> crease_; ///< beneath the region
    int crease_searches_ = 0;
};

} // namespace fettle::find
