#pragma once

#include "job/job.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fettle::fit {

/// The touches to fit a surface to, and the settings of the fit.
struct FitInput {
    Eigen::Matrix3Xd xyz;   ///< 3xN, mm, M; columns with NaN are dropped
    Eigen::VectorXi roles;  ///< N; see docs/conventions.md
    Eigen::VectorXi curves; ///< N, number of each touch's line; empty: unknown
    job::Job job;
    bool use_boundary = false;   ///< fit points of role 0, too (add_boundary_touches)
    bool estimate_noise = false; ///< estimate the noise by the residuals instead of job.probe (noise_estimate.h)
    /// Degrees of freedom of job.probe's accuracy, finite if it is such an estimate.
    double noise_freedom = std::numeric_limits<double>::infinity();
    std::optional<double> spacing;  ///< of griddata's uniform sampling, mm; nothing: from the points' density
    std::string source = "touches"; ///< name of the touches in messages
};

/// A fitted surface and statistics of the fit.
struct Fit {
    surface::Surface surface;
    Eigen::VectorXd residuals; ///< touch - surface at the same (x, y), one for each of surface.touches, mm;
                               ///< empty for a fit to more points than it keeps (dense.h)
    double freedom = 0;        ///< degrees of freedom of the residuals; 0: unknown
    bool converged = true;
    int iterations = 0;
};

/// The names of the methods, without "auto".
const std::vector<std::string>& fit_methods();

/// Appends the job's boundary points that have a z, as touches of role 0, and sets use_boundary: the operator touched
/// good metal there with the same probe. Nothing is appended if the input already has points of role 0.
/// @throws InputError if there are none of either
void add_boundary_touches(FitInput& input);

/// Fits by the method of a name, or by fit_auto() (selection.h) for "auto".
/// @throws InputError if the touches do not determine such a surface
Fit fit_surface(const FitInput& input, const std::string& method);

// --- shared by the fits ----------------------------------------------------------------------------------------------

/// Standard deviation of a touch, mm: 99 % of its normally distributed errors lie within the probe's accuracy.
double touch_sigma(const job::Probe& probe);

/// True for a wanted role, and for role 0 with use_boundary.
bool is_used_role(double role, const std::vector<int>& wanted_roles, bool use_boundary);

/// Indices of the input's columns that are finite and have a used role.
std::vector<Eigen::Index> usable_points(const FitInput& input, const std::vector<int>& wanted_roles);

/// A surface without shape and covariance: units, method, touch_sigma, and the touches that are usable; the
/// other points are counted in `ignored`.
/// @throws InputError for fewer than `min_touches` touches, or on a line in x and y (check_not_collinear(); not for the
///         method "plane")
surface::Surface begin_surface(const FitInput& input, const std::string& method, const std::vector<int>& wanted_roles,
                               int min_touches);

/// @throws InputError for touches on a line in x and y: across it they spread (rms) by no more than the probe's
///         accuracy, so a height beside the line would be extrapolated from their noise
void check_not_collinear(const FitInput& input, const Eigen::Matrix3Xd& touches);

/// Probability that χ² exceeds a value by chance; 1 without degrees of freedom, or if the value is not finite.
double chi2_p_value(double chi2, double freedom);

/// Fills in residuals, rms and goodness. @param freedom  degrees of freedom of the residuals; 0: no goodness (NaN)
Fit finish_fit(surface::Surface surface, double freedom, bool converged, int iterations);

/// Roles of touches on good metal that were not chosen as corners of B (docs/conventions.md, role).
inline const std::vector<int> kSampleRoles = {1, 2, 4, 5};
inline constexpr int kMaxRole = 5;

/// Huber's weight of a residual (1964): 1 within `width`, width/|r| beyond, so that an outlier has no more influence
/// than a touch at the limit of the probe's accuracy.
double huber_weight(double residual, double width);

} // namespace fettle::fit
