#pragma once

#include "belt/belt_grinding.h"
#include "calibrate/law_record.h"
#include "cloud/cloud.h"
#include "core/progress.h"
#include "removal/removal_fit.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::belt_calibrate {

/// The trial of a belt's pass as its wheel's law expects it. It is one of a square millimetre of contact, whose force
/// in N is the pressure in MPa: its volume is that of a millimetre of way, over pressure and feed to the powers by
/// which the base's exponents differ from Preston's. Measured, that is multiplied by the measured over the simulated
/// volume of the pass. So a law whose exponents are the base's has Preston's in its trials, wherever on the part the
/// wheel is, and a trial does not change with the law by which it was simulated.
/// @param pressure  at which the pass removed, MPa   @param feed  mm/s   @param prior_work  of the belt, N mm
removal::RemovalTrial expected_trial(const belt::ContactWheel& wheel, const calibrate::TrialBase& base, double pressure,
                                     double feed, double prior_work);

/// What a run of a belt says of its wheel's law.
struct BeltRunLaw {
    belt::BeltLaw law; ///< as given, with coefficient, pressure exponent and, if the feed varied, its exponent
    /// Names, means and covariance of what was fitted: level, the logarithm of the depth per second at the reference
    /// pressure and feed; pressure; feed.
    std::vector<std::string> names;
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    double reference_pressure = 0, reference_feed = 0; ///< MPa, mm/s
    double depth_error = 0;                            ///< standard deviation of measured minus fitted depth, mm
    Eigen::Index surfels = 0;                          ///< that were compared
    /// A trial (expected_trial), relative to the exponents that were given, for each run of the path that has a length.
    /// Measured depths are shared among the passes as the fitted law shares them.
    std::vector<removal::RemovalTrial> passes;
    double pass_work = 0; ///< mean work of a pass, N mm
};

/// Fits the law of a wheel to the depths that surfels lost on a path: Gauss-Newton with differences of simulations
/// (belt::grind), prior standard deviations as in LawBelief, and Tukey's weights against outliers.
/// @param trace  of fettle-belt: poses with the fields t and force
/// @param wheel  whose law is the first guess
/// @param before, after  the same surfels
/// @throws InputError if the surfels are not the same, a field is missing, or nothing was removed
BeltRunLaw measure_belt(const cloud::Cloud& trace, const belt::ContactWheel& wheel, const belt::Surfels& before,
                        const belt::Surfels& after, const core::Progress& progress = {});

} // namespace fettle::belt_calibrate
