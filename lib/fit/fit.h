#pragma once

#include "job/job.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fettle {

/// What a surface is fitted to.
struct FitInput {
    Eigen::Matrix3Xd xyz;   ///< 3xN, mm, M; columns with NaN are dropped
    Eigen::VectorXi roles;  ///< N; see docs/conventions.md
    Eigen::VectorXi curves; ///< N, number of each touch's line; empty: unknown
    Job job;
    bool use_boundary = false;   ///< fit points of role 0, too (take_boundary)
    bool estimate_noise = false; ///< by the residuals, not by job.probe (noise_estimate.h)
    double noise_freedom = std::numeric_limits<double>::infinity(); ///< of job.probe's, where it is such an estimate
    std::optional<double> spacing;  ///< griddata: of its uniform sampling, mm; nothing: by the points' density
    std::string source = "touches"; ///< their name in messages
};

/// A fitted surface and how it came about.
struct Fit {
    Surface surface;
    Eigen::VectorXd residuals; ///< touch - surface at the same (x, y), one for each of surface.touches, mm;
                               ///< empty for a fit to more points than it keeps (dense.h)
    double freedom = 0;        ///< degrees of freedom of the residuals; 0: none are known
    bool converged = true;
    int iterations = 0;
};

/// The methods by name, "auto" not among them.
const std::vector<std::string>& fit_methods();

/// Appends the job's boundary points that have a z, as touches of role 0, and sets use_boundary: the operator touched
/// good metal there with the same probe. Points of role 0 that are there already stay the only ones.
/// @throws InputError if there are none at all
void take_boundary(FitInput& input);

/// Fits by a method's name; "auto": what explains the touches best (fit_auto() in selection.h).
/// @throws InputError if the touches do not determine such a surface
Fit fit_surface(const FitInput& input, const std::string& method);

// --- shared by the fits ----------------------------------------------------------------------------------------------

/// Standard deviation of a touch: 99 % of a normal error lie within the probe's accuracy, mm.
double touch_sigma(const Probe& probe);

/// Columns of the input that are finite and have a wanted role. Role 0 counts as wanted with use_boundary.
std::vector<Eigen::Index> usable_points(const FitInput& input, const std::vector<int>& wanted_roles);

/// A surface without shape and covariance: units, method, touch_sigma, and the touches that are usable; the
/// rest is counted in `ignored`.
/// @throws InputError for fewer than `least` touches
Surface begin_surface(const FitInput& input, const std::string& method, const std::vector<int>& wanted_roles,
                      int least);

/// Fills in residuals, rms and goodness. @param freedom  degrees of freedom of the residuals; 0: no goodness (NaN)
Fit finish_fit(Surface surface, double freedom, bool converged, int iterations);

/// Roles of touches on good metal that were not chosen as corners of B (docs/conventions.md, role).
inline const std::vector<int> kSampleRoles = {1, 2, 4, 5};

/// Huber's weight of a residual (1964): 1 within `width`, width/|r| beyond, so that an outlier pulls no more than a
/// touch at the edge of the probe's accuracy.
double huber_weight(double residual, double width);

} // namespace fettle
