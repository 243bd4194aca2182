#pragma once

#include "removal/removal_fit.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace fettle::calibrate {

/// Parameters of a removal law, in the order of all vectors and matrices here. With the conditions of a reference pass
/// (subscript 0) the logarithm of a pass's volume is
///     log V = level + force log(F/F_0) + speed log(V_b/V_b0) + feed log(V_w/V_w0) + duration log(t/t_0) - wear W/W_0.
enum Parameter : Eigen::Index { level, force, speed, feed, duration, wear, parameter_count };
inline constexpr std::array<const char*, parameter_count> kParameterNames = {"level", "force",    "speed",
                                                                             "feed",  "duration", "wear"};

using Parameters = Eigen::Matrix<double, parameter_count, 1>;
using ParameterMatrix = Eigen::Matrix<double, parameter_count, parameter_count>;

/// A condition of a pass that the volume depends on.
struct Factor {
    Parameter parameter; ///< its exponent
    double removal::RemovalTrial::*value;
    double preston_exponent;
};
inline constexpr Factor kFactors[] = {{force, &removal::RemovalTrial::force, 1},
                                      {speed, &removal::RemovalTrial::speed, 1},
                                      {feed, &removal::RemovalTrial::feed, -1},
                                      {duration, &removal::RemovalTrial::duration, 1}};

/// One of the models that are averaged. Its parameters have a normal distribution, which a Kalman filter updates.
struct LawModel {
    std::array<bool, parameter_count> is_free{}; ///< the other exponents are Preston's
    double scatter = 0;                          ///< standard deviation of a pass's log volume
    double drift = 0;             ///< standard deviation of the change of the level from pass to pass, besides the wear
    bool has_heavy_tails = false; ///< the scatter is Student's t with 4 degrees of freedom, otherwise normal
    double log_score = 0;         ///< log prior plus the log predictive densities of the passes
    Parameters mean = Parameters::Zero();
    ParameterMatrix covariance = ParameterMatrix::Zero();
};

/// Prediction of a pass's volume, or the judgement of a pass that was measured.
struct Prediction {
    double volume = 0;           ///< median, mm³
    double lower = 0, upper = 0; ///< of the interval, mm³
    double tail_probability = 1; ///< two-sided, of the measured volume; 1 if there is none
    double volume_share = 0.5;   ///< probability of a smaller volume than the measured one
};

/// Mean and covariance of the mixture of the models.
struct Posterior {
    Parameters mean = Parameters::Zero();
    ParameterMatrix covariance = ParameterMatrix::Zero();
    double scatter = 0, drift = 0; ///< means of the models'
    double heavy_tails = 0;        ///< probability
};

/// What is known of a removal law after some passes. Dynamic linear models in the logarithm of the volume run in
/// parallel and are averaged by their predictive scores (West & Harrison 1997, 4 and 12). Before the first pass the
/// exponents are those of Preston's law, give or take 1 (force, speed) or 0.3 (feed, duration), the level falls by
/// 1/300 in a pass, give or take half of that, and nothing else is known of it. A model with heavy tails weights an
/// observation by (ν + 1) / (ν + e²/Q) (Meinhold & Singpurwalla 1989). A belief is a function of its passes and their
/// order alone.
class LawBelief {
  public:
    /// @param reference  conditions of the reference pass; what is NaN in it was not recorded, and is ignored in all
    /// @param pass_work  work of a typical pass W_0, in the unit of the passes' prior work
    /// @throws InputError for a value that is not positive
    LawBelief(const removal::RemovalTrial& reference, double pass_work);

    /// Predicts the volume of a pass under its conditions, and judges its volume if that is positive.
    /// @param probability  of the interval
    Prediction predict(const removal::RemovalTrial& next, double probability = 0.95) const;
    /// Learns from a pass. @throws InputError for a value that is not positive
    void update(const removal::RemovalTrial& pass) { update(std::vector{pass}); }
    /// Learns from a pass of parts under different conditions, between which the level does not wander.
    void update(const std::vector<removal::RemovalTrial>& parts);
    /// The level may have changed by a factor of 2 or so, with a new belt, or a wheel that went blunt; what is known of
    /// the exponents is kept.
    void loosen_level();

    Posterior posterior() const;
    /// Variance of the log volume under these conditions over that of a single pass's scatter: how much the pass would
    /// tell.
    double information(const removal::RemovalTrial& next) const;
    /// Shares of the models, which sum up to 1.
    Eigen::VectorXd weights() const;
    const std::vector<LawModel>& models() const { return models_; }
    const removal::RemovalTrial& reference() const { return reference_; }
    double pass_work() const { return pass_work_; }

    /// Derivatives of the log volume by the parameters.
    Parameters regressors(const removal::RemovalTrial& trial) const;

  private:
    void observe(const removal::RemovalTrial& part);

    removal::RemovalTrial reference_;
    double pass_work_;
    std::vector<LawModel> models_;
};

/// Exponents of Preston's law; 0 for level and wear.
Parameters preston_exponents();

/// True if a pass of the reference's kind records the parameter's factor.
bool is_recorded(const removal::RemovalTrial& reference, Parameter parameter);

} // namespace fettle::calibrate
