#pragma once

#include <Eigen/Core>

#include <optional>

/// What the files of RingFit share: the points of a ring, scaled, and linear least squares on them.
namespace fettle::find {

inline constexpr std::size_t kHighestDegree = 4;
inline constexpr Eigen::Index kMaxTerms = 15;   ///< of a polynomial of that degree
inline constexpr Eigen::Index kCreaseTerms = 3; ///< of a crease, after the polynomial's
inline constexpr double kRingStartCutoff = 5;   ///< Tukey's, of the weights to start from, standard deviations
inline constexpr double kMinRingSigmas = 0.5;   ///< a residual spread below half the noise is chance
inline constexpr double kMinRingSpread =
    1e-9;                                  ///< mm: of a made ring that is fitted exactly, so that weights stay finite
inline constexpr double kRingRidge = 1e-9; ///< of the trace: fixes what few points leave open

/// The line across which a surface bends: across · p = offset.
struct Crease {
    Eigen::Vector2d across; ///< unit
    double offset;

    /// Distance beyond the line, 0 before it; times 1, the place along the line, and itself: how two smooth surfaces
    /// that meet in the line differ.
    Eigen::Vector3d terms(double x, double y) const;
};

/// Points of a ring; their number is a multiple of four.
struct Ring {
    Eigen::Matrix2Xd xy; ///< scaled
    Eigen::VectorXd z;   ///< about its median
    Eigen::VectorXd near;
    double sigma;
    double independent; ///< number of independent points
};

/// The largest number of points up to `count` that fills lanes of four.
inline Eigen::Index count_in_lanes(Eigen::Index count) { return count / 4 * 4; }

/// Some of the points, evenly left out.
Ring thinned(const Ring& ring, Eigen::Index max_count);

inline Eigen::Index terms_of(int degree) { return Eigen::Index(degree + 1) * (degree + 2) / 2; }

/// Monomials x^a y^b of total degree up to `degree`; those of a lower degree come first.
void monomials(double x, double y, int degree, double* row);

/// A row for each point: the monomials, then the crease's terms, if there is one.
Eigen::MatrixXd basis(const Eigen::Matrix2Xd& xy, int degree, const std::optional<Crease>& crease = {});

Eigen::MatrixXd normal_matrix(const Eigen::MatrixXd& A, const Eigen::VectorXd& weights);

/// Weighted least squares.
Eigen::VectorXd solve_weighted(const Eigen::MatrixXd& A, const Eigen::VectorXd& z, const Eigen::VectorXd& weights);

double quantile_of_sizes(const Eigen::VectorXd& residuals, double share);

/// Weights for the next solve_weighted() after residuals, by Huber, with the spread of the chosen points.
/// @param chosen  1 or 0   @param min_spread  mm
void reweigh(Eigen::VectorXd& weights, const Eigen::VectorXd& residuals, const Eigen::VectorXd& chosen,
             double min_spread);

} // namespace fettle::find
