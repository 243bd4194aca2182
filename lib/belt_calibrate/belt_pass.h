#pragma once

#include "belt/belt_grinding.h"

#include <vector>

namespace fettle::belt_calibrate {

/// A law with another pressure exponent that is as fast at a pressure, MPa.
belt::BeltLaw with_pressure_exponent(belt::BeltLaw law, double exponent, double pressure);

/// Geometric mean of force over area of the points, MPa.
double mean_pressure(const std::vector<belt::BeltTrace>& trace);

/// Steps of the pressure exponent, and of the coefficient's logarithm, where a derivative by them is a difference of
/// two simulations.
inline constexpr double kExponentStep = 0.05, kLevelStep = 0.05;

/// A pass as a law expects it. Twice the coefficient takes less than twice as much, since the wheel comes to rest on
/// less: to the power of the sensitivity. Nor does a surfel's loss go with its pressure to the power of the pressure
/// exponent alone; but the derivative of the loss's logarithm by the exponent, over the sensitivity, is the logarithm
/// of the pressure to which the loss answers, whatever the contact's shape.
struct SimulatedPass {
    belt::BeltRun run;
    Eigen::VectorXd log_pressure, log_feed; ///< of each surfel, log MPa, log mm/s; NaN: it loses next to nothing
    Eigen::VectorXd sensitivity;            ///< of each surfel's loss, 0 to 1
    double pressure = 0, feed = 0, pass_sensitivity = 1; ///< of all that is lost
};

/// Simulates a pass three times: by the law, with a stepped coefficient, and with a stepped pressure exponent.
/// @param surfels  before the pass   @param grid  of the contact before; no rows: it is not known
/// @throws InputError as belt::BeltGrinding::step()
SimulatedPass simulate_pass(const belt::Surfels& surfels, const belt::ContactWheel& wheel,
                            const std::vector<belt::BeltPoint>& points, belt::BeltOptions options,
                            const belt::ContactGrid& grid);

/// What was lost at like pressures and feeds.
struct PassPart {
    double pressure, feed; ///< MPa, mm/s
    double ratio;          ///< of the coefficient by which that much is lost to the simulation's
};
/// Divides a pass into parts whose pressures and feeds differ by a tenth, as far as they take a share of it that says
/// something. Where all are alike there is none.
/// @param lost  by each surfel, mm; NaN: it was not measured
std::vector<PassPart> divide_pass(const SimulatedPass& pass, const Eigen::VectorXd& lost);

} // namespace fettle::belt_calibrate
