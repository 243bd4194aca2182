#pragma once

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

/// A polynomial of total degree `degree` in coordinates scaled to [-1, 1] about the ring's centroid.
struct RingPolynomial {
    int degree;
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd covariance_root; ///< L of L Lᵀ, the coefficients' covariance, mm²
    double sd;                       ///< of the points about it, mm
    double inliers;                  ///< share of points with a weight
    double share;                    ///< in the average
};

/// Surface beneath a candidate: polynomials of rising degree, fitted robustly, averaged by the Bayesian information
/// criterion (Hoeting et al. 1999, 2.1), with as many independent points as the noise's correlation leaves.
struct RingFit {
    Eigen::Vector2d centre;
    double scale = 1;
    double height = 0; ///< of z = 0 of the polynomials, mm
    std::vector<RingPolynomial> polynomials;
    Eigen::VectorXd mean; ///< coefficients of their average
    double sd = 0;        ///< of the points about the surface, mm
    double inliers = 0;   ///< share of points with a weight
    int degree = 1;       ///< of the polynomial with the largest share

    /// Height of the surface and its standard deviation at a place, mm.
    struct Value {
        double z, sd;
    };
    Value at(double x, double y) const;
    double z_at(double x, double y) const;
    /// Adds `factor` times the heights at (0, y), (1, y), … to a row of numbers: many places cost less together.
    void add_row(double y, double factor, std::span<float> row) const;
};

/// @param sigma  of the noise, mm   @param max_degree  1 to 4
/// @return  nothing if the points are too few for a plane
std::optional<RingFit> fit_ring(const RingPoints& ring, double sigma, int max_degree);

} // namespace fettle::find
