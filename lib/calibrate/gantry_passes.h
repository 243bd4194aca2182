#pragma once

#include "job/job.h"
#include "removal/height_field.h"
#include "removal/removal_fit.h"
#include "strategy/run.h"

#include <optional>
#include <vector>

namespace fettle::calibrate {

/// A measured number with its standard deviation.
struct Measured {
    double value = 0, sigma = 0;
};

/// What was ground off between two measurements of the wheel, mm³.
struct WearInterval {
    double removed = 0; ///< of the stock
    double lost = 0;    ///< of the wheel
};

/// What the machine's own records and the stock before and after say, beside the passes.
struct GantryLaw {
    /// A pass is some consecutive strokes of the wheel: mean force; the volume of a second of contact, since volumes
    /// add up along a stroke; the prior work is ∫F dt of the passes before.
    std::vector<removal::RemovalTrial> passes;
    double pass_work = 0;                ///< ∫F dt of a pass, about, N s
    std::optional<Measured> coefficient; ///< Preston's: volume per ∫F dt, mm³/(N s)
    /// Ratio of the tangential to the normal force; none where the slopes that were ground do not tell, and the force
    /// is taken for that on a horizontal rim.
    std::optional<Measured> tangential;
    std::optional<Measured> preload, stiffness; ///< of the spring: N, N/mm; none if the deflection was always the same
    /// Volume of stock per volume of wheel, from the radii that were measured; none if less than two intervals between
    /// measurements ground anything.
    std::optional<Measured> grinding_ratio;
    std::vector<WearInterval> wear; ///< between two measurements of the wheel
    /// The machine's yielding, mm/N: by how much more the stock stands over the wheel's recorded places where it was
    /// ground with more force. None without the stock after.
    std::optional<Measured> compliance;
    double height_offset = 0; ///< mean of stock minus recorded place, mm: of the touch-offs and the wear since
    double height_error = 0;  ///< standard deviation of what offset and yielding leave, mm
    Eigen::Index cells = 0;   ///< ground cells that were compared
};

/// Volume that the wheel lost per volume of stock, by least squares; none of less than two intervals.
std::optional<Measured> fit_wear(const std::vector<WearInterval>& intervals);

/// Measures a gantry from the trace of a run. The volumes are those of replay(), and where the force is found to
/// be normal to the rim those that its vertical part explains. The coefficient is the median over the strokes of volume
/// over ∫F dt, weighted with that.
/// @param after  on the grid of `before`
/// @throws InputError if the wheel ground nothing of the stock after; without that, there are no passes then
GantryLaw measure_gantry(const std::vector<strategy::TraceRow>& trace, const job::Job& job,
                         const removal::HeightField& before, const std::optional<removal::HeightField>& after);

} // namespace fettle::calibrate
