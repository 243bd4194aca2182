#pragma once

#include "find/ring_basis.h"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace fettle::find {

/// Points around a candidate, to which the surface beneath it is fitted.
struct RingPoints {
    Eigen::Matrix2Xd xy;     ///< 2xN, any unit
    Eigen::VectorXd z;       ///< mm
    Eigen::VectorXd weights; ///< by the distance to the candidate, to 1
};

/// Surface beneath a candidate: polynomials of rising degree, and pairs of them that meet in a crease, fitted robustly,
/// averaged by the Bayesian information criterion (Hoeting et al. 1999, 2.1), with as many independent points as the
/// noise's correlation leaves.
struct RingFit {
    Eigen::Vector2d centre; ///< of the scaled coordinates: the ring's centroid
    double scale = 1;       ///< so that they go from -1 to 1
    double height = 0;      ///< of z = 0, mm
    int highest_degree = 1;
    std::optional<Crease> crease; ///< in scaled coordinates
    Eigen::VectorXd mean;         ///< coefficients of the monomials up to that degree, then of the crease's terms
    Eigen::MatrixXd covariance;   ///< of these, about the average, mm²
    double sd = 0;                ///< of the points about the surface, mm
    double inliers = 0;           ///< share of points with a weight
    int degree = 1;               ///< of the polynomial with the largest share

    /// The crease in the points' own coordinates.
    std::optional<Crease> crease_in_place() const;

    /// Height of the surface at a place, mm.
    double z_at(double x, double y) const;
    /// Standard deviations at (x, y), (x + step, y), …: many places cost less together.
    void sd_row(double x, double y, double step, std::span<float> row) const;
    /// Adds `factor` times the heights at (x, y), (x + 1, y), … to a row of numbers.
    void add_row(double x, double y, double factor, std::span<float> row) const;
};

/// Whether a crease, the ridge of a roof, may run beneath a candidate, and where.
struct CreaseSearch {
    bool is_sought = false;      ///< near `known`, or anywhere; else there is none but that one
    std::optional<Crease> known; ///< in the points' coordinates
    double min_bend = 0;         ///< of the slope across it, mm in the points' unit; below it no roof
    double max_bend = 0;         ///< beyond it a wall
};

/// @param sigma  of the noise, mm   @param max_degree  1 to 4
/// @return  nothing if the points are too few for a plane
std::optional<RingFit> fit_ring(const RingPoints& ring, double sigma, int max_degree, const CreaseSearch& creases = {});

} // namespace fettle::find
